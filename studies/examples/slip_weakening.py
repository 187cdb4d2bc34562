"""A compliance of one's own beside the paper's: bristles whose friction falls from mu_s to mu over a distance of slip.

A rigid ring without mass on springs side by side, by steps short enough for its fastest vibration; R = m = g = 1.
What it says of the limit of stiffness is in studies/README.md.
"""

from math import cos, floor, sin, sqrt
from pathlib import Path
from typing import Any, NamedTuple

import matplotlib.pyplot as plt
import numpy as np
from numba import njit

import rigid
from flexible.models.rim_contact import relaxation_time

POINTS = 12  # to the half-width of a patch under the weight
WINDOW = 400  # points, more than ever touch


class Floor(NamedTuple):
    """Springs, dampers and friction."""

    eps: float  # foundation
    eps_t: float  # of the bristles
    theta: float  # the damper's time
    mu_s: float
    mu: float
    distance: float  # of slip over which a point's friction falls, 0 for at once


@njit
def impulses(pose: Any, hoop: Any, under: Any, start: float, stop: float) -> tuple[float, float]:
    """J_N and J_F between two angles, of a hoop (e, K) that rolls at the pose (phi, phidot)."""
    phi, omega, slip, rising = pose[0], pose[1], 0.0, 0.0
    half = (1.5 / under.eps) ** (1 / 3)
    spacing, height = half / POINTS, -(half**2) / 2
    first, last, origin, J_N, J_F = 0, -1, phi, 0.0, 0.0
    stretch, slipped = np.zeros(WINDOW), np.zeros(WINDOW)
    while phi < stop:
        a, rise = hoop[0] * sin(phi), 1 + hoop[0] * cos(phi)
        width = sqrt(max(-2 * height, 1e-16))
        elastic, rate, stiff = 2 / 3 * under.eps * width**3, -2 * under.eps * width * rising, 2 * under.eps * width
        normal = max(0.0, elastic + under.theta * rate)
        at = (phi - origin) / spacing
        low, high = -floor(width / spacing - at), floor(width / spacing + at)
        friction = 0.0
        for i in range(low, high + 1):
            slot = i % WINDOW
            if i < first or i > last:  # it comes to touch
                stretch[slot], slipped[slot] = 0.0, 0.0
            pressure = normal / elastic * under.eps * (-height - ((i - at) * spacing) ** 2 / 2)
            fallen = min(slipped[slot] / under.distance, 1.0) if under.distance > 0 else min(slipped[slot] * 1e30, 1.0)
            most = (under.mu_s + (under.mu - under.mu_s) * fallen) * max(pressure, 0.0) / under.eps_t
            slipped[slot] += max(abs(stretch[slot]) - most, 0.0)
            stretch[slot] = min(max(stretch[slot], -most), most)
            friction -= under.eps_t * stretch[slot] * spacing
        first, last = low, high
        alpha = (normal * a - friction * rise) / hoop[1]
        fast = max(sqrt(stiff * (1 + (a**2 + rise**2) / hoop[1])), under.theta * stiff * (1 + a**2 / hoop[1]))
        h = min(spacing / omega / 4, 0.2 / fast)
        rising += h * (normal - 1 + a * alpha + hoop[0] * cos(phi) * omega**2)
        slip += h * (friction - rise * alpha + a * omega**2)
        omega += h * alpha
        if phi > start:
            J_N, J_F = J_N + h * normal, J_F + h * friction
        phi, height = phi + h * omega, height + h * rising
        for i in range(first, last + 1):
            stretch[i % WINDOW] += h * slip
    return J_N, J_F


def carried(distance: float, mu_s: float, mu: float, points: int = 2000) -> float:
    """Largest F/N of a patch in steady rolling; the distance over mu_s p_0/eps_t, at which the middle would break."""
    u = (np.arange(points) + 0.5) / points  # from the leading edge
    pressure, most = 4 * u * (1 - u), 0.0
    for way in np.geomspace(0.5, 60, 600)[:, None] * u:
        soft = 1 - (1 - mu / mu_s) * pressure / distance if distance > 0 else 0 * u
        slip = np.where(soft > 0, (way - pressure) / np.where(soft > 0, soft, 1.0), np.inf)
        slip = np.where(slip < distance, slip, way - mu / mu_s * pressure)
        slip = np.maximum.accumulate(np.where(way > pressure, slip, 0.0))
        most = max(most, float((way - slip).sum() / pressure.sum()))
    return mu_s * most


def ratio(scene: rigid.Scene, foundation: float, distance: float) -> float:
    """J_F/J_N of the first pulse of a hoop that rolls at phi = 0.45, in the window of the rigid hoop's."""
    motion, friction = rigid.simulate(scene), scene.friction
    pulse, t = motion.pulses[0], np.linspace(0, motion.phases[0].t_end, 200001)
    states = motion.at(t)
    pose = tuple(float(np.interp(0.45, states.phi, column)) for column in (states.phi, states.omega))
    hoop = scene.hoop.constants
    floor_ = scene.replace(contact={"stiffness": foundation, "damping": 1.0})
    under = Floor(
        foundation,
        scene.contact.tangential_ratio * foundation,
        relaxation_time(floor_),
        friction.mu_s,
        friction.mu,
        distance,
    )
    normal, along = impulses(pose, (hoop.e, hoop.K), under, pulse.phi_start, pulse.phi_end)
    return along / normal


def half_width(foundation: float, force: float = 1.0) -> float:
    """Of the patch under a force; the weight, where none is given."""
    return float((1.5 * force / foundation) ** (1 / 3))


def stretch_at_break(scene: rigid.Scene, foundation: float) -> float:
    """mu_s p_0/eps_t under the N at which the rigid hoop begins to slip."""
    motion = rigid.simulate(scene)
    force = float(motion.at(motion.phases[0].t_end, "left").normal_force)
    most = 0.75 * force / half_width(foundation, force)
    return scene.friction.mu_s * most / (scene.contact.tangential_ratio * foundation)


def limit(scene: rigid.Scene, distance: float) -> float:
    """J_F/J_N of the rigid hoop whose static coefficient is at each break what a patch carries there.

    ``distance`` over u_b under the N at the first break; u_b goes like N^(2/3), and N at the second, inside the pulse,
    is a hundred times as large. The two halves of the pulse are those of two runs, which meet where the hoop sticks.
    """
    first = scene.replace(friction={"mu_s": carried(distance, scene.friction.mu_s, scene.friction.mu)})
    motion = rigid.simulate(first)
    sticks = next(phase for phase in motion.phases[1:] if phase.kind == rigid.Kind.ROLL)
    there, before = motion.at(sticks.t_start), float(motion.at(motion.phases[0].t_end, "left").normal_force)
    second = first.replace(release={"phi0": float(there.phi), "omega0": float(there.omega)})
    for _ in range(6):  # the coefficient says when it breaks, and N there the coefficient
        again = rigid.simulate(second)
        share = (before / float(again.at(again.phases[0].t_end, "left").normal_force)) ** (2 / 3)
        carries = carried(distance * share, scene.friction.mu_s, scene.friction.mu)
        second = second.replace(friction={"mu_s": carries})
    halves = rigid.simulate(first.replace(run={"turns": None, "t_end": sticks.t_start})).pulses[0], again.pulses[0]
    return sum(half.friction_impulse for half in halves) / sum(half.normal_impulse for half in halves)


def main(out: Path = Path(), foundations: tuple[float, ...] = (1e8, 1e9, 1e10, 1e11)) -> Path:
    scene = rigid.load_scene("paper-3.3-massless")
    slow = scene.replace(friction={"mu": scene.friction.mu_s})
    paper, always = (float(rigid.simulate(each).pulses[0].impulse_ratio) for each in (scene, slow))
    laws = {
        "at once": (lambda eps: 0.0, limit(scene, 0.0)),
        "u_b": (lambda eps: stretch_at_break(scene, eps), limit(scene, 1.0)),
        "10 u_b": (lambda eps: 10 * stretch_at_break(scene, eps), limit(scene, 10.0)),
        "√(u_b A)/3": (lambda eps: sqrt(stretch_at_break(scene, eps) * half_width(eps)) / 3, paper),
        "1e-4 R": (lambda eps: 1e-4, always),
    }
    figure, axes = plt.subplots(layout="constrained")
    for i, (name, (distance, tends)) in enumerate(laws.items()):
        found = [ratio(scene, eps, distance(eps)) for eps in foundations]
        print(f"{name:21} {' '.join(f'{each:.5f}' for each in found)}  limit {tends:.5f}")
        axes.semilogx(foundations, found, "o-", color=f"C{i}", label=name)
        axes.axhline(tends, color=f"C{i}", linewidth=0.8, linestyle="--")
    axes.set(
        xlabel=r"foundation $\epsilon_n R^2/(mg)$",
        ylabel="$J_F/J_N$",
        title="Friction that falls over a distance of slip",
    )
    figure.legend(loc="outside lower center", ncols=3)
    figure.savefig(out / "slip-weakening.png", dpi=150)
    plt.close(figure)
    return out / "slip-weakening.png"


if __name__ == "__main__":
    main()
