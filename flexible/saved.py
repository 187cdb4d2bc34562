"""A motion of the flexible hoop from its file."""

from __future__ import annotations

from os import PathLike
from typing import Any

from rigid import Kind, Motion, Phase, Scene, Turn, scene_from_dict
from rigid.output.file import Stored, read
from rigid.output.units import in_units
from rigid.solve import unstored

from .models.select import hoop_of
from .models.state import Books
from .motion import FlexibleMotion, FlexiblePulse, Kept, Ledger, March
from .packed import unpack
from .pieces import Piece, Sampler
from .segment import Segment, history_of
from .time.control import Pace
from .time.course import Course, Marched, Standing


def load_motion(path: str | PathLike[str]) -> Motion:
    """A motion that was saved by ``motion.save``, of the flexible or of the rigid hoop, the same to the last bit.

    The states of the ring, of which fields are made, are in the file if the motion had kept them; with
    ``simulate(scene, resume=motion)`` it goes on.

    Raises
    ------
    MotionFileError
        Not a saved motion, or a damaged one.
    """
    return read(path, {"rigid": unstored, "flexible": _flexible}, scene_from_dict)


def _flexible(stored: Stored, scene: Scene) -> Motion:
    told = stored.told
    plain = scene.to_dimensionless()
    pieces = tuple(_piece(number, piece, stored, plain) for number, piece in enumerate(told["pieces"]))
    sample = Sampler(pieces, scene)
    return FlexibleMotion(
        scene=scene,
        phases=tuple(map(_phase, told["phases"])),
        turns=tuple(Turn(**turn) for turn in told["turns"]),
        pulses=tuple(_pulse(pulse, sample) for pulse in told["pulses"]),
        ended=told["ended"],
        completed=told["completed"],
        sample=sample,
        period=told["period"],
        ledger=Ledger(**told["ledger"]),
        steps=told["steps"],
        kept=_kept(stored, scene),
        marches=tuple(_march(number, march, stored, pieces) for number, march in enumerate(told["marches"])),
        history=in_units(history_of(piece.segment for piece in pieces), scene) if told["history"] else None,
    )


def _piece(number: int, told: dict[str, Any], stored: Stored, scene: Scene) -> Piece:
    arrays = _named(f"{number}.", stored)
    where = {name: told[name] for name in ("t_start", "t_end", "origin", "x_C")}
    if "columns" in told:
        return Piece(**where, segment=Segment.of({name: arrays[name] for name in told["columns"]}, scene, told["rise"]))
    return Piece(**where, motion=unstored(Stored("rigid", told["rigid"], arrays), scene_from_dict(told["scene"])))


def _named(start: str, stored: Stored) -> dict[str, Any]:
    return {name.removeprefix(start): column for name, column in stored.arrays.items() if name.startswith(start)}


def _march(number: int, told: dict[str, Any], stored: Stored, pieces: tuple[Piece, ...]) -> March:
    records = [piece.segment for piece in pieces if piece.segment is not None][number].records()
    end, state = unpack(_named(f"march{number}.", stored))
    told["course"]["pace"] = Pace(*told["course"]["pace"])
    now = Standing(state=state, books=Books(**told["books"]), cut=False, **told["course"])
    marched = Marched(end, records, told["attempts"], None, Course(now, records, told["length"]))
    return March(marched, tuple((t, turned, phi) for t, turned, phi in told["turned"]))


def _kept(stored: Stored, scene: Scene) -> tuple[Kept, ...]:
    if not stored.told["kept"]:
        return ()
    hoop = hoop_of(scene.to_dimensionless())
    return tuple(Kept(hoop, unpack(_named(f"kept{i}.", stored))) for i in range(len(stored.told["marches"])))


def _phase(told: dict[str, Any]) -> Phase:
    return Phase(**told | {"kind": Kind(told["kind"])})


def _pulse(told: dict[str, Any], sample: Sampler) -> FlexiblePulse:
    return FlexiblePulse(**told | {"phases": tuple(map(_phase, told["phases"])), "sample": sample})
