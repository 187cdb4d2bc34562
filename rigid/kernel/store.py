"""Where compiled kernels are kept: in a cache of the user's, under a fingerprint of all that they are made of.

numba keeps compiled code beside the source file of a function and looks at that file alone. Here each function is
compiled from a copy of its source that stands in a folder of its own,

    <cache of the user>/<version, numba, Python, CPU>/<module>-<fingerprint>/

so numba's own, documented cache puts the code there: never into the package, where it would outlive an uninstallation,
and never under the fingerprint of other sources, the callees' included. Installations of the same sources share a
folder, wherever they are. The cache is ``NUMBA_CACHE_DIR`` where that is set, else the platform's. What an installation
has beside its packages (``hoop compile --shared``), or what a ``NUMBA_CACHE_DIR`` that cannot be written holds, is
copied from there instead of compiled again. What nothing has used for two months is removed. On a full disk code is
compiled and not kept.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import logging
import os
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from functools import cache
from importlib import metadata
from pathlib import Path
from types import FunctionType
from typing import Any

from ..output.whole import PART, write_whole

NAME = "hoop-pulse"
PACKAGES = ("rigid", "meshes", "flexible", "studies")
SHARED = ".hoop-pulse-kernels"  # beside the packages, and no name that could be imported
UNUSED_DAYS = 60  # after which the kernels of other sources or versions are removed


def sources(files: Iterable[str | Path]) -> list[Path]:
    """The files given, and every file of the same installation that they import, directly or not."""
    waiting = [Path(file) for file in files]
    found: set[Path] = set()
    while waiting:
        file = waiting.pop()
        if file not in found:
            found.add(file)
            waiting += _imports(file)
    return sorted(found)


# Statements that import, wherever in a file they stand; a sentence of a docstring that looks like one names no file.
# (To parse a file as Python takes ten times as long, and every process reads them all.)
_IMPORT = re.compile(r"^[ \t]*import[ \t]+(.+)$", re.MULTILINE)
_FROM = re.compile(r"^[ \t]*from[ \t]+(\.*)([\w.]*)[ \t]+import[ \t]+(\([^)]*\)|.+)$", re.MULTILINE)
_NAME = re.compile(r"[\w.]+")


@cache
def _imports(file: Path) -> tuple[Path, ...]:
    """Files of this installation that a file imports."""
    root = _root(file)
    text = file.read_text(encoding="utf-8")
    named = [[Path(root, *name.split(".")) for name in _NAME.findall(names)] for names in _IMPORT.findall(text)]
    for dots, package, names in _FROM.findall(text):
        module = Path(file.parents[len(dots) - 1] if dots else root, *package.split("."))
        named.append([module, *(module / name for name in _NAME.findall(names))])
    found = []
    for modules in named:
        for module in modules:
            if module != root and module.relative_to(root).parts[0] in PACKAGES:
                found += [path for path in (module.with_suffix(".py"), module / "__init__.py") if path.is_file()]
    return tuple(found)


def _root(file: Path) -> Path:
    """The folder in which the outermost package of a file stands."""
    folder = file.parent
    while (folder / "__init__.py").is_file():
        folder = folder.parent
    return folder


def fingerprint(files: Iterable[str | Path]) -> str:
    """Of the contents of files and of all that they import."""
    digest = hashlib.sha256()
    for file in sources(files):
        digest.update(str(file.relative_to(_root(file))).encode() + b"\0" + file.read_bytes() + b"\0")
    return digest.hexdigest()[:16]


@cache
def machine() -> str:
    """What compiled code depends on besides its sources, as the name of a folder."""
    from llvmlite import binding
    from numba.core import config

    settings: Any = config
    try:
        version = metadata.version(NAME)
    except metadata.PackageNotFoundError:
        version = "uninstalled"
    cpu = settings.CPU_NAME or binding.get_host_cpu_name()
    return f"{version}-numba{metadata.version('numba')}-{sys.implementation.cache_tag}-{cpu}"


def shared_cache() -> Path:
    """The cache beside the packages, which an administrator may set up."""
    return _root(Path(__file__)) / SHARED


@cache
def user_cache() -> tuple[Path, str]:
    """The folder of all kernels, and why it is another than expected (empty if it is not)."""
    wanted = _wanted_cache()
    if _writable(wanted):
        return wanted, ""
    import platformdirs

    # a folder in which others may plant files is no place for code
    user = str(os.getuid()) if hasattr(os, "getuid") else "user"
    spares = [Path(platformdirs.user_cache_dir(NAME, False)), Path(tempfile.gettempdir(), f"{NAME}-{user}")]
    for spare in spares:
        if _writable(spare) and _own(spare):
            return spare, f"{wanted} cannot be written"
    return Path(tempfile.mkdtemp(prefix=f"{NAME}-")), f"{wanted} cannot be written, {spares[-1]} neither"


def _wanted_cache() -> Path:
    if os.environ.get("NUMBA_CACHE_DIR"):
        return Path(os.environ["NUMBA_CACHE_DIR"]).expanduser().absolute() / NAME
    import platformdirs

    return Path(platformdirs.user_cache_dir(NAME, False))


def _writable(folder: Path) -> bool:
    try:
        folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError:
        return False
    return True


def _own(folder: Path) -> bool:
    """Whether a folder belongs to this user, who alone can write it."""
    if not hasattr(os, "getuid"):
        return True
    status = folder.lstat()
    return status.st_uid == os.getuid() and not status.st_mode & 0o022


@contextlib.contextmanager
def as_room_allows(folder: Path) -> Iterator[None]:
    """What writes into a folder, as far as its disk or a quota has room: the rest is left undone, and told."""
    try:
        yield
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            raise
        if not _full:
            logging.getLogger(NAME).warning("hoop: compiled code is not kept: %s is full.", folder)
        _full.add(folder)


def keeps() -> bool:
    """Whether all that was compiled so far found room."""
    return not _full


_full: set[Path] = set()
_homes: list[Path] = []


def home(name: str, stamp: str) -> Path:
    """The folder of the kernels ``name`` with that fingerprint, with what is known of them already."""
    cache_folder, trouble = user_cache()
    place = cache_folder / machine() / f"{name}-{stamp}"
    if not is_compiled(place):
        with as_room_allows(cache_folder):
            for other in (shared_cache(), *([_wanted_cache()] if trouble else [])):
                _copy(other / machine() / place.name, place)
        if not place.is_dir():
            with as_room_allows(cache_folder):
                place.mkdir(parents=True, exist_ok=True)  # another process may be as far
            prune(cache_folder)
    with contextlib.suppress(OSError):
        os.utime(place)
    _homes.append(place)
    return place


def is_compiled(place: Path) -> bool:
    """Whether there is compiled code in a folder."""
    return any(not file.name.startswith(PART) for file in place.glob("__pycache__/*.nbc"))


def is_cold(package: str) -> bool:
    """Whether some module of a package that has been imported waits for its kernels to be compiled."""
    return not all(is_compiled(place) for place in _homes if place.name.startswith(package))


def _copy(ready: Path, place: Path) -> None:
    """Copy the files of a folder that ``place`` does not have, each of them whole or not at all.

    With their times, by which some versions of numba know a source again.
    """
    for file in sorted(ready.rglob("*")):  # code before the index that names it
        copy = place / file.relative_to(ready)
        if file.is_file() and not file.name.startswith(PART) and not copy.exists():
            _write(copy, file.read_bytes(), file.stat().st_mtime_ns)


def _write(file: Path, content: bytes, changed: int | None = None) -> None:
    def fill(part: Path) -> None:
        part.write_bytes(content)
        if changed is not None:
            os.utime(part, ns=(changed, changed))

    file.parent.mkdir(parents=True, exist_ok=True)
    write_whole(file, fill)


def share() -> Path:
    """Copy the kernels that this process knows to the cache beside the packages, and say where that is."""
    target = shared_cache() / machine()
    for place in _homes:
        _copy(place, target / place.name)
    return target


def prune(cache_folder: Path, now: float | None = None) -> None:
    """Remove the kernels that nothing has used for ``UNUSED_DAYS``."""
    oldest = (time.time() if now is None else now) - UNUSED_DAYS * 86400
    for place in cache_folder.glob("*-numba*/*-*"):
        with contextlib.suppress(OSError):
            if place.is_dir() and place.stat().st_mtime < oldest:
                shutil.rmtree(place)
    for machine_folder in cache_folder.glob("*-numba*"):
        with contextlib.suppress(OSError):
            machine_folder.rmdir()  # unless there is something in it


def moved(function: FunctionType, place: Path, scope: dict[str, object] | None = None) -> FunctionType:
    """The same function, as if defined in a copy of its file that stands in ``place`` unless that is full."""
    original = Path(function.__code__.co_filename)
    copy = place / f"{function.__module__}.py"  # two rooms may have modules of one name
    if not copy.exists():
        with as_room_allows(user_cache()[0]):
            _write(copy, original.read_bytes())
    code = function.__code__.replace(co_filename=str(copy))
    scope = function.__globals__ if scope is None else scope
    twin = FunctionType(code, scope, function.__name__, function.__defaults__, function.__closure__)
    twin.__module__, twin.__qualname__, twin.__doc__ = function.__module__, function.__qualname__, function.__doc__
    return twin


def keep_code(compiler: Any) -> None:
    """Have numba keep what it compiles of a function beside its source, as long as that stands and there is room."""
    source = Path(compiler.py_func.__code__.co_filename)
    if not source.is_file():  # for which there was no room
        return
    with as_room_allows(user_cache()[0]), _beside_the_source():
        try:
            compiler.enable_caching()
        except RuntimeError:  # all that numba says of a folder that takes no file
            with tempfile.TemporaryFile(dir=source.parent):
                raise
        kept = compiler._cache
        save = kept.save_overload

        def saved(*code: Any) -> None:
            with as_room_allows(user_cache()[0]):
                save(*code)

        kept.save_overload = saved


@contextlib.contextmanager
def _beside_the_source() -> Iterator[None]:
    """Functions marked for compilation meanwhile are kept beside their source.

    numba prefers ``NUMBA_CACHE_DIR`` to that, and files by path and not by fingerprint there; the copies of sources
    stand in that folder already.
    """
    from numba.core import config

    settings: Any = config
    before, settings.CACHE_DIR = settings.CACHE_DIR, ""
    try:
        yield
    finally:
        settings.CACHE_DIR = before
