"""The chain's rim on floors far stiffer than the wall: the same at all places of an element."""

import numpy as np
import pytest

import flexible
import rigid
from flexible.chain.ring import PARTS, _Shape
from flexible.models.chain import ChainHoop
from flexible.models.select import hoop_of
from flexible.output.interior import interior_of
from flexible.ring.choice import elements_of_stout, ring_of
from flexible.ring.rim.even import EvenRim
from flexible.start.equilibrium import equilibrium
from flexible.start.pose import Pose
from rigid import Kind, Run

SOFT = rigid.load_scene("paper-3.3-massless").replace(
    hoop={"mass_ratio": 0.05}, ring={"bending_stiffness": 30.0}, contact={"stiffness": 1e12},
    solve={"rtol": 1e-3, "level": "chain"}, run=Run(until="pulse"),
)  # fmt: skip


def test_who_has_one():
    """Soft hoops on stiff floors have the elements that it takes; on the others they are as many as before."""
    around = elements_of_stout(SOFT.wall)
    hoop = hoop_of(SOFT)
    assert isinstance(hoop, ChainHoop)
    assert hoop.ring.ring.mesh.around == around
    assert len(hoop.vertex) == PARTS * around
    assert hoop.ring.sections == around // 2 - 1
    softer = hoop_of(SOFT.replace(contact={"stiffness": 1e8}))
    assert softer.ring.ring.mesh.around == len(softer.vertex) == 240
    few = hoop_of(SOFT.replace(hoop={"r": 1.1}, solve={"elements": 120}))
    assert len(few.vertex) == 120
    thin = ring_of(SOFT.replace(hoop={"r": 1.01}), linear=False)
    assert thin.mesh.around == 240, "more sections than a step of a soft ring may cost"


@pytest.mark.parametrize("around", [240, 241])
def test_the_rim_gives_way_as_the_even_one_does(around):
    """To unit forces anywhere, less what the contact has: sections and what they lack together.

    They are as the even rim has it but for what of that would push back, a few units of E b of the 1e6 by which such a
    ring bends. Of an odd number of elements one lies across pi.
    """
    ring = ring_of(SOFT.replace(solve={"elements": around}), 2, linear=False)
    shape = _Shape(ring, around // 2, PARTS)
    own = EvenRim(ring, PARTS).compliance
    found = shape.rim @ shape.inverse @ shape.rim.T + shape.missing
    more = found - own
    more = (more + more.T) / 2
    assert np.abs(more).max() < 1e-4 * np.abs(own).max()
    rounding = 1e-7 * np.abs(own).max()  # of a ring whose condition number is some 1e7
    assert np.linalg.eigvalsh(more)[0] > -rounding, "it only adds"
    angles = ring.mesh.rim_theta
    assert shape.theta[shape.at(np.arange(len(angles)))] == pytest.approx(angles, abs=1e-14)
    load = np.random.default_rng(1).standard_normal((len(shape.theta), 2))
    back = shape.to_mesh(load.ravel()).reshape(-1, 2)
    assert back.sum(axis=0) == pytest.approx(load.sum(axis=0), abs=1e-10)


def test_a_stiff_ring_moves_as_its_mesh():
    """No mass and E I = 1e6: where nothing presses the mesh's static answer to the contact's forces, to 1e-4 of it."""
    scene = SOFT.replace(hoop={"mass_ratio": 0.0}, ring={"bending_stiffness": 1e6})
    scene = scene.replace(contact={"stiffness": 1e15})
    chain = ChainHoop(scene)
    assert chain.ring.shape.even is not None
    state = equilibrium(chain, Pose(2.7, 1.0, 0.0, 4.0, 0.4, Kind.ROLL))
    ring, shape = chain.ring.ring, chain.ring.shape
    load, on_rim = np.zeros(len(ring.free)), np.zeros((len(shape.theta), 2))
    on_rim[chain.ring.window(*state.window)[0]] = state.nodal
    load[ring.rim_dofs] = shape.to_mesh(on_rim.ravel())
    expected = ring.expand(ring.solve(load)) / chain.ring.stiffness
    found = interior_of(chain).displacement([state])[..., 0]
    assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()


def test_fields_of_a_soft_ring_move_with_its_rim():
    """Where the floor presses the mesh's rim is where the contact's is, to 1e-4 of how far the ring is moved."""
    chain = ChainHoop(SOFT)
    state = equilibrium(chain, Pose(2.9, 3.0, 0.0, 20.0, 2.0, Kind.ROLL))
    moved = interior_of(chain).displacement([state])[..., 0]
    number = chain.ring.window(*state.window)[0]
    shared = number % PARTS == 0
    assert shared.sum() >= 2
    rim = chain.ring.ring.mesh.rim_nodes[number[shared] // PARTS]
    assert np.abs(moved).max() > 0.01
    assert np.abs(moved[rim] - state.u[shared]).max() < 1e-4 * np.abs(moved).max()


@pytest.mark.slow
def test_the_largest_force_knows_no_mesh():
    """E I = 30 on 10^12, r = 1.02, m_h/m = 0.05: on quads it fell from 72 by 58 to 46 with 240, 480 and 960 of them.

    What is left is less than a hop of the rim, which comes down a little harder or softer with every mesh.
    """
    default, finer = (
        flexible.simulate(SOFT.replace(solve=solve)).pulses[0] for solve in ({}, {"elements": 480})
    )  # fmt: skip
    assert default.peak_normal_force == pytest.approx(finer.peak_normal_force, rel=0.05)
    assert default.normal_impulse == pytest.approx(finer.normal_impulse, rel=3e-4)
