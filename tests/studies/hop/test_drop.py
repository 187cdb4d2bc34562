"""N jumps down where a slip begins out of a roll; what an undamped hoop makes of it, whatever its stiffness."""

from math import cos, radians, sin

import numpy as np
import pytest
from scipy.optimize import brentq

import flexible
from rigid import Friction, Hoop, Kind, Release, Run, Scene, simulate
from studies.hop.rolling.drop import drop


def released(k: float, mass_ratio: float = 0.0, mu: float = 0.3) -> Scene:
    return Scene(Hoop(k=k, r=1.02, mass_ratio=mass_ratio), Friction(0.35, mu), Release(radians(10)), Run(turns=1))


def first_slip(scene: Scene) -> float:
    slips = (phase.t_start for phase in simulate(scene).phases if phase.kind in (Kind.SPIN, Kind.SKID))
    return next(slips)


@pytest.mark.parametrize(
    ("k", "mass_ratio", "mu"), [(0.1, 0.0, 0.3), (0.3, 0.0, 0.3), (0.1, 0.1, 0.1), (0.1, 0.1, 0.3)]
)
def test_the_drop_is_that_of_newton_and_euler(k, mass_ratio, mu):
    """K alpha = N a - F B, ydd = N - 1 + a alpha + e c w = 0, in a roll B alpha - a w = F besides, M = 1."""
    scene = released(k, mass_ratio, mu)
    constants = scene.hoop.constants
    state = simulate(scene).at(first_slip(scene))
    e, square = constants.e, constants.K
    a, rise, w = e * sin(state.phi), 1 + e * cos(state.phi), state.omega**2
    b = 1 - e * cos(state.phi) * w
    roll = (b * (square + rise**2) - a**2 * rise * w) / (square + a**2 + rise**2)
    way = 1 if state.slip_velocity < 0 or state.friction_force > 0 else -1
    slip = square * b / (square + a**2 - way * mu * a * rise)
    assert drop(scene) == pytest.approx(float(roll / slip), rel=1e-10)


def elastic(scene, stiffness, foundation, rtol):
    """N of an undamped hoop, from a twentieth before the first slip to a tenth behind it."""
    slip = first_slip(scene)
    motion = flexible.simulate(scene.replace(
        ring={"bending_stiffness": stiffness}, contact={"stiffness": foundation, "damping": 0.0},
        solve={"resolve": "all", "rtol": rtol}, run={"turns": None, "t_end": slip + 0.1},
    ))  # fmt: skip
    return motion.at(np.linspace(slip - 0.05, slip + 0.1, 30001)).normal_force


def jump(scene):
    slip, motion = first_slip(scene), simulate(scene)
    return tuple(float(motion.at(slip, side).normal_force) for side in ("left", "right"))


@pytest.mark.parametrize("k", [0.1, 0.2, 0.3, 0.35])
def test_an_undamped_hoop_leaves_the_floor_from_a_ratio_of_two_to_five_halves_on(k):
    """A massless wall of E I = 3000 on a floor of 1e9, within some swings of the slip. Where it stays N swings too, to
    below half way from N_behind to 2 N_behind - N_front: patch and wall have swings of their own, in no fixed step."""
    scene = released(k)
    front, behind = jump(scene)
    least = elastic(scene, 3000.0, 1e9, 1e-4).min()
    if front > 2.5 * behind:
        assert least == 0
    else:
        assert front < 2 * behind
        assert 0 < least < behind - (front - behind) / 2


def test_under_a_stiff_wall_the_patch_is_the_spring():
    """N ~ depth^(3/2): where it has let go, 2/5 (N_-^(5/3) - N^(5/3)) = N_+ (N_-^(2/3) - N^(2/3)) by its energy.

    k = 0.25, whose N falls to less than half: a linear spring would throw it up. In the half swing to its first least
    value N of the rigid hoop goes on to fall, by less than a hundredth of itself.
    """
    scene = released(0.25)
    front, behind = jump(scene)
    assert 2 < front / behind < 2.5

    def left(normal_force):
        return 0.4 * (front ** (5 / 3) - normal_force ** (5 / 3)) - behind * (
            front ** (2 / 3) - normal_force ** (2 / 3)
        )

    swings = elastic(scene, 3e8, 1e8, 1e-6)
    fallen = swings[np.argmax(swings < behind) :]
    assert fallen[np.argmax(np.diff(fallen) > 0)] == pytest.approx(brentq(left, 0.0, behind), rel=0.05)


def test_it_does_not_slip_where_friction_holds_it():
    assert drop(released(0.1, 0.1).replace(friction={"mu_s": 50.0, "mu": 50.0})) is None
