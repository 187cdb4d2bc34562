"""What all output shares: the ``style`` of figures, the curves through a ``pulse``, the ``distance`` to
a limit and the predicted ``approach`` to it, the ``difference`` of curves that coincide, the ``sheet`` of a table, the
``page`` of a study, the ``sketch`` of hoop and contact."""
