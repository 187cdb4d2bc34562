"""A floor without friction: phases are told by the velocity, where the force says nothing."""

import pytest

import flexible
import rigid
from rigid import Friction, Hoop, Kind, Release, Run, Scene


@pytest.mark.parametrize("mu_s", [0.0, 1e-3])
@pytest.mark.parametrize(("slip", "kind"), [(-2.0, Kind.SPIN), (2.0, Kind.SKID)])
@pytest.mark.parametrize("resolve", ["pulses", "all"])
def test_a_slip_is_named_by_its_direction(resolve, slip, kind, mu_s):
    """The mass centre keeps its velocity along the floor: the rim slips the same way throughout."""
    scene = Scene(Hoop(0.2, 1.02, 0.1), Friction(mu_s, 0.0), Release(0.7, 0.0, slip), Run(until="pulse"))
    scene = scene.replace(solve={"resolve": resolve, "rtol": 1e-3})
    assert {phase.kind for phase in rigid.simulate(scene).phases} == {kind}
    assert {phase.kind for phase in flexible.simulate(scene).phases} == {kind}
