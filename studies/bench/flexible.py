"""`hoop bench flexible`: which knob buys what, against all nodes in the limit; and what each thing skipped saves."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from math import inf
from typing import Any

import flexible
from flexible.segment import peak
from flexible.time.methods import FOURTH
from rigid import Motion, Scene

from .peers.scipy_ivp import installed, scipy_turns
from .race import Claim, Contestant, Result, Row, race
from .rigid import MU, MU_S, PHI0, TURNS_ASKED, remember
from .skipped import skipped
from .truth import reference

SCENE_A, SCENE_B, MASSLESS = "scene A, full roll", "scene B, pulse", reference.MASSLESS
BEST = "rtol 1e-03"
RTOLS = 1e-2, 5e-3, 3e-3, 1.3e-3, 1e-3, 3e-4, 1e-4, 1e-5, 1e-6  # at 1.3e-3 the peak of scene B is right to a percent
SCIPY = "scipy DOP853"


def _judge(true: reference.Measured) -> Callable[[reference.Measured], tuple[float, dict[str, float]]]:
    def judge(found: reference.Measured) -> tuple[float, dict[str, float]]:
        error, peak = reference.errors(found, true)
        return error, {"error_peak": peak}

    return judge


def _motion(scene: Scene) -> Callable[[], reference.Measured]:
    """All of ``simulate``, the ring taken from the cache."""

    def run() -> reference.Measured:
        steps = flexible.simulate(scene, history=True, states=False).history
        assert steps is not None
        return reference.Measured(
            float(steps.normal_impulse[-1]),
            float(steps.friction_impulse[-1]),
            float(steps.friction_loss[-1]),
            peak(steps.t, steps.normal_force),
        )

    return run


def _hoop(scene: Scene, **options: int) -> Callable[[], reference.Measured]:
    """Scene B with another number of modes or contact points."""
    from flexible.models.reduced import ReducedHoop

    return lambda: reference.run_hoop(scene, ReducedHoop(scene, **options))


def contestants_b(quick: bool) -> list[Contestant]:
    """Scene B over every knob."""
    judge = _judge(reference.limit())
    entries = []

    def add(solver: str, setting: str, run: Callable[[], Any], repeats: int | None = None) -> None:
        entries.append(Contestant(solver, setting, SCENE_B, run, judge, repeats=repeats, memory=repeats is None))

    for rtol in (1e-2, 5e-3, 1.3e-3, 1e-3, 3e-4) if quick else RTOLS:
        add("hoop-pulse reduced", f"rtol {rtol:.1e}".replace(".0e", "e"), _motion(reference.scene_b(rtol)))
    for method, rtol in _others((1e-3,) if quick else (3e-3, 1e-3, 1e-4, 1e-5)):
        add(f"hoop-pulse {method}", f"rtol {rtol:.0e}", _motion(_by(method, reference.scene_b(rtol))))
    for elements in (120,) if quick else (60, 120, 480):
        add("hoop-pulse elements", f"{elements} elements", _motion(reference.scene_b(1e-3, elements)))
    for modes in (12,) if quick else (0, 4, 12, 48, 96):
        add("hoop-pulse modes", f"{modes} modes", _hoop(reference.scene_b(), modes=modes))
    for points in (12,) if quick else (6, 12, 48, 96):
        add("hoop-pulse points", f"{points} points", _hoop(reference.scene_b(), points=points))
    add("hoop-pulse all nodes", BEST, _motion(reference.scene_b(level="full")), 1)
    if not quick:
        for rtol in (1e-2, 1e-4, 1e-5):
            add("hoop-pulse all nodes", f"rtol {rtol:.0e}", _motion(reference.scene_b(rtol, level="full")), 1)
        add("hoop-pulse exact", BEST, _motion(reference.scene_b(level="exact")), 1)
    return entries


def _by(method: str, scene: Scene) -> Scene:
    return scene.replace(solve={"integrator": method})


def _others(rtols: tuple[float, ...]) -> list[tuple[str, float]]:
    """The method that is not the one used, at each tolerance."""
    return [("esdirk3" if rtol < FOURTH else "esdirk4", rtol) for rtol in rtols]


def _ratio_error(true: float) -> Callable[[Motion], float]:
    return lambda motion: abs(motion.pulses[0].impulse_ratio - true)


def contestants_rest(quick: bool) -> list[Contestant]:
    """Scene A; the massless pulse against itself at rtol 1e-6, which all nodes confirm (its ring is static); and the
    rigid hoop's first cycle as scipy computes it, for its price alone (its error: ``hoop bench rigid``)."""
    fine = flexible.simulate(reference.massless_pulse(1e-5 if quick else 1e-6)).pulses[0].impulse_ratio
    rtols = (3e-2, 1e-3) if quick else (3e-2, 1e-2, 1e-3, 1e-4, 1e-5)
    entries = [
        Contestant(
            f"hoop-pulse {'reduced' if method == 'auto' else method}", f"rtol {rtol:.0e}", MASSLESS,
            partial(flexible.simulate, _by(method, reference.massless_pulse(rtol))), _ratio_error(fine),
        )
        for method in ("auto", "esdirk4")  # without mass the other one at every tolerance
        for rtol in rtols
    ]  # fmt: skip
    cycle = partial(scipy_turns, 0.1, MU_S, MU, PHI0, TURNS_ASKED, SCIPY.split()[1], 1e-10)
    entries.append(Contestant(SCIPY, "rtol 1e-10", "rigid cycle", cycle, repeats=5))
    if not quick:
        entries.append(Contestant("hoop-pulse reduced", BEST, SCENE_A, _motion(reference.scene_a()), repeats=3))
    return entries


def _exudyn(quick: bool) -> list[Contestant]:
    """Exudyn's beam ring, where it is installed."""
    from .peers.exudyn_ring import turn

    true = reference.limit()

    def measured(peer: dict[str, float]) -> tuple[float, dict[str, float]]:
        # of J_N alone: its J_F does not converge, and it has no losses
        peak = abs(peer["peak_normal_force"] / true.peak_normal_force - 1)
        return abs(peer["normal_impulse"] / true.normal_impulse - 1), {"error_peak": peak}

    entries = [
        Contestant(
            "exudyn", f"{elements} elements, h = {step:g}", SCENE_B,
            partial(turn, reference.scene_b(), elements, step), measured, repeats=1, memory=False,
        )
        for elements, step in (((120, 2e-4),) if quick else ((120, 2e-4), (240, 1e-4)))
    ]  # fmt: skip
    if not quick:
        setting, scene = "120 elements, h = 0.001", reference.scene_a().replace(solve={"start": "undeformed"})
        entries.append(Contestant("exudyn", setting, SCENE_A, partial(turn, scene, 120, 1e-3), repeats=1, memory=False))
    return entries


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """Time everyone, then what is skipped, and check what is stated: in a process that has run for a while."""
    flexible.simulate(reference.scene_b(1e-2))
    remember()
    entries = contestants_b(quick) + contestants_rest(quick)
    if peers_too and installed("exudyn"):
        entries += _exudyn(quick)
    rows = race(entries, 2 if quick else 5, None if progress is None else lambda x: progress(0.8 * x))
    if peers_too and not installed("exudyn"):
        rows.append(Row("exudyn", "-", "-", [], note="not installed"))
    return Result(rows + skipped(quick), _claims(rows))


def _one(rows: list[Row], solver: str, setting: str, scene: str) -> Row | None:
    return next((r for r in rows if (r.solver, r.setting, r.scene) == (solver, setting, scene) and r.seconds), None)


def _claims(rows: list[Row]) -> list[Claim]:
    ours = _one(rows, "hoop-pulse reduced", BEST, SCENE_B)
    full = _one(rows, "hoop-pulse all nodes", BEST, SCENE_B)
    finer = _one(rows, "hoop-pulse reduced", "rtol 3e-04", SCENE_B)  # rtol bounds impulses; N wants a shorter step
    assert ours is not None
    assert full is not None
    assert finer is not None
    claims = [
        Claim("flexible: reduced faster than all nodes, scene B, rtol 1e-3", full.least / ours.least, 20),
        Claim("flexible: error of impulses, scene B, rtol 1e-3", ours.error, 2e-3, at_most=True),
        Claim("flexible: error of the peak, scene B, rtol 3e-4", finer.more["error_peak"], 0.01, at_most=True),
    ]
    cheap = min(
        (r for r in rows if r.scene == SCENE_B and r.solver == "hoop-pulse reduced" and _good(r)),
        key=lambda row: row.least,
        default=ours,
    )
    for scene, setting, mine in (
        (SCENE_B, "240 elements, h = 0.0001", cheap),
        (SCENE_A, "120 elements, h = 0.001", _one(rows, "hoop-pulse reduced", BEST, SCENE_A)),
    ):
        peer = _one(rows, "exudyn", setting, scene)
        name = f"flexible: faster than Exudyn, {scene}"
        if peer is None or mine is None:
            claims.append(Claim(name, float("nan"), 100, why_not="Exudyn was not run"))
        else:
            claims.append(Claim(name, peer.least / mine.least, 100))
    cycle = next(row for row in rows if row.solver == SCIPY)
    exact = [row.least for row in rows if row.scene == MASSLESS and row.seconds and row.error <= 2e-4]
    name = "flexible: massless pulse at 2e-4 in J_F/J_N over scipy's rigid cycle at rtol 1e-10, time"
    claims.append(Claim(name, min(exact, default=inf) / cycle.least, 1.5, at_most=True))
    good = [row.least for row in rows if row.scene == SCENE_B and row.solver == "hoop-pulse reduced" and _good(row)]
    name = "flexible: scene B at 1 % of N_max over scipy's rigid cycle at rtol 1e-10, time"
    claims.append(Claim(name, min(good, default=inf) / cycle.least, 1.5, at_most=True))
    return claims


def _good(row: Row) -> bool:
    """At least as exact as is asked of scene B."""
    return row.error <= 2e-3 and row.more.get("error_peak", 1.0) <= 0.01
