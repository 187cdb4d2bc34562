"""What all figures share: their ``style``, and the curves through a ``pulse``."""
