"""Benchmarks as tables on the screen (``tables``) and as figures (``figures``)."""
