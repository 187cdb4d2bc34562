"""How often ``hoop`` and its workers look for garbage."""

from __future__ import annotations

import gc

import pytest

from studies.machine import OBJECTS, search_garbage_seldom
from studies.machine.processes import Processes


@pytest.fixture(autouse=True)
def as_before():
    threshold = gc.get_threshold()
    yield
    gc.set_threshold(*threshold)


@pytest.mark.parametrize(("often", "then"), [(700, OBJECTS), (0, 0), (2 * OBJECTS, 2 * OBJECTS)])
def test_garbage_is_looked_for_seldom_unless_the_user_has_it_otherwise(often, then):
    gc.set_threshold(often, 10, 10)
    search_garbage_seldom()
    assert gc.get_threshold()[0] == then


def test_a_worker_looks_for_it_as_seldom():
    processes = Processes(1)
    try:
        assert processes.submit(gc.get_threshold).result()[0] == OBJECTS
    finally:
        processes.stop()
