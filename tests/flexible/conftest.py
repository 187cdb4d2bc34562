"""Makes what these tests share (``scenes``) importable from the rooms below."""
