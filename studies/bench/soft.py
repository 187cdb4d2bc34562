"""`hoop bench soft`: pulses of rings that bend and turn far, the chain against all nodes of the exact ring.

Both stand on the same mesh, so what lies between them is the chain's own: what its parts leave out of the mesh. Only
where a chain on few elements is asked for, whose rim is not as coarse as those, all nodes stand on the mesh that
``rtol`` chooses.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from functools import partial
from math import nan
from typing import TypeAlias

import flexible
from flexible import FlexibleMotion
from rigid import Contact, Friction, Hoop, Release, Ring, Run, Scene

from ..running.measures import time_off_floor
from .race import Claim, Contestant, Result, Row, race
from .rigid import remember

Measures: TypeAlias = dict[str, float]

CHAIN, NODES, LINEAR = "chain", "all nodes", "reduced"
ROUGH, USUAL, FINE = 1e-3, 3e-4, 1e-4  # tolerance of the chain, of all nodes it is held to, and of both in thick walls
SECONDS, CLOSE = 2.0, 0.01  # what is stated of a pulse that is resolved
PEAK, HOPS = "N_max", "off floor"
SMOOTH = ("J_F/J_N", "J_N", "loss")
COMPARED = (*SMOOTH, PEAK, HOPS)
LEAST_SCALE = 1e-3  # of what is compared; a difference is relative to no less


@dataclass(frozen=True)
class Soft:
    """A pulse that a linear ring would not do for."""

    name: str
    scene: Scene
    rtol: float = ROUGH
    """Of the chain that is compared."""
    known_to: float = USUAL
    """Tolerance of all nodes."""
    around: int = 240
    """As many elements as ``rtol`` chooses, or fewer: where it is said, and in thick walls."""
    nodes_around: int | None = None
    """All nodes', where the chain stands on fewer."""
    through: int = 2
    off: float | None = None
    """Largest difference of impulses and loss that is stated; None for a pulse that chatters."""
    peak_off: float = 0.015
    """The same of the largest normal force."""
    hops_off: float | None = CLOSE
    """The same of the time off the floor."""

    def on(self, level: str, rtol: float) -> Scene:
        """The scene for a level and a tolerance, all nodes on their own mesh."""
        around, through = self.around, None
        if level == "exact":
            around, through = self.nodes_around or around, self.through
        return self.scene.replace(solve={"level": level, "rtol": rtol, "elements": around, "through": through})

    @property
    def truth(self) -> Scene:
        """All nodes that it is held to."""
        return self.on("exact", self.known_to)


def _hoop(k: float, r: float, mass_ratio: float, bending: float, foundation: float, damping: float) -> Scene:
    return Scene(
        Hoop(k=k, r=r, mass_ratio=mass_ratio), Friction(0.35, 0.3), Release(phi0_deg=10), Run(until="pulse"),
        ring=Ring(bending_stiffness=bending), contact=Contact(stiffness=foundation, damping=damping),
    )  # fmt: skip


def softs(quick: bool) -> list[Soft]:
    """A wall of 2 %, softer and softer, undamped and damped; and thick walls."""
    thin = partial(_hoop, 0.1, 1.02, 0.05, foundation=1e8)
    thick = partial(_hoop, 0.2, mass_ratio=0.1, foundation=1e7, damping=1)
    rough = partial(Soft, rtol=FINE, known_to=FINE, off=CLOSE, peak_off=CLOSE, hops_off=None)
    ten = Soft("E I = 10, undamped", thin(bending=10, damping=0), off=CLOSE)
    one = Soft("E I = 1, undamped", thin(bending=1, damping=0), around=480, off=CLOSE)
    coarse = replace(one, name=f"{one.name}, 240 around", around=240, nodes_around=one.around, peak_off=CLOSE)
    if quick:
        return [ten, coarse]
    return [
        ten,
        Soft("E I = 3, undamped", thin(bending=3, damping=0), around=480, off=0.03),
        one,
        coarse,
        Soft("E I = 0.5, undamped", thin(bending=0.5, damping=0), around=480, off=CLOSE, peak_off=CLOSE),
        Soft("E I = 10", thin(bending=10, damping=1), off=CLOSE, peak_off=CLOSE),
        Soft("E I = 3", thin(bending=3, damping=1), around=480),
        Soft("E I = 1", thin(bending=1, damping=1), around=480, off=CLOSE),
        Soft("E I = 0.5", thin(bending=0.5, damping=1), around=480, off=0.015),
        rough("r = 1.1, E I = 20", thick(1.1, bending=20)),
        rough("r = 1.12, E I = 10", thick(1.12, bending=10)),
        rough("r = 1.18, E I = 5", thick(1.18, bending=5)),
    ]


def measures(motion: FlexibleMotion) -> Measures:
    """What is compared of a first pulse, by its name in the table, and its steps."""
    pulse = motion.pulses[0]
    return {
        "J_F/J_N": pulse.impulse_ratio,
        "J_N": pulse.normal_impulse,
        PEAK: pulse.peak_normal_force,
        "loss": pulse.friction_loss,
        HOPS: time_off_floor(motion, pulse),
        "steps": float(motion.steps),
    }


@dataclass
class Truth:
    """All nodes' answers by their scene, as they come in."""

    known: dict[Scene, Measures] = field(default_factory=dict)

    def judge(self, nodes: Scene, is_truth: bool, motion: FlexibleMotion) -> tuple[float, Measures]:
        """The largest relative difference of impulses and loss from all nodes, and all that is compared."""
        found = measures(motion)
        if is_truth:
            self.known[nodes] = found
            return nan, found
        true = self.known.get(nodes)
        off = {} if true is None else {f"{key} off": _off(found[key], true[key]) for key in COMPARED}
        return max(off.get(f"{key} off", nan) for key in SMOOTH), {**found, **off}


def _off(found: float, true: float) -> float:
    return abs(found - true) / max(abs(true), LEAST_SCALE)


def contestants(pulses: Iterable[Soft], truth: Truth, quick: bool) -> list[Contestant]:
    """Of each pulse all nodes first, unless they ran, then the chain and, once, what a step of a linear ring costs."""
    entries, ran = [], set()
    for pulse in pulses:

        def add(
            solver: str, setting: str, scene: Scene, is_truth: bool = False, once: bool = True, pulse: Soft = pulse
        ) -> None:
            entries.append(
                Contestant(
                    solver, setting, pulse.name, partial(flexible.simulate, scene),
                    partial(truth.judge, pulse.truth, is_truth), repeats=1 if once else None, memory=not once,
                )
            )  # fmt: skip

        if pulse.truth not in ran:
            add(NODES, f"rtol {pulse.known_to:.0e}", pulse.truth, is_truth=True)
            ran.add(pulse.truth)
        for rtol in (ROUGH, USUAL) if quick else (1e-2, ROUGH, USUAL, FINE):
            add(CHAIN, f"rtol {rtol:.0e}", pulse.on("chain", rtol), once=False)
    first = next(iter(pulses))
    step = partial(flexible.simulate, first.on("reduced", USUAL))
    entries.append(Contestant(LINEAR, f"rtol {USUAL:.0e}", first.name, step, lambda m: (nan, measures(m))))
    return entries


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """Time chain and all nodes, compare them, and check what is stated."""
    pulses, truth = softs(quick), Truth()
    flexible.simulate(pulses[0].on("chain", 1e-2))
    remember()
    rows = race(contestants(pulses, truth, quick), 2, progress)
    return Result(rows, _claims(rows, pulses), compared=COMPARED)


def _claims(rows: list[Row], pulses: list[Soft]) -> list[Claim]:
    def one(solver: str, rtol: float, name: str) -> Row | None:
        wanted = (solver, f"rtol {rtol:.0e}", name)
        return next((row for row in rows if (row.solver, row.setting, row.scene) == wanted and row.seconds), None)

    claims = []
    for pulse in pulses:
        chain = one(CHAIN, pulse.rtol, pulse.name)
        if chain is None or f"{PEAK} off" not in chain.more or pulse.off is None:
            continue
        claims.append(Claim(f"{pulse.name}: impulses and loss off all nodes", chain.error, pulse.off, True))
        claims.append(Claim(f"{pulse.name}: N_max off all nodes", chain.more[f"{PEAK} off"], pulse.peak_off, True))
        if pulse.hops_off is not None:
            claims.append(Claim(f"{pulse.name}: time off the floor", chain.more[f"{HOPS} off"], pulse.hops_off, True))
    fast = [row for pulse in pulses if (row := one(CHAIN, ROUGH, pulse.name)) is not None]
    slowest = max((row.least for row in fast), default=nan)
    claims.append(Claim(f"chain: seconds of a pulse at rtol {ROUGH:.0e}", slowest, SECONDS, True))
    chain, linear = one(CHAIN, USUAL, pulses[0].name), one(LINEAR, USUAL, pulses[0].name)
    if chain is not None and linear is not None:
        cost = (chain.least / chain.more["steps"]) / (linear.least / linear.more["steps"])
        claims.append(Claim("chain: a step's time over a reduced one's", cost, 5, True))
    return claims
