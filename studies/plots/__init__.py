"""What all output shares: the ``style`` of figures, the curves through a ``pulse``, the ``distance`` to
a limit, the ``sheet`` of a table."""
