"""A motion in a file: a zip of arrays (numpy's npz) with a header in JSON, written whole or not at all."""

from __future__ import annotations

import json
import os
import zipfile
import zlib
from collections.abc import Callable, Mapping
from importlib import metadata
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from .whole import write_whole

FORMAT = 6
"""Of the file; one that this program does not know is not guessed at."""

S = TypeVar("S")
M = TypeVar("M")


class MotionFileError(ValueError):
    """A file that is no motion: one sentence."""


class Stored(NamedTuple):
    """What a file keeps of a motion beside its scene."""

    kind: str  # the solver whose motion it is
    told: dict[str, Any]  # what JSON can hold
    arrays: dict[str, NDArray[Any]]


def version() -> str:
    """Of this program."""
    try:
        return metadata.version("hoop-pulse")
    except metadata.PackageNotFoundError:
        return "uninstalled"


def write(path: str | os.PathLike[str], scene: Mapping[str, Any], stored: Stored) -> None:
    """Write a file; an older one stays until the new one is whole."""
    header = {"format": FORMAT, "version": version(), "kind": stored.kind, "scene": scene, "told": stored.told}
    arrays = {"header": np.array(json.dumps(header)), **stored.arrays}

    def fill(part: Path) -> None:
        with part.open("wb") as file:  # savez would add a suffix to a name
            np.savez_compressed(file, allow_pickle=False, **arrays)

    write_whole(Path(path), fill)


def read(
    path: str | os.PathLike[str],
    readers: Mapping[str, Callable[[Stored, S], M]],
    scene_of: Callable[[Mapping[str, Any]], S],
) -> M:
    """What was written, as a motion.

    Parameters
    ----------
    path : path
    readers : mapping
        By kind, what makes a motion of what is stored and of a scene.
    scene_of : callable
        Makes a scene of what the file says.

    Raises
    ------
    MotionFileError
        Whatever is wrong with the file.
    """
    try:
        with np.load(path, allow_pickle=False) as file:
            header = json.loads(str(file["header"]))
            arrays = {name: file[name] for name in file.files if name != "header"}
        kind, writer = str(header["kind"]), header["version"]
        if header["format"] != FORMAT:
            raise MotionFileError(f"{path} was saved by version {writer}, in a format that {version()} does not read.")
        if kind not in readers:
            raise MotionFileError(f"{path} holds a motion of the {kind} hoop: {kind}.load_motion reads it.")
        return readers[kind](Stored(kind, header["told"], arrays), scene_of(header["scene"]))
    except MotionFileError:
        raise
    except OSError as error:
        raise MotionFileError(f"{path} cannot be read: {error.strerror or error}.") from None
    except (ValueError, KeyError, TypeError, IndexError, EOFError, AttributeError, NotImplementedError,
            AssertionError, MemoryError, zipfile.BadZipFile, zlib.error):  # fmt: skip
        raise MotionFileError(f"{path} is not a saved motion, or damaged.") from None
