"""Where Newton on a stage begins: a rim moved to where its patch bears what is foreseen."""

from math import sqrt

import numpy as np
import pytest
from kinematic import VERTEX, Floor, parameters

from flexible.contact.forces import contact_forces
from flexible.contact.foreseen import Foreseen
from flexible.contact.guess import as_deep, held_again
from flexible.contact.points.data import UNDAMPED, Before, Rim, no_bristles, pulling
from flexible.contact.points.rim import element_at
from flexible.models.stage import FORESEEN, From

EPS, PHI = 1e6, 2.9


def elastic_force(height, u, rim):
    law = parameters("brush", 2e-6, EPS, EPS)
    pose = np.array([0.0, height, PHI])
    return contact_forces(pose, u, rim, law, 0, Before(pose, u, no_bristles()), UNDAMPED, False).res.elastic


@pytest.mark.parametrize("times", [0.2, 0.9, 1.1, 5.0])
def test_a_patch_is_as_deep_as_its_force_wants(times):
    """N = (4/3) eps delta sqrt(2 delta) on a circle, to the 1e-3 of its points: from any other height of the frame."""
    depth = 1e-6
    rim = Rim(element_at(VERTEX, np.pi - PHI) - 2, VERTEX)
    u = np.zeros((11, 2))
    known = 4 / 3 * EPS * depth * sqrt(2 * depth)
    assert elastic_force(-depth, u, rim) == pytest.approx(known, rel=1e-3)
    assert as_deep(3e-6, PHI, u, rim, From(u, -depth, known, times * known, 1e-9, FORESEEN))
    assert elastic_force(3e-6, u, rim) == pytest.approx(times * known, rel=1e-3)


@pytest.mark.parametrize(("deepest", "elastic", "expected"), [(1e-6, 0.0, 1.0), (-1e-6, 1.0, 0.0), (-1e-6, 1.0, 11.0)])
def test_a_patch_that_is_another_one_is_no_guide(deepest, elastic, expected):
    """Off the floor before, off it now, or ten times as strong: the rim stays where it is."""
    u = np.zeros((11, 2))
    rim = Rim(element_at(VERTEX, np.pi - PHI) - 2, VERTEX)
    assert not as_deep(0.0, PHI, u, rim, From(u, deepest, elastic, expected, 1e-9, FORESEEN))
    assert not u.any()


@pytest.mark.parametrize("way", [-1e-3, -3e-5, 3e-5, 1e-3])
def test_a_brush_is_found_where_it_sticks(way):
    """Pulled along by a third of what it can bear, and then moved off by hundreds of times the bristles' reach.

    That the patch go on without a slip is a guess that may be off by several times their reach either way.
    """
    law = parameters("brush", 2e-5, EPS, EPS, 0.35, 0.3)
    floor = Floor(law, 1e-6, PHI)
    reach = 0.35 * 1e-6
    pulled = floor.move(-reach / 6, 0.0)
    assert (floor.bristles.sliding == 0).mean() > 0.7
    pose = floor.pose + np.array([way, 0.0, 0.0])
    for off in (-3 * reach, 0.0, 3 * reach):
        rim, u = Rim(element_at(VERTEX, np.pi - PHI) - 6, VERTEX), np.zeros((27, 2))
        before = Before(floor.pose, u.copy(), floor.bristles)
        damper = UNDAMPED._replace(way_0=off)
        slid = contact_forces(pose, u, rim, law, 0, before, damper, True)
        assert not (slid.bristles.sliding == 0).any()
        found = held_again(
            pose, u, (rim, law, 0, before, damper), slid, Foreseen(slid.res.normal, pulled.friction), True
        )
        assert 2 * (found.bristles.sliding == 0).sum() >= (floor.bristles.sliding == 0).sum()
        assert abs(found.res.friction) < 0.3 * found.res.normal
        assert np.ptp(u, axis=0).max() < 1e-15 * abs(way) + 1e-18  # moved as a whole


def test_a_brush_is_held_by_what_the_damper_presses_it_with():
    """A rim that has not moved, pulled by two thirds of what it can bear: nothing slides.

    By the guess of the damper it is pressed with a tenth of that, and most of it would slide.
    """
    law = parameters("brush", 2e-5, 1e10, 1e10, 0.35, 0.3)  # 19 times the weight, by which it is told from none
    floor = Floor(law, 1e-6, PHI)
    pulled = floor.move(-0.35 * 1e-6 / 3, 0.0)
    stuck = (floor.bristles.sliding == 0).sum()
    rim, u = Rim(element_at(VERTEX, np.pi - PHI) - 6, VERTEX), np.zeros((27, 2))
    before = Before(floor.pose, u.copy(), floor.bristles)
    relaxation = 30.0
    damper = pulling(UNDAMPED._replace(relaxation=relaxation, elastic_0=(1 + 0.9 / relaxation) * pulled.elastic), True)
    guess = contact_forces(floor.pose, u, rim, law, 0, before, damper, True)
    assert guess.res.normal == pytest.approx(0.1 * pulled.normal)
    assert 2 * (guess.bristles.sliding == 0).sum() < stuck
    found = held_again(
        floor.pose, u, (rim, law, 0, before, damper), guess, Foreseen(pulled.normal, pulled.friction), True
    )
    assert found.res.normal == guess.res.normal  # Newton goes on with its own damper
    assert not u.any()
