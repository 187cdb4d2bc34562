"""Slipping: the quadrature over phi in panels, the series in tau where phi is no measure, and the phase.

``series``, ``step``   Taylor series in tau of (10) to (16), and one step of them, cut at its first event
``panel``              phidot and t over a stretch of phi: (12) with its integrating factor
``poles``              how long a panel may be
``way``                a panel on the way of the motion: its events, and the state anywhere on it
``stride``             the next panel of a slip; to a turn and back
``phase``              a slip run to its end
"""
