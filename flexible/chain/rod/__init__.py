"""The ring as a rod: compliance of its section and of its ends at the weld (``section``), made the stiffness of parts
(``ends``, ``parts``), which turn and move far (``corotated``)."""
