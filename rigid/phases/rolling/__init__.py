"""Rolling: forces and times in ``closed_form``, what one of its ``passes`` over the bottom meets, and the ``phase``."""
