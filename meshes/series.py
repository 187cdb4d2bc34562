"""Fields in time on disk: a PVD that ParaView and pyvista open as it is, one VTU per block and instant.

::

    DIR/fields.pvd              times and files; names only files that are whole
    DIR/fields/ring-00000.vtu   and so on; a block that has not changed is not written again
    DIR/fields/history.npz      forces and phases of the run, for the curves below a picture
    DIR/fields/about.json       units of the fields, title

Every file is written under a temporary name and renamed, so a run may be killed at any moment.
"""

from __future__ import annotations

import json
import math
import operator
import os
import re
import zipfile
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from html import escape
from numbers import Real
from pathlib import Path
from types import TracebackType
from typing import Any, Self
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigid.output.whole import write_whole

from .fields import Frame, SeriesError
from .vtu import Encoder, read_vtu

Array = NDArray[np.float64]
_PVD = "fields.pvd"
_FOLDER = "fields"
_BLOCKS = ("ring", "rim", "disk", "floor")
_TAKEN = ("file", "allow_pickle")  # by numpy.savez_compressed


class SeriesWriter:
    """Writes frames as they come; use it in a ``with`` statement.

    Parameters
    ----------
    directory : path
        Created if need be; a series that is already there is removed, and nothing else.
    units : mapping of field name to unit, optional
        What the colour bar prints, e.g. ``{"von_mises": "m g/R²"}``.
    title : str
        Printed above pictures.

    Raises
    ------
    SeriesError
        The directory cannot be made or written to, the disk is full; so do all methods.

    Examples
    --------
    >>> with SeriesWriter("out") as writer:  # doctest: +SKIP
    ...     writer.history(t=t, normal_force=N, friction_force=F)
    ...     writer.add(Frame(0.0, {"ring": ring_block(ring, points, displacement=u)}))
    """

    def __init__(self, directory: str | Path, units: Mapping[str, str] | None = None, title: str = "") -> None:
        self.pvd = Path(directory) / _PVD
        self.folder = Path(directory) / _FOLDER
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
            old = _files_of(self.pvd)
            for path in (self.pvd, *old):  # it first, so that it never names files of another run
                path.unlink(missing_ok=True)
        except OSError as error:
            raise SeriesError(f"{directory} cannot hold a series: {error.strerror}.") from None
        self._units = dict(units or {})
        about = {"title": title, "units": dict(units or {})}
        _replace(self.folder / "about.json", json.dumps(about, indent=1, ensure_ascii=False).encode())
        self._encoder = Encoder()
        self._entries: list[str] = []
        self._last: dict[str, tuple[Any, str]] = {}
        self._frames = 0
        self._unnamed = 0
        self._time = -math.inf

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def add(self, frame: Frame) -> None:
        """Write one frame; times must increase.

        Raises
        ------
        SeriesError
            A time that is not after the last one, a field that a VTU file cannot hold, a block whose name is none for
            a file, or a disk that is full.
        """
        if not (isinstance(frame.time, Real) and self._time < frame.time < math.inf):
            raise SeriesError(f"a frame at t = {frame.time!r} cannot follow one at t = {self._time!r}.")
        for name in frame.blocks:
            if not re.fullmatch(r"[\w. -]+", name):
                raise SeriesError(f"a block named {name!r} is not possible: the name is a part of its file's.")
        entries = []
        for part, (name, block) in enumerate(frame.blocks.items()):
            last = self._last.get(name)
            if last is None or last[0] is not block:
                file = f"{name}-{self._frames:05d}.vtu"
                _replace(self.folder / file, self._encoder.encode(block, frame.time, name, self._units))
                last = self._last[name] = (block, file)
            entries.append(
                f'<DataSet timestep="{float(frame.time)!r}" group="" part="{part}" '
                f'name="{escape(name)}" file="{escape(f"{_FOLDER}/{last[1]}")}"/>'
            )
        self._entries.append("\n".join(entries))
        self._time = frame.time
        self._frames += 1
        self._unnamed += 1
        # every frame at first; less often in a long series, whose PVD takes longer to write than a frame
        if self._unnamed > self._frames // 100:
            self._write_pvd()

    def history(self, **arrays: ArrayLike) -> None:
        """Store curves of the run; may be called again, and the last call counts.

        Any arrays of numbers or strings may be kept. The pictures know ``t``, ``normal_force`` and
        ``friction_force`` (same length), and the phases as ``phase_kind`` (names), ``phase_start`` and
        ``phase_end``.

        Raises
        ------
        SeriesError
            Other arrays, the names ``file`` and ``allow_pickle``, or a disk that is full.
        """
        kept = {name: np.asarray(value) for name, value in arrays.items()}
        for name, value in kept.items():
            if name in _TAKEN:
                raise SeriesError(f"history {name} cannot be kept: numpy's own writer takes that name.")
            if value.dtype.kind not in "biufU":
                raise SeriesError(f"history {name} holds {value.dtype}: numbers or strings are needed.")
        _write(
            self.folder / "history.npz",
            lambda part: np.savez_compressed(part, **kept),  # type: ignore[arg-type]
        )

    def close(self) -> None:
        """Name the last frames in the PVD.

        Raises
        ------
        SeriesError
            The disk is full.
        """
        if self._unnamed:
            self._write_pvd()

    def _write_pvd(self) -> None:
        lines = [
            '<?xml version="1.0"?>',
            '<VTKFile type="Collection" version="1.0" byte_order="LittleEndian">',
            "<Collection>",
            *self._entries,
            "</Collection>",
            "</VTKFile>",
            "",
        ]
        _replace(self.pvd, "\n".join(lines).encode())
        self._unnamed = 0


@dataclass(frozen=True, eq=False)
class Series:
    """A series on disk; frames are read when they are asked for.

    ``len(series)`` is their number, ``series[i]`` one of them, an iteration gives all.

    Attributes
    ----------
    pvd : Path
        The file that lists it.
    times : (n_frames,) array
        Ascending, in the run's unit of time.
    """

    pvd: Path
    times: Array
    _files: tuple[dict[str, Path], ...] = field(repr=False)

    def __len__(self) -> int:
        return len(self._files)

    def __getitem__(self, index: int) -> Frame:
        """The frame of that number, negative ones from the end."""
        index = operator.index(index)
        blocks = {name: read_vtu(path) for name, path in self._files[index].items()}
        return Frame(float(self.times[index]), blocks)

    def __iter__(self) -> Iterator[Frame]:
        return (self[i] for i in range(len(self)))

    def nearest(self, time: float) -> Frame:
        """The frame whose time is nearest to ``time``; the first or last one of a time before or behind all.

        Raises
        ------
        SeriesError
            A time that is none.
        """
        return self[self.nearest_index(time)]

    def nearest_index(self, time: float) -> int:
        """The number of that frame."""
        if not isinstance(time, Real) or time != time:
            raise SeriesError(f"no frame is near t = {time!r}.")
        return int(np.abs(self.times - np.clip(time, self.times[0], self.times[-1])).argmin())

    @cached_property
    def history(self) -> dict[str, Any]:
        """Curves stored beside the frames, by name; empty if there are none.

        Raises
        ------
        SeriesError
            A damaged file.
        """
        path = self.pvd.parent / _FOLDER / "history.npz"
        if not path.exists():
            return {}
        try:
            with np.load(path, allow_pickle=False) as kept:
                return dict(kept)
        except (OSError, ValueError, NotImplementedError, zipfile.BadZipFile, zlib.error, EOFError):
            raise SeriesError(f"{path} is damaged: its curves do not decode.") from None

    @cached_property
    def about(self) -> dict[str, Any]:
        """Title of the run and units of the fields; a :class:`SeriesError` if that file is missing or damaged."""
        path = self.pvd.parent / _FOLDER / "about.json"
        try:
            return {"title": "", "units": {}, **json.loads(path.read_text("utf-8"))}
        except (OSError, ValueError, TypeError):
            raise SeriesError(f"{path} is missing or damaged: it says in which units the fields are.") from None


def read(path: str | Path) -> Series:
    """Open the series in a directory, or that of a PVD file.

    Raises
    ------
    SeriesError
        Nothing there, or something that is not a series; frames raise it when they are read.
    """
    pvd = Path(path)
    if os.path.isdir(pvd):  # which a name that is too long is not
        pvd = pvd / _PVD
        if not pvd.exists():
            raise SeriesError(f"{path} holds no series: there is no {_PVD} in it.")
    try:
        root = ElementTree.fromstring(pvd.read_bytes())
        frames: dict[float, dict[str, Path]] = {}
        for entry in root.iterfind("Collection/DataSet"):
            part = frames.setdefault(float(entry.attrib["timestep"]), {})
            part[entry.attrib["name"]] = pvd.parent / entry.attrib["file"]
    except OSError as error:
        raise SeriesError(f"{path} cannot be read: {error.strerror}.") from None
    except (ElementTree.ParseError, KeyError, ValueError):
        raise SeriesError(f"{pvd} is not the PVD of a hoop-pulse series, or it is damaged.") from None
    if not frames:
        raise SeriesError(f"{pvd} names no frames.")
    times = np.array(sorted(frames))
    return Series(pvd, times, tuple(frames[t] for t in times.tolist()))


def _files_of(pvd: Path) -> list[Path]:
    """What a writer has left: curves and frames, also those that a killed run had not named; nothing of others."""
    listed = pvd.read_text("utf-8", "replace") if pvd.is_file() else ""
    blocks = {*_BLOCKS, *re.findall(rf'file="{_FOLDER}/(.+?)-\d{{5,}}\.vtu"', listed)}
    frame = re.compile(rf"({'|'.join(map(re.escape, blocks))})-\d{{5,}}\.vtu")
    folder = pvd.parent / _FOLDER
    return [file for file in folder.glob("*-*.vtu") if frame.fullmatch(file.name)] + [folder / "history.npz"]


def _replace(path: Path, content: bytes) -> None:
    _write(path, lambda part: part.write_bytes(content))


def _write(path: Path, write: Callable[[Path], object]) -> None:
    try:
        write_whole(path, write)
    except OSError as error:
        raise SeriesError(f"{path} cannot be written: {error.strerror or error}.") from None
