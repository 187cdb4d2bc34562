"""The ring cut into parts, each as stiff as the mesh there."""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from ...ring.fem import Ring
from .corotated import Rod
from .ends import bending, bow_of, chord_strains, ends, in_strains, is_jointed, pulled_of
from .section import RodCompliance, is_slender, radial
from .softening import fading_of, softening_of, strained_of
from .surface import pinch_of, seen_of

Array = NDArray[np.float64]

FINER, FADES = 3.0, 0.2  # parts at the weld, see cuts
JOINTED, LONGEST = 0.04, 0.2  # see behind_weld


def cuts(begin: float, parts: int) -> Array:
    """Angles (parts + 1,) of sections from ``begin`` round to as far before the weld, symmetric about pi.

    A wall between disk and floor bends next to the weld more than anywhere else: parts are ``FINER`` times as short
    there, and that fades over the angle ``FADES``.
    """
    x = np.linspace(begin, pi, 2001)
    density = 1 + (FINER - 1) * np.exp(-(x - begin) / FADES)
    grown = np.concatenate([[0.0], np.cumsum((density[1:] + density[:-1]) / 2)])
    half = np.interp(np.arange(parts + 1) / parts * 2 * grown[-1], grown, x)[: parts // 2 + 1]
    if parts % 2 == 0:
        half[-1] = pi
    behind = 2 * pi - half[::-1]
    return np.concatenate([half, behind[1:] if parts % 2 == 0 else behind])


def behind_weld(wall: float) -> float:
    """How far behind the weld the first section is at least: a wall, and in walls above ``JOINTED`` two.

    Two are what the wall there has of the third order best, see :mod:`flexible.chain.rod.orders`; of a part longer than
    ``LONGEST`` the own vibrations are missed.
    """
    return wall if wall <= JOINTED else max(wall, min(2 * wall, LONGEST))


def curve_weights(theta: Array) -> Array:
    """Weights of the parabola's slope through three neighbours, (n, 3); zero at the ends."""
    weights = np.zeros((len(theta), 3))
    before, behind = np.diff(theta)[:-1], np.diff(theta)[1:]
    weights[1:-1, 0] = -behind / (before * (before + behind))
    weights[1:-1, 1] = (behind - before) / (before * behind)
    weights[1:-1, 2] = before / (behind * (before + behind))
    return weights


def section_masses(theta: Array) -> Array:
    """Mass of each section, (n,), of a ring of unit mass; none of the first and the last, nor of the parts there."""
    halves = np.diff(theta) / (4 * pi)
    halves[0] = halves[-1] = 0.0
    masses: Array = np.concatenate([[0.0], halves[1:] + halves[:-1], [0.0]])
    return masses


def make_rod(compliance: RodCompliance, ring: Ring, parts: int) -> Rod:
    """The ring between the ends of the weld as a chain at E b = 1 and unit mass of the ring."""
    inner, weld, a = ring.mesh.inner / ring.mesh.outer, ring.mesh.weld_half_angle, compliance.radius
    first = compliance.weld
    if is_jointed(compliance, weld, 1 - inner):
        first = min(first, max(float(cuts(weld, parts)[1]), weld + behind_weld(1 - inner)))
    theta = np.concatenate([[weld], cuts(first, parts - 2), [2 * pi - weld]])
    place = a * np.column_stack([np.cos(theta), np.sin(theta)])
    pieces = [
        in_strains(compliance.piece(angle), chord_strains(a * radial(0.0), a * radial(angle), 2))
        for angle in np.diff(theta)[1:-1]
    ]
    end = ends(compliance, weld, float(theta[1]))
    ways = np.diff(place, axis=0)
    chords = np.hypot(*ways.T)
    local = np.stack([end.local[:3, :3], *pieces, end.local[3:, 3:]])
    softening = np.array([softening_of(bending(part), ring.poisson) for part in local])
    if end.far.any():
        softening[[0, -1]] = 0.0
    mass = section_masses(theta)
    return Rod(
        theta,
        place,
        chord=np.column_stack([ways, chords]),
        local=local,
        bow=np.stack([end.bow[0], *map(bow_of, pieces, chords[1:-1]), end.bow[1]]),
        pulled=np.array(
            [0.0, *(pulled_of(p, c, ring.poisson) for p, c in zip(pieces, chords[1:-1], strict=True)), 0.0]
        ),
        softening=softening,
        strained=np.array([strained_of(chord, 1 - inner) for chord in chords]),
        bent=end.bent,
        far=end.far,
        fading=fading_of(end.far[0], end.local[:3, :3]),
        across=end.local[:3, 3:].copy(),
        mass=mass,
        turning=mass * ((1 + inner**2) / 2 - a**2),
        curve=curve_weights(theta),
        offset=1 - a,
        pinch=0.0 if is_slender(ring) else pinch_of(inner, ring.poisson),
        reach=float(min(1.0, (theta[2] - theta[1]) / (theta[1] - theta[0]))),
        seen=np.zeros((parts + 1, 2, 4, 3))
        if is_slender(ring)
        else seen_of(local, chords, a, compliance.section[1, 1], ring.poisson),
        rooted=int(np.searchsorted(theta, compliance.weld - 1e-9)),
    )
