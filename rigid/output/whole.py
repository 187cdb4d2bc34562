"""Files that are there whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path


def write_whole(path: Path, write: Callable[[Path], object]) -> None:
    """Let ``write`` fill a file beside ``path``, then rename it: a reader sees all of it or none.

    Its temporary name keeps the suffix, from which writers tell the format.

    Raises
    ------
    OSError
        It cannot be written; the error names ``path``, never the temporary file.
    """
    part = path.with_name(f".{os.getpid()}-{path.name}")
    try:
        write(part)
        os.replace(part, path)
    except OSError as error:
        if error.errno is None:  # a sentence of some library's, which may name what it was given
            raise OSError(str(error).replace(str(part), str(path))) from None
        raise OSError(error.errno, error.strerror, str(path)) from None
    finally:
        part.unlink(missing_ok=True)
