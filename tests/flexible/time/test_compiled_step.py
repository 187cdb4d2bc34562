"""The step that compiled code takes is the one that Python takes on the same hoop: one text, two machines."""

import numba
import numpy as np
import pytest
from scenes import HOOP, flying

import rigid
from flexible.models.chain import ChainHoop
from flexible.models.reduced import ReducedHoop
from flexible.ring.choice import forget_rings
from flexible.ring.fem import COLUMNS
from flexible.start.equilibrium import compile_ahead
from flexible.start.handover import hand_over
from flexible.time import adaptive
from flexible.time.adaptive import attempt, machine
from flexible.time.advance import COLUMNS as OF_A_ROW
from flexible.time.advance import Aims, advance
from flexible.time.course import REACHED, beginning
from flexible.time.events import Ends
from flexible.time.methods import METHODS, alike


def rolling(scene, level=ReducedHoop):
    """The hoop in the equilibrium of its release, at the bottom of a swing."""
    hoop = level(scene)
    return hoop, hand_over(hoop, rigid.simulate(scene), 0.0)


def both(hoop, state, h, method):
    """State, totals and record after one step by Python, and by compiled code."""
    aims, found = Aims(np.inf, 1, hoop.relaxation, alone=True), []
    assert machine(hoop)[0] is not advance
    for run, of in ((advance, hoop), machine(hoop)):
        row = np.empty((1, OF_A_ROW))
        reached = run(
            of, hoop.law.parameters, alike(METHODS[method]).tables(1.0), beginning(state, h), Ends(), aims, row
        )
        assert reached.why == REACHED
        found.append((reached.now.state, reached.now.books, row))
    return found


def agree(one, other, tolerance):
    """All that a step is made of, integers to the last."""
    for mine, others in zip(one[:2], other[:2], strict=True):
        agree_in(mine, others, tolerance)
    assert np.allclose(one[2], other[2], rtol=tolerance, atol=tolerance)


def agree_in(one, other, tolerance):
    """Two tuples, field by field."""
    for name, value in one._asdict().items():
        found = getattr(other, name)
        if name in ("mode", "window"):
            assert found == value
        elif hasattr(value, "_asdict"):
            agree_in(value, found, tolerance)
        else:
            assert np.allclose(found, value, rtol=tolerance, atol=tolerance, equal_nan=True), name


@pytest.mark.slow  # the stage is compiled by itself for it
@pytest.mark.parametrize("method", list(METHODS))
@pytest.mark.parametrize("law", ["patch", "brush", "regularised"])
@pytest.mark.parametrize("mass_ratio", [0.0, 0.1])
def test_a_step_on_the_floor(law, mass_ratio, method):
    """Each stage is known to Newton's tolerance, 1e-9 (1 + N), and rates to that over the inertia and 1/h."""
    friction = {"mu_s": 0.35 if law != "regularised" else 0.3}
    scene = HOOP.replace(
        release={"phi0": 1.5, "omega0": 1.0}, hoop={"mass_ratio": mass_ratio}, friction=friction,
        contact={"law": law, "damping": 1.0},
    )  # fmt: skip
    hoop, state = rolling(scene)
    one, other = both(hoop, state, 1e-3, method)
    assert one[0].res.normal > 0
    agree(one, other, 1e-7)


@pytest.mark.slow  # the stage is compiled by itself for it
@pytest.mark.parametrize("law", ["patch", "brush"])
@pytest.mark.parametrize("mass_ratio", [0.0, 0.1])
def test_a_step_of_a_chain(law, mass_ratio):
    """As above, of a soft ring."""
    scene = HOOP.replace(
        release={"phi0": 1.5, "omega0": 1.0}, hoop={"mass_ratio": mass_ratio}, contact={"law": law, "damping": 1.0},
        ring={"bending_stiffness": 5.0},
    )  # fmt: skip
    hoop, state = rolling(scene, ChainHoop)
    one, other = both(hoop, state, 1e-3, "esdirk3")
    assert one[0].res.normal > 0
    agree(one, other, 1e-7)


@pytest.mark.slow  # as above
def test_a_step_in_flight():
    """Nothing but inertia: to round-off."""
    hoop = ReducedHoop(HOOP)
    rng = np.random.default_rng(3)
    n = hoop.coordinates
    pos = np.concatenate([[0.0, 0.3, 2.0], 1e-4 * rng.standard_normal(n)])
    vel = np.concatenate([[0.1, 0.2, 1.0], 1e-2 * rng.standard_normal(n)])
    one, other = both(hoop, flying(hoop, pos, vel), 1e-3, "esdirk3")
    assert one[1].off_floor == pytest.approx(1e-3, rel=1e-12)
    agree(one, other, 1e-11)


def test_what_is_known_of_the_ring_is_no_part_of_a_step():
    """A step into windows whose compliance nobody asked for is, bit by bit, that of a hoop that knows all of it."""
    scene = HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}, solve={"elements": 124})  # a ring of no other test
    hoop, state = rolling(scene)
    compliance, known = hoop.ring.ring.solve_rim(np.empty(0, np.int64))
    assert not known.all()
    here = hoop.ring.dofs(*state.window) // COLUMNS
    kept = compliance.copy()
    compliance[:], known[:] = np.nan, False
    found = attempt(hoop, state, 1e-3)
    assert known[here].any()
    hoop.ring.ring.solve_rim(np.arange(len(compliance)))
    again = attempt(hoop, state, 1e-3)
    assert found is not None
    assert again is not None
    for one, other in zip(found.pos, again.pos, strict=True):
        assert one == other
    assert (found.u == again.u).all()
    columns = hoop.ring.dofs(*state.window)
    assert np.array_equal(compliance[:, columns], kept[:, columns])


def test_a_hoop_made_anew_has_the_rim_where_another_had_it(monkeypatch):
    """Far from its patch too, by columns of the patch, which nobody asked the new ring for."""
    scene = HOOP.replace(release={"phi0": 1.5, "omega0": 1.0}, solve={"elements": 126})  # a ring of no other test
    hoop, state = rolling(scene)
    opposite = (state.window[0] + 63, 4)
    moved = hoop.displacement(state, opposite)
    forget_rings()
    monkeypatch.setattr(np, "empty", np.ones)  # for what stood in the memory of columns that nobody asked for
    np.testing.assert_array_equal(ReducedHoop(scene).displacement(state, opposite), moved)


@pytest.mark.slow
@pytest.mark.parametrize("level", [ReducedHoop, ChainHoop])
def test_steps_are_compiled_ahead_for_what_they_are_called_with(monkeypatch, level):
    """By the types of numba, for a hoop of any kind: of others the march would be compiled once more."""
    run, types = adaptive.machine(level(HOOP))[0], []

    def take(*arguments):
        types.append([numba.typeof(argument) for argument in arguments])
        return run(*arguments)

    take.compile_for = lambda *arguments: types.append([numba.typeof(argument) for argument in arguments])
    monkeypatch.setattr(adaptive, "machine", lambda model: (take, model.arrays))
    for kind in KINDS:
        scene = HOOP.replace(**kind)
        before = len(types)
        compile_ahead(level(scene))
        hoop, state = rolling(scene, level)
        adaptive.march(hoop, state, Ends(t=state.t + 1e-4), 1e-3)
        assert len(types) > before + 2, kind
        assert all(each == types[0] for each in types), kind


KINDS = [
    {"hoop": {"mass_ratio": 0.0}},
    {"hoop": {"mass_ratio": 0.1}},
    {"hoop": {"r": 1.2}, "contact": {"law": "brush", "damping": 1.0}},
    {"hoop": {"r": 1.003}, "solve": {"resolve": "all", "start": "undeformed"}},
    {"friction": {"mu_s": 0.3}, "contact": {"law": "regularised"}, "solve": {"through": 2, "elements": 300}},
]
