"""`hoop bench scaling`: cost against stiffness, cycles, mesh, scenes in a batch and workers, with fitted exponents."""

from __future__ import annotations

from collections.abc import Callable

import flexible
from rigid import Release, load_scene, simulate
from rigid.batch.cores import cores
from rigid.kernel.compile import patience

from .race import Claim, Contestant, Result, Row, exponent, race
from .rigid import batch_of
from .truth import reference

STIFFNESS, CYCLES, PULSES, MESH, BATCH, WORKERS, STEPS = (
    "foundation", "turns (rigid)", "turns (flexible)", "elements", "scenes in a batch", "workers", "time of one run",
)  # fmt: skip
BATCH_STEPS = 10_000


def _stiff(stiffness: float) -> Contestant:
    scene = reference.massless_pulse(1e-3).replace(contact={"stiffness": stiffness})
    return _sized(STIFFNESS, stiffness, lambda: flexible.simulate(scene))


def _sized(what: str, size: float, run: Callable[[], object], **more: object) -> Contestant:
    return Contestant(
        "hoop-pulse",
        f"{size:g}",
        what,
        run,
        lambda _: (float("nan"), {"size": size}),
        **more,  # type: ignore[arg-type]
    )


def _turns(turns: int) -> Contestant:
    scene = load_scene("paper-3.4-frictionless").replace(run={"turns": turns})
    return _sized(CYCLES, turns, lambda: simulate(scene))


def _flexible_turns(turns: int) -> Contestant:
    scene = load_scene("paper-3.3-light").replace(run={"turns": turns}, solve={"rtol": 1e-2, "level": "reduced"})
    return _sized(PULSES, turns, lambda: flexible.simulate(scene))


def _mesh(elements: int) -> Contestant:
    scene = reference.scene_b(1e-2, elements)
    return _sized(MESH, elements, lambda: flexible.simulate(scene))


def _long_run(steps: int) -> Contestant:
    """A flexible run of so many steps without history."""
    from flexible.models.reduced import ReducedHoop
    from flexible.start.handover import hand_over
    from flexible.time.adaptive import Limits, march
    from flexible.time.events import Ends

    scene = reference.scene_b(1e-3)
    scene = scene.replace(release=Release(2.9, 0.0), run={"t_end": 20.0}, solve={"start": "equilibrium"})

    def run() -> None:
        hoop = ReducedHoop(scene)
        state = hand_over(hoop, simulate(scene), 0.0)
        march(hoop, state, Ends(), scene.solve.rtol, Limits(most=steps))

    return _sized(STEPS, steps, run)


def bench(quick: bool = False, peers_too: bool = False, progress: Callable[[float], None] | None = None) -> Result:
    """Time everything that grows."""
    patience.renew(0)
    # the finest mesh last: what it leaves in memory would count for all that come after
    entries = [
        _sized(BATCH, count, batch_of(count), clock="wall") for count in ((100, 1000) if quick else (100, 1000, 10_000))
    ]
    entries += [
        _sized(WORKERS, workers, batch_of(2000, workers), clock="wall", memory=False)
        for workers in dict.fromkeys((1, cores()))
    ]
    entries += [_turns(turns) for turns in (20, 200, 2000)]
    entries += [] if quick else [_long_run(BATCH_STEPS)]
    entries += [_stiff(10.0**power) for power in ((6, 9, 12) if quick else range(6, 13))]
    entries += [_flexible_turns(turns) for turns in ((2, 4) if quick else (2, 4, 8, 16))]
    entries += [_mesh(elements) for elements in ((60, 240) if quick else (60, 120, 240, 480, 960))]
    rows = race(entries, 2 if quick else 5, progress)
    exponents = {}
    for what in dict.fromkeys(row.scene for row in rows):
        mine = [row for row in rows if row.scene == what and row.seconds]
        if len(mine) > 1:
            exponents[what] = exponent([row.more["size"] for row in mine], [row.least for row in mine])
    return Result(rows, _claims(rows), exponents)


def _claims(rows: list[Row]) -> list[Claim]:
    stiff = [row for row in rows if row.scene == STIFFNESS]
    claims = [
        Claim(
            "flexible: cost at a foundation of 1e12 over that at 1e6", stiff[-1].least / stiff[0].least, 2, at_most=True
        )
    ]
    big = [row for row in rows if row.scene == BATCH and row.more["size"] == BATCH_STEPS]
    long = [row for row in rows if row.scene == STEPS]
    for name, found in (("a batch of 1e4 scenes", big), ("a flexible run of 1e4 steps", long)):
        if found:
            claims.append(Claim(f"peak memory of {name}, MB", found[0].peak_memory, 300, at_most=True))
    return claims
