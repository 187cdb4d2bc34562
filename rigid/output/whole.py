"""Files that are there whole or not at all."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path

PART = ".part-"
"""With what the name of an unfinished file begins; then come machine, process and what tells its threads apart."""


@cache
def host() -> str:
    """Name of this machine."""
    import platform

    return platform.node() or "here"


def try_out(path: Path) -> None:
    """Find out before the work whether a file can be written there; nothing is left of it, and nothing touched.

    Raises
    ------
    OSError
        As :func:`write_whole` would have it, naming ``path``: its folder takes no file, its name cannot be one's.
    """
    import tempfile

    try:
        if path.is_dir():
            raise OSError(errno.EISDIR, os.strerror(errno.EISDIR))
        with suppress(FileNotFoundError):
            path.lstat()  # a name too long is no file that is not there
        with tempfile.TemporaryFile(dir=path.parent):
            pass
    except OSError as error:
        raise OSError(error.errno, error.strerror, str(path)) from None


def write_whole(path: Path, write: Callable[[Path], object], synced: bool = False) -> None:
    """Let ``write`` fill a file beside ``path``, then rename it: a reader sees all of it or none.

    Its temporary name keeps the suffix, from which writers tell the format, and is no other's: any number of threads
    and processes may write the same file, and the last one counts.

    Parameters
    ----------
    path : Path
    write : callable
        Takes the temporary path, of an empty file.
    synced : bool
        Whether the file is on the disk before it has its name, so that it outlives a loss of power.

    Raises
    ------
    OSError
        It cannot be written; the error names ``path``, never the temporary file, and nothing is left behind.
    """
    if not path.name:  # "", "." and "/"
        raise OSError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    part = path.with_name(f"{PART}{host()}-{os.getpid()}-{os.urandom(6).hex()}{path.suffix}")
    named = False
    try:
        part.touch(exist_ok=False)
        write(part)
        if synced:
            with part.open("rb+") as whole:
                os.fsync(whole.fileno())
        os.replace(part, path)
        named = True
    except OSError as error:
        if error.errno is None:  # a sentence of some library's, which may name what it was given
            raise OSError(str(error).replace(str(part), str(path))) from None
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        if not named:
            with suppress(OSError):  # of a file that could not be made either: the error that counts is on its way
                part.unlink(missing_ok=True)
