"""What Newton's method asks of a patch: forces without jumps, and a damper under which they are what was foreseen."""

from math import sqrt

import numpy as np
import pytest
from kinematic import Floor, parameters

from flexible.contact.foreseen import Foreseen, moved_back, moved_by, moved_damper
from flexible.contact.newton import round_off
from flexible.contact.points.bristles import edge_of_patch
from flexible.contact.points.data import UNDAMPED

EPS = 1e6
STIFF = 1e12  # with which a patch of DEPTH bears some weights, that Newton tells apart
DEPTH = 1e-8
HALF = sqrt(2 * DEPTH)  # half-width of the patch


def stretched(points, along):
    """A patch that sticks, stretched along the floor by a thousandth of its width, its points shifted by a share of
    their spacing.
    """
    spacing = 2 * HALF / points
    floor = Floor(parameters("patch", spacing, EPS, EPS), DEPTH, phi=2.9 + along * spacing)
    floor.move(2e-3 * HALF, 0.0)
    return floor


@pytest.mark.parametrize("along", np.linspace(0, 1, 8, endpoint=False))
def test_a_patch_lets_go_by_and_by(along):
    """Raised off the floor in 4000 steps a patch that sticks loses what it pulls in no step by more than a hundredth.

    Its length falls like the square root of the depth, by a sixtieth of the whole in the last step; the bristles at an
    edge that points leave count less than that. With three points to the patch all but the last one leave early.
    """
    floor = stretched(3, along)
    pulls = [abs(floor.move(0.0, 0.0, rise=DEPTH / 4000 * 1.001).friction) for _ in range(4000)]
    assert pulls[-1] == 0
    assert np.abs(np.diff(pulls)).max() < 0.016 * pulls[0]


def test_derivatives_of_an_edge():
    """Against differences, on both sides of where the parabola becomes straight; the edge itself goes to its point."""
    rng = np.random.default_rng(1)
    step = 1e-6
    for _ in range(200):
        gaps = np.array([-rng.random(), rng.random(), rng.normal()])
        edge, *slopes = edge_of_patch(*gaps)
        assert 0 <= edge <= 1
        for i, slope in enumerate(slopes):
            off = np.zeros(3)
            off[i] = step
            found = (edge_of_patch(*(gaps + off))[0] - edge_of_patch(*(gaps - off))[0]) / (2 * step)
            assert found == pytest.approx(slope, rel=1e-3, abs=1e-3)
        assert edge_of_patch(-1e-9, *np.abs(gaps[1:]))[0] < 1e-8 / abs(gaps[1])


@pytest.mark.parametrize("turned", [0.0, 0.5, 3.0])
def test_a_moved_damper_carries_what_was_foreseen(turned):
    """However much of the patch is new in the step: points that enter count their slip from where the stage does."""
    floor = stretched(20, 0.3)
    damper = UNDAMPED._replace(relaxation=2.0, elastic_0=0.9 * floor.result.res.elastic, drag=1e4, ratio=2.0)
    res = floor._forces(floor.pose + np.array([1e-8, 0.0, turned * HALF]), damper).res
    foreseen = Foreseen(res.normal + 0.5, res.friction - 0.7)
    moved = moved_by(damper, foreseen, res)
    found = floor._forces(floor.pose + np.array([1e-8, 0.0, turned * HALF]), moved_damper(damper, moved)).res
    assert found.normal == pytest.approx(foreseen.normal, abs=1e-9)  # Newton's own tolerance
    assert found.friction == pytest.approx(foreseen.friction, abs=1e-9)


def both_dampers(floor, dv, wanted):
    """A step under a strong damper, the same under one moved so that N is as many times larger, and that taken back."""
    damper = UNDAMPED._replace(relaxation=300.0, elastic_0=floor.result.res.elastic, drag=1e4)
    pose = floor.pose + np.array([dv, 0.0, 0.0])
    own = floor._forces(pose, damper)
    foreseen = Foreseen(wanted * own.res.normal, wanted * own.res.friction)
    moved = moved_by(damper, foreseen, own.res)
    carries = floor._forces(pose, moved_damper(damper, moved))
    return own, carries, moved_back(carries, damper, moved)


@pytest.mark.parametrize("mode", [0, 1])
def test_a_move_taken_back_is_no_difference(mode):
    """A patch as a whole is linear in what the damper moves: taken back, its forces are the stage's own again."""
    floor = Floor(parameters("patch", HALF / 10, STIFF, STIFF), DEPTH, mode=mode)
    floor.move(1e-3 * HALF, 0.0)
    own, carries, back = both_dampers(floor, 1e-4 * HALF, 30)
    assert carries.res.normal == pytest.approx(30 * own.res.normal)
    assert back.force == pytest.approx(own.force, rel=1e-9)  # of thirty times as much, Newton's own tolerance
    assert back.nodal == pytest.approx(own.nodal, rel=1e-9, abs=1e-9 * np.abs(own.nodal).max())


@pytest.mark.parametrize("more", np.linspace(0.9, 1.1, 9))
def test_a_bristle_about_to_break_does_not_speak_for_the_patch(more):
    """Of a brush only what slides goes like the pressure, whichever of its bristles breaks next.

    A bristle that breaks lets go of mu_s - mu of its pressure. Where that fell between two pressures that were a
    hundredth apart, their difference foretold ten times what the point bears; Newton lost brushes of some twenty
    points, on soft rings, with a step however short.
    """
    floor = Floor(parameters("brush", HALF / 10, STIFF, STIFF, 0.5, 0.3), DEPTH)
    _, carries, back = both_dampers(floor, 0.35 * DEPTH * more, 1.3)
    slides = carries.bristles.sliding != 0
    assert 0 < slides.sum() < len(slides)
    pulls = carries.bristles.pull
    assert carries.force[0] == pytest.approx(pulls.sum())
    assert back.force[0] == pytest.approx(pulls[~slides].sum() + pulls[slides].sum() / 1.3)


def test_round_off_grows_with_what_the_damper_multiplies_by():
    """In a stage of no length the factor is that of the step before, 1470 in a hoop that slams down."""
    floor = stretched(20, 0.3)
    damper = UNDAMPED._replace(eta_0=1470.0)
    sizes, normals = [], []
    for each in (UNDAMPED, damper):
        contact = floor._forces(floor.pose, each)
        sizes.append(round_off(contact, floor.pose[1], np.zeros((3, 2)), 1.0, each))
        normals.append(contact.res.normal)
    assert normals[1] / normals[0] == pytest.approx(1470)
    assert sizes[1] / sizes[0] == pytest.approx(1470, rel=1e-6)  # the slip's share does not grow
