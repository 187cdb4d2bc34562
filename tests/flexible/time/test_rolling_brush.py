"""A brush that rolls far below its limit: bristles that hold and a patch that holds are the same to the march."""

from __future__ import annotations

import pytest

from flexible import simulate
from rigid import Run, Scene, load_scene


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
