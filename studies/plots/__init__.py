"""What all output shares: the ``style`` of figures, the curves through a ``pulse``, and the ``sheet``: a table that fits
the screen.
"""
