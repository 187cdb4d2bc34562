"""What a phase leaves behind: the log of ``events``, the measures of a ``pulse``, the ``cycle`` in which a motion
without loss comes round, and the ``rows`` that a batch keeps; all that a motion tells of it as ``values``.
"""
