"""Files written whole or not at all, and file troubles in one sentence."""

from __future__ import annotations

import errno
import json
import math
import os
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from rigid.output import whole


class StudyError(ValueError):
    """Something a user can mend, in one sentence."""


_TROUBLES = {
    errno.ENOSPC: "the disk is full",
    errno.EDQUOT: "the disk quota is used up",
    errno.EFBIG: "the file would grow past the size this system allows",
    errno.EACCES: "permission is denied",
    errno.EPERM: "permission is denied",
    errno.EROFS: "the file system is read-only",
    errno.ENOENT: "there is no such file or folder",
    errno.EEXIST: "a file of that name is in the way",
    errno.ENOTDIR: "a part of the path is a file, not a folder",
    errno.EISDIR: "it is a folder",
    errno.ENAMETOOLONG: "the name is too long",
}


def trouble(error: OSError, path: str | Path | None = None) -> str:
    """An operating system error as one sentence that names the file."""
    name = path if path is not None else error.filename
    if name is not None and os.path.islink(name) and not os.path.exists(name):
        return f"{name} cannot be used: it is a link that leads nowhere."
    reason = _TROUBLES.get(error.errno or 0, (error.strerror or str(error)).lower())
    if error.errno is None and " requested and " in str(error):  # numpy's, which has it from no system
        reason = "the disk is full, or the file would grow past the size this system allows"
    return f"{name} cannot be used: {reason}." if name is not None else f"Output cannot be written: {reason}."


def folder(path: str | Path) -> Path:
    """``path`` as a folder that exists and takes a new file, cleared of what writers that died left there.

    Raises
    ------
    StudyError
        It cannot be made, or nothing can be written into it.
    """
    path = Path(path)
    try:
        path.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=path):
            pass
        clear_parts(path)
    except OSError as error:
        raise StudyError(trouble(error, path)) from None
    return path


_FORGOTTEN = 24 * 3600.0
"""Seconds after which a part of another machine's is taken for left behind: no file here takes a minute to write."""


def clear_parts(path: Path) -> None:
    """Remove the parts of files that processes which have died left in a folder: nobody will finish them.

    A part's name says whose it is. Of another machine's processes, on a shared disk, it cannot be known whether they
    live; their parts go by their age.
    """
    for part in path.glob(f"{whole.PART}*"):
        host, _, rest = part.name.removeprefix(whole.PART).rpartition("-")[0].rpartition("-")
        with suppress(OSError):  # its writer may have finished it meanwhile
            if host == whole.host() and rest.isdecimal() and os.name == "posix":
                left = not _alive(int(rest))
            else:
                left = time.time() - part.stat().st_mtime > _FORGOTTEN
            if left:
                part.unlink()


def _alive(process: int) -> bool:
    """Whether a process of this machine lives (POSIX: elsewhere signal 0 is not a question)."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # it lives and is another user's
        return True
    return True


def write_whole(path: str | Path, write: Callable[[Path], Any]) -> Path:
    """Let ``write`` fill a temporary file beside ``path``, then rename: see :func:`rigid.output.whole.write_whole`.

    Raises
    ------
    StudyError
        The folder cannot be written to or the disk is full; nothing is left behind.
    """
    path = Path(path)
    try:
        whole.write_whole(path, write, synced=True)
    except OSError as error:
        raise StudyError(trouble(error, path)) from None
    return path


def write_text(path: str | Path, text: str) -> Path:
    """Write a text file, which ends with a newline, whole or not at all.

    A name in it whose bytes are no UTF-8 keeps these bytes.
    """
    whole = text if not text or text.endswith("\n") else f"{text}\n"
    return write_whole(path, lambda part: part.write_text(whole, encoding="utf-8", errors="surrogateescape"))


def plain(value: Any) -> Any:
    """``value`` in JSON's own types: numpy scalars and arrays unpacked, NaN and infinity as null."""
    if isinstance(value, Mapping):
        return {str(key): plain(entry) for key, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    if isinstance(value, str):
        return str(value)
    return value


def to_json(value: Any, indent: int | None = 2) -> str:
    """JSON that any reader takes: no NaN, no infinity; without a newline at its end."""
    return json.dumps(plain(value), indent=indent, allow_nan=False, ensure_ascii=False)
