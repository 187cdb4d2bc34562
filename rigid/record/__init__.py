"""What a phase leaves behind: the ``log`` of phases, turns and pulses, and the measures of a ``pulse``."""
