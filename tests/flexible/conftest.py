"""Makes what these tests share (``scenes``) importable from the rooms below."""

from math import inf

import pytest

from flexible.ring import choice


@pytest.fixture
def uneven(monkeypatch):
    """The rim of quads on any floor, as rings of all nodes have it: it gives way by more on nodes than between."""
    monkeypatch.setattr(choice, "FELT", inf)
