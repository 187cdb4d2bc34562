"""A brush far below its limit is a patch that holds, to the march; near its limit it breaks loose in time."""

from __future__ import annotations

import pytest

from flexible import simulate
from rigid import Friction, Hoop, Release, Run, Scene, load_scene


def rolling(law: str, **ring_or_hoop: dict) -> Scene:
    """From 10 degrees to 14."""
    scene = load_scene("paper-3.3-heavier").replace(
        contact={"law": law, "stiffness": 1e9}, solve={"resolve": "all", "rtol": 3e-4}, run=Run(t_end=2.0)
    )
    return scene.replace(**ring_or_hoop)


@pytest.mark.parametrize("level", ["reduced", "chain"])
def test_a_rolling_brush_takes_the_steps_of_a_rolling_patch(level):
    """Its bristles break within mu_s N/(2a eps_t), some 1e-7 R, of where they stand, while the sag of the ring turns by
    more in a step. A guess on the far side of that says nothing of the way back: Newton failed in all but the shortest
    steps, a hundred times as many."""
    soft = {"ring": {"bending_stiffness": 50.0}, "hoop": {"mass_ratio": 0.3}}
    brush, patch = (
        simulate(rolling(law, **soft).replace(solve={"level": level}), history=True) for law in ("brush", "patch")
    )
    assert brush.completed
    assert brush.steps < 1.3 * patch.steps, "where both hold, steps are those that the motion asks for"
    # rtol in velocities is what two runs may differ by; the patch's bristles are not held to its pressure
    assert brush.history.omega[-1] == pytest.approx(patch.history.omega[-1], abs=3e-4)
    friction = abs(brush.history.friction_force) / brush.history.normal_force
    assert friction.max() < 0.3 / 2, "far from sliding"


@pytest.mark.slow
def test_a_brush_on_a_soft_ring_without_mass_is_marched_through():
    """There is no inertia that would hold the rim where its bristles let go: a step of Newton that breaks all of them
    loose leaves it anywhere, and no step longer than 1e-7 could be solved.

    On so soft a ring the patch takes 0.3 of a step's tolerance (its ``steps_of_soft``), here both."""
    soft = {"ring": {"bending_stiffness": 3.0}, "hoop": {"mass_ratio": 0.0}, "run": Run(t_end=0.2)}
    brush, patch = (
        simulate(rolling(law, **soft).replace(solve={"rtol": rtol}), history=True)
        for law, rtol in (("brush", 3e-5), ("patch", 1e-4))
    )
    assert brush.completed
    assert brush.steps < 3 * patch.steps, "creep and the first entries into the patch cost some"
    assert brush.history.omega[-1] == pytest.approx(patch.history.omega[-1], abs=1e-4), "rtol, of velocities"


@pytest.mark.slow
@pytest.mark.parametrize("phi0_deg", [10.0, -10.0])
@pytest.mark.parametrize("rtol", [1e-3, 3e-4, 1e-4])
def test_a_brush_that_breaks_loose_in_a_slow_roll_does_so_in_time(phi0_deg, rtol):
    """Its friction falls by less than a hundredth then, and steps of the roll are ten patches long; J_F tells when.

    Impulses keep to rtol J_N, of which the run that they are held to has a hundredth to a tenth itself.
    """
    scene = Scene(Hoop(0.1, 1.02, 0.1), Friction(0.35, 0.3), Release(phi0_deg=phi0_deg), Run(until="pulse"))
    scene = scene.replace(contact={"law": "brush"}, solve={"resolve": "all"})
    found, true = (simulate(scene.replace(solve={"rtol": r})).pulses[0] for r in (rtol, 1e-5))
    for name in ("normal_impulse", "friction_impulse", "friction_loss"):
        assert abs(getattr(found, name) - getattr(true, name)) < rtol * true.normal_impulse
