"""How many rings a process keeps."""

import weakref

import pytest

import rigid
from flexible.ring.choice import KEPT, forget_rings, ring_of

SCENE = rigid.load_scene("paper-3.3-massless").replace(solve={"elements": 24})


@pytest.fixture
def none():
    forget_rings()
    yield
    forget_rings()


def test_rings_of_many_shapes_are_let_go_of(none):
    """What is made of a ring refers to it, and it to that: one that is not kept is gone all the same, but for the last
    that was given up, which goes with the next.
    """
    rings = []
    for number in range(KEPT + 5):
        ring = ring_of(SCENE.replace(hoop={"r": 1.1 + number / 100}))
        ring.once(lambda ring: [ring])
        rings.append(weakref.ref(ring))
        del ring
    alive = [made() is not None for made in rings]
    assert sum(alive) <= KEPT + 1
    assert all(alive[-KEPT:]), "the last ones are kept"


def test_a_ring_is_built_once_for_all_stiffnesses(none):
    stiffer = SCENE.replace(ring={"bending_stiffness": 1e5}, contact={"damping": 0.0})
    assert ring_of(SCENE) is ring_of(stiffer)
