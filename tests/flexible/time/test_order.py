"""Of which order steps are: the fourth where little is asked to be left, the third where nothing is smooth."""

import pytest

import flexible
import rigid
from flexible.time.methods import ESDIRK3, ESDIRK4, METHODS, chosen
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene, Solve


def test_what_a_scene_asks_for():
    assert set(chosen("auto", 1e-4, True)) == {ESDIRK3}
    assert chosen("auto", 1e-5, True) == (ESDIRK4, ESDIRK3)
    assert set(chosen("auto", 1e-5, False)) == {ESDIRK3}
    for name, method in METHODS.items():
        assert set(chosen(name, 1e-6, True)) == {method}


@pytest.mark.parametrize("law", ["patch", "brush"])
@pytest.mark.parametrize("stiffness", [1e8, 1e10])
def test_a_hundredth_of_the_tolerance_takes_less_than_ten_times_the_steps(law, stiffness):
    """Third order by itself takes 6.7 and 12 times (patch), fourth 2.5 and 5.3. To the sum of both tolerances, of which
    a pulse may take several; J_F hangs on when a stick breaks (``flexible/README.md``)."""
    scene = Scene(
        Hoop(0.1, 1.02, mass_ratio=0.05), Friction(0.35, 0.3), Release(phi0_deg=10), Run(until="pulse"),
        ring=Ring(bending_stiffness=1e4), contact=Contact(law, stiffness), solve=Solve(level="reduced"),
    )  # fmt: skip
    rough, fine = (flexible.simulate(scene.replace(solve={"rtol": rtol}), history=True) for rtol in (1e-4, 1e-6))
    assert len(fine.history.t) < 10 * len(rough.history.t)
    one, other = rough.pulses[0], fine.pulses[0]
    assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=3e-4)
    assert one.friction_impulse == pytest.approx(other.friction_impulse, abs=3e-4 * other.normal_impulse)


def test_fourth_order_goes_where_third_order_does():
    """A pulse without vibrations, which third order is taken for: both to rtol, one in half of the steps."""
    scene = rigid.load_scene("paper-3.3-massless").replace(
        contact={"stiffness": 1e10}, ring={"bending_stiffness": 1e5}, run={"until": "pulse", "turns": None},
        solve={"rtol": 1e-5},
    )  # fmt: skip
    fourth, third = (
        flexible.simulate(scene.replace(solve={"integrator": name}), history=True) for name in ("esdirk4", "esdirk3")
    )
    assert len(fourth.history.t) < 0.5 * len(third.history.t)
    for name in ("normal_impulse", "friction_impulse"):
        one, other = (getattr(motion.pulses[0], name) for motion in (fourth, third))
        assert one == pytest.approx(other, abs=1e-5 * third.pulses[0].normal_impulse)


@pytest.mark.slow
def test_a_light_rim_ends_its_chatter():
    """By fourth order alone it takes 55 000 steps on this floor, and on one ten times as stiff it is given up."""
    scene = rigid.load_scene("paper-3.3-light").replace(
        contact={"stiffness": 1e11}, run={"until": "pulse", "turns": None}, solve={"rtol": 1e-6}
    )
    motion = flexible.simulate(scene)
    assert motion.completed, motion.ended


def test_a_brush_that_breaks_loose_slowly():
    """Released rolling, it does so on its way down, and when tells how far it slips: a brush about to break takes steps
    of third order, and breaks when it would by these alone. By fourth order alone it would 0.006 later, and the lighter
    its ring the later (``flexible/README.md``, example 3)."""
    scene = Scene(
        Hoop(0.214, 1.01, mass_ratio=0.1), Friction(0.395, 0.263), Release(phi0_deg=30), Run(until="pulse"),
        ring=Ring(bending_stiffness=216), contact=Contact("brush", 1.05e8, damping=0.2),
        solve=Solve(resolve="all", rtol=1e-5),
    )  # fmt: skip
    motions = [flexible.simulate(scene.replace(solve={"integrator": name})) for name in ("auto", "esdirk3")]
    mine, third = (motion.phases[1] for motion in motions)
    assert mine.kind == third.kind == rigid.Kind.SPIN
    assert mine.t_start == pytest.approx(third.t_start, abs=2e-3)
    assert motions[0].steps < 0.7 * motions[1].steps
