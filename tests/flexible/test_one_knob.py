"""``rtol`` chooses contact points and modes too: neither puts a floor under a pulse's error."""

import numpy as np
import pytest
from scenes import HOOP

import rigid
from flexible.contact.laws.listing import LAWS
from flexible.models.reduced import ReducedHoop
from flexible.models.rim_contact import known_to, points_to_a_patch, share_of_linear_steps, share_of_steps
from flexible.ring.rim.reduction import modes_for
from flexible.start.handover import hand_over
from flexible.time.adaptive import march
from flexible.time.events import Ends


def through_the_bottom(scene, **options):
    """(J_N, J_F, friction loss) from a few patches before the pulse to behind it."""
    hoop = ReducedHoop(scene, **options)
    motion = rigid.simulate(scene)
    pulse = motion.pulses[0]
    start = hand_over(hoop, motion, 1.5 * pulse.t_start - 0.5 * pulse.t_end)
    last = march(hoop, start, Ends(t=pulse.t_end), scene.solve.rtol).records[-1]
    return np.array([last.normal_impulse, last.friction_impulse, last.friction_loss])


@pytest.mark.parametrize("law", ["patch", "brush"])
def test_where_points_lie_does_not_matter(law):
    """Spacings that differ by parts of a thousand put the points anywhere in the patch; half the spacing doubles them.

    A fifth of rtol: what the points do is to be lost in the error of the steps.
    """
    scene = HOOP.replace(hoop={"mass_ratio": 0.0}, contact={"law": law, "damping": 1.0}, solve={"rtol": 1e-3})
    points = points_to_a_patch(LAWS[law], scene.solve.rtol)
    found = [through_the_bottom(scene, points=points * by) for by in (1, 1.0037, 1.0071, 2)]
    assert found[0][0] > 1  # a pulse it is
    assert np.ptp(found, axis=0).max() < 0.2 * 1e-3 * found[0][0]


@pytest.mark.parametrize(
    ("rtol", "r"),
    [(1e-2, 1.02), (1e-3, 1.02), (1e-4, 1.02), (1e-3, 1.2), pytest.param(1e-4, 1.2, marks=pytest.mark.slow)],
)
def test_modes_that_are_left_out_do_not_matter(rtol, r):
    """Against three times as many: below rtol, for a ring that rings as hard as a linear one does: E I = 60, a blow."""
    scene = HOOP.replace(
        hoop={"r": r}, release={"phi0": 2.9, "omega0": 4.0}, ring={"bending_stiffness": 60.0},
        contact={"stiffness": 1e7}, solve={"rtol": rtol},
    )  # fmt: skip
    count = modes_for(rtol, scene.wall)
    few, many = (_to_the_end(scene, modes) for modes in (count, 3 * count))
    assert np.abs(few - many).max() < rtol * many[0]


def _to_the_end(scene, modes):
    """Impulses and loss of the blow with which an undeformed ring rolls onto the floor."""
    hoop = ReducedHoop(scene.replace(solve={"start": "undeformed"}), modes=modes)
    start = hand_over(hoop, rigid.simulate(hoop.scene), 0.0)
    # steps a tenth as large as asked for: what is left is the modes'
    last = march(hoop, start, Ends(t=0.14), 0.1 * scene.solve.rtol).records[-1]
    return np.array([last.normal_impulse, last.friction_impulse, last.friction_loss])


@pytest.mark.parametrize("law", ["patch", "brush"])
def test_steps_of_soft_rings_have_a_part_of_a_rough_tolerance(law):
    """Of what their law has: all of it from E I = 33 on, or where the tolerance is no rougher than 3e-4.

    Softer than E I = 1 both fall like the power 3/2 of E I.
    """
    whole = LAWS[law].steps_of_soft

    def share(bending_stiffness, rtol):
        ring = {"bending_stiffness": bending_stiffness}
        return share_of_steps(HOOP.replace(ring=ring, contact={"law": law}, solve={"rtol": rtol}))

    softer = [share(soft, 1e-2) / whole for soft in (33.0, 16.5, 3.0, 1.0, 0.25)]
    assert softer == pytest.approx([1, 0.5, 0.3, 0.3, 0.3 / 8])
    assert share(2.0, 3e-4) == share(2.0, 1e-6) == share(0.5, 1e-6) == whole
    assert share(2.0, 5e-4) * 5e-4 == pytest.approx(whole * 3e-4), "no longer steps than a tolerance of 3e-4 has"
    assert share(0.25, 5e-4) * 5e-4 == pytest.approx(whole * 3e-4 / 8)


def test_steps_of_a_thick_linear_ring_have_a_part_of_a_tolerance():
    """From a wall of 0.15 R on 0.7 of it, and 0.3 from an rtol of 3e-4 down; from 0.06 R on, below an rtol of 1e-4, it
    falls faster than that, as far as steps are more exact for it (README, section 5).
    """

    def share(r, rtol):
        return share_of_linear_steps(HOOP.replace(hoop={"r": r}, solve={"rtol": rtol}))

    assert {share(r, rtol) for r in (1.02, 1.06) for rtol in (1e-2, 1e-3, 1e-5)} == {1.0}
    assert {share(r, rtol) for r in (1.07, 1.17) for rtol in (1e-2, 1e-3, 1e-4)} == {1.0}
    assert share(1.2, 1e-3) == pytest.approx(0.7)
    assert share(1.2, 3e-4) == share(1.2, 1e-4) == pytest.approx(0.3)
    assert share(1.1, 1e-5) == share(1.2, 1e-5) / 0.3 == pytest.approx(10**-0.6)
    assert share(1.1, 2e-7) == share(1.2, 2e-7) == pytest.approx(5e-8 / 2e-7)
    assert share(1.2, 1e-8) == 1.0, "and never looser than rtol has it"
    assert ReducedHoop(HOOP.replace(hoop={"r": 1.2})).steps == share(1.2, HOOP.solve.rtol), "and a hoop takes it"


def test_modes_are_more_like_the_cube_root_of_the_tolerance():
    """Like its 10/3rd root: a thousand times as fine 10^0.9 as many, but for whole numbers."""
    assert modes_for(1e-8, 0.02) / modes_for(1e-5, 0.02) == pytest.approx(10**0.9, rel=0.02)
    assert modes_for(1e-8, 0.2) / modes_for(1e-5, 0.2) == pytest.approx(10**0.9, rel=0.03)


def test_forces_are_known_better_than_the_tolerance():
    """To a thirtieth of it at 1e-3, a thousandth at 1e-6."""
    assert known_to(1e-3) <= 1e-3 / 30
    assert known_to(1e-6) <= 1e-6 / 1000 * (1 + 1e-9)  # and round-off
