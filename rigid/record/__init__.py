"""What a phase leaves behind: the ``log`` of phases, turns and pulses, the measures of a ``pulse``, and the ``cycle``
in which a motion without loss comes round.
"""
