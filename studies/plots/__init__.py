"""What all output shares: the ``style`` of figures, the curves through a ``pulse``, the ``sheet`` of a table."""
