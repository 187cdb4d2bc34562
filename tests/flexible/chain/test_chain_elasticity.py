"""The elasticity of the chain: its section, closed forms of rings, large deflections, and the mesh it comes from."""

from math import asin, cos, log, pi, sin, sqrt
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest
from scenes import HOOP
from scipy.integrate import solve_bvp
from scipy.optimize import brentq
from scipy.special import ellipe, ellipeinc, ellipk, ellipkinc

from flexible.chain.bordered import Blocks, factor, no_blocks, solve
from flexible.chain.rim import RimNodes, follow, rim_curvature
from flexible.chain.ring import ChainRing, _Shape, dense_stiffness, rim_matrix
from flexible.chain.rod.corotated import Rod, elastic, strain_energy
from flexible.chain.rod.ends import bow_of, chord_strains, in_strains
from flexible.chain.rod.parts import curve_weights
from flexible.chain.rod.section import RodCompliance, radial, rod_compliance
from flexible.contact.newton import FRAME
from flexible.contact.vectors import eliminate, solved_by
from flexible.ring.choice import ring_of
from flexible.ring.fem import Ring
from meshes import ring_mesh


@pytest.fixture(scope="module")
def thin():
    """The chain of r = 1.02, of two elements through the wall."""
    return _Shape(Ring(ring_mesh(1 / 1.02, 1.0, 240, 2), 0.3), 120)


def closed(parts, stretch=1e-9):
    """A ring of unit radius and bending stiffness without a wall, held at its section at theta = 0 and cut there."""
    section, none = np.diag([stretch, stretch, 1.0]), np.zeros((6, 6))
    compliance = RodCompliance(1.0, section, 0.0, none, None, np.zeros((0, 3)), 0.0)
    theta = np.linspace(0, 2 * pi, parts + 1)
    place = np.column_stack([np.cos(theta), np.sin(theta)])
    step = 2 * pi / parts
    local = in_strains(compliance.piece(step), chord_strains(radial(0.0), radial(step), 2))
    mass = np.full(parts + 1, step)
    return Rod(
        theta,
        place,
        chord=np.column_stack([np.diff(place, axis=0), np.full(parts, 2 * sin(step / 2))]),
        local=np.stack([local] * parts),
        bow=np.stack([bow_of(local, 2 * sin(step / 2))] * parts),
        pulled=np.zeros(parts),
        softening=np.zeros(parts),
        strained=np.zeros(parts),
        bent=np.zeros((2, 3, 3, 3)),
        far=np.zeros((2, 3, 3, 3, 3)),
        fading=0.0,
        across=np.zeros((3, 3)),
        mass=mass,
        turning=0 * mass,
        curve=curve_weights(theta),
        offset=0.0,
        pinch=0.0,
        reach=1.0,
        seen=np.zeros((parts + 1, 2, 4, 3)),
        rooted=1,
    )


def forces_of(rod, q):
    force = np.zeros_like(q)
    energy = elastic(rod, q, force)
    return energy, force


def test_section_of_a_thick_ring():
    """Under a moment alone dphi/dtheta is 8 (b^2 - a^2)/N (Timoshenko and Goodier, sec. 29), with E = 1, b = 1.

    Four elements through the wall: their error falls as the wall over them to the fourth power, some 1e-5. What is left
    of any form of three resultants is 1e-4 of the energy at most.
    """
    a = 1 / 1.2
    compliance = rod_compliance(Ring(ring_mesh(a, 1.0, 240, 4), 0.3), 0.05)
    exact = 8 * (1 - a**2) / ((1 - a**2) ** 2 - 4 * a**2 * log(a) ** 2)
    assert compliance.section[2, 2] == pytest.approx(exact, rel=3e-5)
    assert compliance.misfit < 1e-4


@pytest.mark.slow
@pytest.mark.parametrize("r", [1.001, 1.003, 1.01])
def test_a_thin_ring_has_no_part_that_pushes_back(r):
    """Its quads, 26 walls long at r = 1.001, lack more energy than shear has: 1 to 1.2 times Q^2/(2 G h) is physics.

    Parts shorter than a quad, as those at the weld are, then had less than none, and the ring leapt out of its shape.
    """
    shape, h = _Shape(Ring(ring_mesh(1 / r, 1.0, 240, 2), 0.3), 120), 1 - 1 / r
    assert 0.999 < shape.compliance.section[1, 1] * h / (2 * 1.3) < 1.201
    assert np.linalg.eigvalsh(shape.rod.local).min() > 0


def test_clamped_ring_in_closed_form():
    """Radial and tangential compliance at an angle from the weld, in a^3/(E I) of a clamped thin ring: printed digits.

    180 degrees is the ring pinched by two opposite forces P, (pi/4 - 2/pi) P a^3/(E I), and the one pulled along its
    rim, (3 pi/4 - 4/pi): by Castigliano, where the halves share the pull and the shear -2P/pi keeps them level. To both
    comes a stretch s of the two resultants, each of which turns along a half but keeps its size: s pi/2 and
    s (pi/2 + 8/pi). A load is met at a section, where the parts are exact however few they are; rounding leaves 1e-8
    of a pull, 1e-10 of a pinch; the bound of a matrix conditioned 2e9 is 5e-7.
    """
    stretch = 1e-6
    rod = closed(72, stretch)
    compliance = np.linalg.inv(dense_stiffness(rod, np.zeros((73, 3)))[3:-3, 3:-3])
    for degrees, expected, digits in (
        (5, 2.14e-4, 5e-7), (10, 1.65e-3, 5e-6), (30, 3.68e-2, 5e-5), (45, 0.10267, 5e-6), (90, 0.35032, 5e-6),
        (120, 0.35252, 5e-6), (180, pi / 4 - 2 / pi + stretch * pi / 2, 1e-8),
    ):  # fmt: skip
        i = 3 * (degrees // 5 - 1)
        outward = radial(degrees * pi / 180)
        assert outward @ compliance[i : i + 2, i : i + 2] @ outward == pytest.approx(expected, abs=digits)
    pulled = 3 * pi / 4 - 4 / pi + stretch * (pi / 2 + 8 / pi)
    assert compliance[3 * 35 + 1, 3 * 35 + 1] == pytest.approx(pulled, abs=5e-7)


def test_frequencies_of_a_thin_ring():
    """omega^2 = n^2 (n^2 - 1)^2/(n^2 + 1) of a free ring (E I = rho A = a = 1), at second order in the parts."""
    errors = []
    for parts in (24, 48):
        rod = closed(parts)
        matrix = np.zeros((3 * parts, 3 * parts))
        for p in range(parts):
            one, two = rod.place[p], rod.place[p + 1]
            by = np.hstack([chord_strains(one, two, 1), chord_strains(one, two, 2)])
            at = np.r_[3 * p : 3 * p + 3, 3 * ((p + 1) % parts) : 3 * ((p + 1) % parts) + 3]
            matrix[np.ix_(at, at)] += by.T @ rod.local[p] @ by
        # rotations without inertia follow
        turns = np.arange(2, 3 * parts, 3)
        moves = np.setdiff1d(np.arange(3 * parts), turns)
        stiffness = matrix[np.ix_(moves, moves)] - matrix[np.ix_(moves, turns)] @ np.linalg.solve(
            matrix[np.ix_(turns, turns)], matrix[np.ix_(turns, moves)]
        )
        squares = np.linalg.eigvalsh(stiffness / (2 * pi / parts))[3:9:2]
        n = np.array([2, 3, 4])
        errors.append(np.abs(squares / (n**2 * (n**2 - 1) ** 2 / (n**2 + 1)) - 1))
    assert errors[1].max() < 2e-2
    assert (np.log2(errors[0] / errors[1]) > 1.7).all()


class Elastica(NamedTuple):
    """A ring pinched by two opposite forces, in E I and a."""

    force: float
    half_width: float


def elastica(closing):
    """The inextensible ring without shear whose diameter is closed by ``closing`` radii, in elliptic integrals.

    On a quarter, from the load to the side, the tangent turns by theta = 0 to pi/2 and theta'' = (P/2) cos theta; the
    curvature of the unloaded ring is in no condition at either end, so that it shifts the moment and nothing else. Once
    the curvature under the load has changed sign, theta'(0)^2 = P (2 p - 1), p > 1/2, and sin^2(pi/4 - theta/2) =
    p sin^2 w takes w from -w_0 or pi - w_0, sin w_0 = 1/sqrt(2 p), through pi/2 (the inflection) to 0:

        pi/2 = sqrt(2/P) F,   height/2 = sqrt(2/P) (2 E - F),   width/2 = (2/P) (theta'(side) + |theta'(0)|),
        F = 2 K(p) - F(w_0 | p),   E = 2 E(p) - E(w_0 | p).
    """

    def integrals(p):
        w = asin(1 / sqrt(2 * p))
        return 2 * ellipk(p) - ellipkinc(w, p), 2 * ellipe(p) - ellipeinc(w, p)

    def too_high(p):
        first, second = integrals(p)
        return pi / 2 * (2 * second / first - 1) - (1 - closing / 2)

    p = brentq(too_high, 0.5, 0.99, xtol=1e-14)
    force = 8 * integrals(p)[0] ** 2 / pi**2
    return Elastica(force, 2 / force * (sqrt(2 * force * p) + sqrt(force * (2 * p - 1))))


def test_closed_form_of_the_elastica():
    """The same quarter as a boundary value problem, theta'' = (P/2) cos(theta), to its tolerance."""
    closing = 1.0

    def rates(s, y, p):
        return np.stack([y[1], p[0] / 2 * np.cos(y[0]), -np.sin(y[0]), np.cos(y[0])])

    s = np.linspace(0, pi / 2, 50)
    guess, force = np.stack([s, np.ones_like(s), np.cos(s) - 1, np.sin(s)]), 0.0
    for target in np.linspace(0.1, closing, 10):  # follow the branch from the circle
        found = solve_bvp(
            rates, lambda a, b, p, t=target: np.array([a[0], b[0] - pi / 2, a[2], b[2] + 1 - t / 2, a[3]]), s, guess,
            p=[force], tol=1e-10, max_nodes=20000,
        )  # fmt: skip
        assert found.success
        guess, force = found.sol(s), found.p[0]
    assert found.sol(0)[1] < 0  # the curvature under the load has changed sign
    assert elastica(closing) == pytest.approx((force, found.sol(pi / 2)[3]), rel=1e-9)


def pinched(parts, closing):
    """The same of the chain: the section at theta = pi pushed toward the one that is held."""
    rod = closed(parts, stretch=1e-8)
    q = np.zeros((parts + 1, 3))
    push = 3 * (parts // 2)
    free = np.setdiff1d(np.arange(3, 3 * parts), [push])
    count = 50
    for _ in range(count):
        matrix = dense_stiffness(rod, q)
        q[parts // 2, 0] += closing / count
        q.reshape(-1)[free] -= np.linalg.solve(matrix[np.ix_(free, free)], matrix[free, push] * closing / count)
        for _ in range(30):
            force = forces_of(rod, q)[1].ravel()[free]
            if np.abs(force).max() < 1e-6:  # a hundred times the round-off of a stretch; the last step squares it
                break
            step = np.linalg.solve(dense_stiffness(rod, q)[np.ix_(free, free)], force)
            q.reshape(-1)[free] -= step
        else:
            pytest.fail("no equilibrium")
    return Elastica(forces_of(rod, q)[1].ravel()[push], 1 + q[parts // 4, 1])


def test_elastica():
    """A ring pinched to half its diameter: force and width at fourth order in the parts, 2e-5 with 24.

    A part is linear but for its bow, without which the order is the second. The chain can be stretched and sheared by
    1e-8 of the force, P/2 at most on a section, which changes force and width by 1e-7 at most, a quarter of the least
    error here. The closed form of small deflections, P = 1/0.1488 per radius, is more than half as large again.
    """
    exact, counts = elastica(1.0), np.array([24, 32, 48])
    errors = np.abs(np.array([pinched(int(parts), 1.0) for parts in counts]) / exact - 1)
    assert 1 / (pi / 4 - 2 / pi) > 1.5 * exact.force
    assert errors[0].max() < 2e-5
    for error in errors.T:
        assert -np.polyfit(np.log(counts), np.log(error), 1)[0] == pytest.approx(4, abs=0.25)


def bent(shape, size=0.3, seed=0):
    """A chain that is bent far, at random but smoothly."""
    rng = np.random.default_rng(seed)
    theta = shape.rod.theta
    q = np.zeros((len(theta), 3))
    for n in (1, 2, 3):
        q += size * rng.standard_normal(3) * np.sin(n * (theta - theta[0]) * pi / (theta[-1] - theta[0]))[:, None]
    return q


@pytest.mark.parametrize("r", [1.02, 1.12])
def test_the_energy_of_a_bent_chain_goes_like_its_stiffness(r):
    """Of one shape, however far it is bent: geometry has no stiffness of its own."""
    made = HOOP.replace(hoop={"r": r}, solve={"elements": 240})
    soft, stiff = (made.replace(ring={"bending_stiffness": bending}) for bending in (3.0, 300.0))
    rods = [ChainRing(one, ring_of(one, 2, linear=False), 60).chain.rod for one in (soft, stiff)]
    q = bent(SimpleNamespace(rod=rods[0]))
    low, high = (strain_energy(rod, q) for rod in rods)
    assert high == pytest.approx(100 * low, rel=1e-12)


def test_forces_and_tangent_of_the_chain(thin):
    """The energy's derivatives by central differences; the tangent is symmetric."""
    rod, q = thin.rod, bent(thin)
    rng = np.random.default_rng(1)
    way = np.zeros_like(q)
    way[1:-1] = rng.standard_normal((len(q) - 2, 3))
    e = 1e-5 * np.diff(rod.theta).min()  # a random way turns the parts by it over their length
    powers = forces_of(rod, q)[1] * way
    work = (forces_of(rod, q + e * way)[0] - forces_of(rod, q - e * way)[0]) / (2 * e)
    # that turn squared, and round-off of the energy, 1e-18/e, of powers that cancel to a thousandth of their sizes
    assert work == pytest.approx(powers.sum(), abs=1e-9 * np.abs(powers).sum())
    tangent = dense_stiffness(rod, q)[3:-3, 3:-3]
    assert np.abs(tangent - tangent.T).max() < 1e-12 * np.abs(tangent).max()
    found = (forces_of(rod, q + e * way)[1] - forces_of(rod, q - e * way)[1])[1:-1].ravel() / (2 * e)
    assert np.abs(found - tangent @ way[1:-1].ravel()).max() < 1e-6 * np.abs(found).max()


def test_a_turned_chain_has_no_strain(thin):
    """Parts far from the weld, moved as one rigid body: their forces are round-off of the stiffness."""
    rod, turn = thin.rod, 0.7
    place = rod.place
    q = np.zeros((len(place), 3))
    c, s = cos(turn), sin(turn)
    q[:, 0] = (c - 1) * place[:, 0] - s * place[:, 1] + 0.3
    q[:, 1] = s * place[:, 0] + (c - 1) * place[:, 1]
    q[:, 2] = turn
    inside = forces_of(rod, q)[1][3:-3]
    assert np.abs(inside).max() < 1e-13 * np.abs(rod.local[5]).max()


def test_derivatives_of_the_rim(thin):
    """First derivatives everywhere, second ones away from the weld and without strains, by central differences."""
    rod, q = thin.rod, bent(thin, 0.1)
    near = np.abs(thin.ring.mesh.rim_theta) < 0.5
    nodes = RimNodes(*(column[near] for column in thin.nodes))
    rng = np.random.default_rng(2)
    way = np.zeros_like(q)
    way[1:-1] = rng.standard_normal((len(q) - 2, 3))
    e = 1e-6
    found = (follow(rod, q + e * way, nodes)[0] - follow(rod, q - e * way, nodes)[0]).ravel() / (2 * e)
    matrix = rim_matrix(rod, q, nodes)[1]
    assert np.abs(found - matrix @ way[1:-1].ravel()).max() < 1e-7 * np.abs(found).max()

    at = np.flatnonzero((nodes.part >= rod.rooted) & (nodes.part < len(q) - 1 - rod.rooted))
    force = rng.standard_normal((len(at), 2))
    some, rod = RimNodes(*(column[at] for column in nodes)), rod._replace(seen=0 * rod.seen)
    change = (rim_matrix(rod, q + e * way, some)[1] - rim_matrix(rod, q - e * way, some)[1]) / (2 * e)
    exact = np.zeros((len(q) + 2, 3))
    for k, part in enumerate(some.part):
        second = np.zeros((12, 12))
        rim_curvature(rod, q, part, some.xi[k], force[k, 0], force[k, 1], second)
        padded = np.concatenate([np.zeros((1, 3)), way, np.zeros((1, 3))])
        exact[part : part + 4] += (second @ padded[part : part + 4].ravel()).reshape(4, 3)
    assert np.abs(change.T @ force.ravel() - exact[2:-2].ravel()).max() < 1e-6 * np.abs(exact).max()


@pytest.mark.slow
@pytest.mark.parametrize("side", [1, -1])
def test_the_rim_has_no_step_at_the_end_of_the_weld(side):
    """A thick ring's first part is stretched, and all behind it goes along: so does the rim before it.

    From node to node it moves by a quarter of what it does where nodes are four times as far apart. It was off by a
    tenth of the way right where ended what is fitted to loads far away: a step of 1e-3 R, on a foundation that gives
    way by 1e-9 R.
    """
    most = []
    for around in (240, 960):
        shape = _Shape(Ring(ring_mesh(1 / 1.18, 1.0, around, 2), 0.3), 120)
        rod, theta = shape.rod, side * shape.ring.mesh.rim_theta
        way = 1e-3 * (rod.place[1] - rod.place[0] if side > 0 else rod.place[-2] - rod.place[-1])
        q = np.zeros_like(shape.still)
        q[1:-1, :2] = way
        moved = follow(rod, q, shape.nodes)[0] / np.linalg.norm(way)
        off, end = np.linalg.norm(moved - way / np.linalg.norm(way), axis=1), shape.compliance.weld
        assert off[(theta > end - 1e-9) & (theta < end + 0.1)].max() < 1e-12
        assert off[(theta > rod.theta[1]) & (theta < end)].max() < 5e-3  # cubics between sections have no more
        near = np.flatnonzero((theta > 0) & (theta < 1))
        steps = np.diff(moved[near[np.argsort(theta[near])]], axis=0)
        most.append(np.linalg.norm(steps, axis=1).max())
    assert most[1] < 0.3 * most[0]


def test_the_chain_is_the_mesh_for_small_loads(thin):
    """Compliance of the rim, chain and what it lacks together, against the mesh: 1e-5 of the largest.

    To it belongs what the contact has point by point, whose answer to the nodes' loads is their shape functions' share
    of it. Over the weld, where nothing is a thousandth of that, half a percent: what its neighbours lack is kept
    positive.
    """
    mesh = thin.ring.rim_compliance
    within = thin.ring.within * np.kron(np.linalg.inv(thin.ring.rim_products.toarray()), np.eye(2))
    whole = thin.rim @ thin.inverse @ thin.rim.T + thin.missing + within
    assert np.abs(whole - mesh).max() < 1e-5 * np.abs(mesh).max()
    over = np.flatnonzero(np.repeat(np.abs(thin.ring.mesh.rim_theta) < 0.04, 2))
    assert np.abs(whole - mesh)[np.ix_(over, over)].max() < 5e-3 * np.abs(mesh[np.ix_(over, over)]).max()
    assert np.linalg.eigvalsh(thin.missing).min() > -1e-9 * np.abs(mesh).max()


def test_vibrations_of_the_chain_are_those_of_the_mesh(thin):
    """The 12 slowest of the clamped ring: lumped masses are of second order, 4e-4 where a wave takes 20 parts."""
    squares = thin.ring.modes(12)[0]
    shapes = thin.shapes[:, :12]
    stiffness = dense_stiffness(thin.rod, thin.still)[3:-3, 3:-3]
    found = np.einsum("in,ij,jn->n", shapes, stiffness, shapes)
    assert found == pytest.approx(squares, rel=2e-3)


@pytest.mark.parametrize("kept", [[], [7, 8, 9], [2, 3], [10, 11], [2, 3, 11]])
def test_bordered_elimination(kept):
    """Against a dense solve of the same cyclic matrix, for patches anywhere on the ring."""
    n = 11
    rng = np.random.default_rng(len(kept))
    blocks = Blocks(*(rng.standard_normal(part.shape) for part in no_blocks(n + 2)))
    blocks.diagonal[:] += 8 * np.eye(3)
    blocks.columns[:, :, FRAME:], blocks.rows[:, :, FRAME:], blocks.corner[FRAME:] = 0, 0, 0
    blocks.corner[:, FRAME:] = 0
    blocks.corner[:FRAME, :FRAME] += 8 * np.eye(3)
    size = 3 + 3 * n
    dense = np.zeros((size, size))
    dense[:3, :3] = blocks.corner[:3, :3]
    for i in range(1, n + 1):
        at, behind = slice(3 * i, 3 * i + 3), slice(3 * (i % n) + 3, 3 * (i % n) + 6)
        dense[at, at] += blocks.diagonal[i]
        dense[at, behind] += blocks.up[i]
        dense[behind, at] += blocks.down[i]
        dense[at, :3], dense[:3, at] = blocks.columns[i, :, :3], blocks.rows[i, :, :3].T
    keeps = np.zeros(n + 2, bool)
    keeps[[1, *kept]] = True
    known = rng.standard_normal((n + 2, 3))
    known[[0, -1]] = 0
    frame = rng.standard_normal(3)
    factors = factor(blocks, keeps, 0)
    eliminate(factors.core, factors.pivots)
    found = solve(factors, frame, known, np.empty(0))[0]
    exact = np.linalg.solve(dense, np.concatenate([frame, known[1:-1].ravel()]))
    assert found == pytest.approx(exact, rel=1e-10, abs=1e-12)


def test_unknowns_in_their_own_equations_only():
    """Rim nodes off the floor, two by two among others: against a dense solve."""
    rng = np.random.default_rng(7)
    matrix, right = rng.standard_normal((20, 20)), rng.standard_normal(20)
    alone = [9, 10, 14, 15, 19]
    own = matrix.diagonal().copy()
    matrix[:, alone] = 0
    matrix[alone, alone] = own[alone]
    factors, order = matrix.copy(), np.empty(20, np.int64)
    eliminate(factors, order)
    assert solved_by((factors, order), right) == pytest.approx(np.linalg.solve(matrix, right), rel=1e-10)
    assert np.flatnonzero(order < 0).tolist() == alone
    assert (factors[alone] == matrix[alone]).all(), "and they cost nothing"
