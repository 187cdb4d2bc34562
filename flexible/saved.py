"""A motion of the flexible hoop from its file."""

from __future__ import annotations

from os import PathLike
from typing import Any

from rigid import Kind, Motion, Phase, Scene, Turn, scene_from_dict
from rigid.output.file import Stored, read
from rigid.output.units import in_units
from rigid.solve import unstored

from .builder import Piece, Sampler, history_of
from .motion import FlexibleMotion, FlexiblePulse, Ledger
from .segment import Segment


def load_motion(path: str | PathLike[str]) -> Motion:
    """A motion that was saved by ``motion.save``, of the flexible or of the rigid hoop, the same to the last bit.

    The states of the ring, of which fields are made, are not in the file.

    Raises
    ------
    MotionFileError
        Not a saved motion, or a damaged one.
    """
    return read(path, {"rigid": unstored, "flexible": _flexible}, scene_from_dict)


def _flexible(stored: Stored, scene: Scene) -> Motion:
    told = stored.told
    hoop = scene.to_dimensionless().hoop
    pieces = tuple(_piece(number, piece, stored, hoop) for number, piece in enumerate(told["pieces"]))
    sample = Sampler(pieces, scene)
    return FlexibleMotion(
        scene=scene,
        phases=tuple(map(_phase, told["phases"])),
        turns=tuple(Turn(**turn) for turn in told["turns"]),
        pulses=tuple(_pulse(pulse, sample) for pulse in told["pulses"]),
        ended=told["ended"],
        completed=told["completed"],
        sample=sample,
        ledger=Ledger(**told["ledger"]),
        steps=told["steps"],
        history=in_units(history_of(pieces), scene) if told["history"] else None,
    )


def _piece(number: int, told: dict[str, Any], stored: Stored, hoop: Any) -> Piece:
    start = f"{number}."
    arrays = {name.removeprefix(start): column for name, column in stored.arrays.items() if name.startswith(start)}
    where = {name: told[name] for name in ("t_start", "t_end", "origin", "x_C")}
    if "columns" in told:
        return Piece(**where, segment=Segment.of({name: arrays[name] for name in told["columns"]}, hoop))
    return Piece(**where, motion=unstored(Stored("rigid", told["rigid"], arrays), scene_from_dict(told["scene"])))


def _phase(told: dict[str, Any]) -> Phase:
    return Phase(**told | {"kind": Kind(told["kind"])})


def _pulse(told: dict[str, Any], sample: Sampler) -> FlexiblePulse:
    return FlexiblePulse(**told | {"phases": tuple(map(_phase, told["phases"])), "sample": sample})
