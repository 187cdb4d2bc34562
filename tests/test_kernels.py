"""Compiled kernels: kept outside the package, never stale, compiled once, and told."""

from __future__ import annotations

import ast
import errno
import gc
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import pytest

import flexible
import rigid
from rigid.kernel import announce, store
from rigid.kernel.compile import Patience
from rigid.kernel.insides.parts import as_part
from rigid.output.whole import PART

ROOT = Path(__file__).parent.parent
CALLEE = "flexible/contact/points/normal.py"

# A kernel of flexible.contact.assembly and the one that it calls in flexible.contact.points.normal: one point on the
# floor whose own gap alone moves its force, so that the result is -(way - slip)/elastic times the diagonal, -1.5.
KERNEL = """
from rigid.kernel.compile import jit

from .points.normal import sum_by_gaps


@jit
def by_gap(factors, foundation, to):
    sum_by_gaps(factors, foundation, to)
    return to[0]
"""
PROGRAM = """
import numpy as np
from flexible.contact.kernel import by_gap
from flexible.contact.points.normal import Foundation
from rigid.kernel.announce import compile_seconds
foundation = Foundation(np.ones(1), np.full(1, 3.0), np.zeros(1), 0.0, 1.0)
print(by_gap(np.full(1, 0.5), foundation, np.zeros(1)), compile_seconds() > 0)
"""


OF_WHAT = """
from numba.core.codegen import JITCodeLibrary
made, finish = [], JITCodeLibrary._finalize_specific
JITCodeLibrary._finalize_specific = lambda library: (made.append(library.name), finish(library))
"""
FULL = """
import errno, os
replace = os.replace
def full(source, target):
    if str(target).endswith({!r}):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    replace(source, target)
os.replace = full
"""
TOLD = """
import sys
print("made:", *made, file=sys.stderr)
"""


def copy_of_the_packages(folder: Path) -> Path:
    """The two solvers, as if installed into ``folder``, with a small kernel; without the face of ``flexible``."""
    for package in ("rigid", "flexible"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "flexible" / "__init__.py").write_text("")
    (folder / "flexible" / "contact" / "__init__.py").write_text("")
    (folder / "flexible" / "contact" / "kernel.py").write_text(KERNEL)
    return folder


def run(installation: Path, cache: Path, program: str = PROGRAM, **environment: str) -> tuple[float, bool, str]:
    """The kernel's result, whether something was compiled for it, and what stderr says; from another folder."""
    variables = {"PYTHONPATH": str(installation), "NUMBA_CACHE_DIR": str(cache), **environment}
    done = subprocess.run(
        [sys.executable, "-c", program],
        cwd=installation.parent,
        env={**os.environ, **variables},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    number, compiled = done.stdout.split()
    return float(number), compiled == "True", done.stderr


def files(folder: Path) -> set[Path]:
    return {path.relative_to(folder) for path in folder.rglob("*") if path.is_file()}


class Warm(NamedTuple):
    """An installation that has run once, and what was seen."""

    installation: Path
    cache: Path
    compiled: bool
    said: str
    made: list[str]
    before: set[Path]


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    folder = tmp_path_factory.mktemp("warm")
    installation, cache = copy_of_the_packages(folder / "installation"), folder / "cache"
    before = files(installation)
    number, compiled, told = run(installation, cache, OF_WHAT + PROGRAM + TOLD, PYTHONDONTWRITEBYTECODE="1")
    assert number == -1.5
    said, _, made = told.partition("made:")
    return Warm(installation, cache, compiled, said, made.split(), before)


def test_compiled_is_told_once_and_kept_outside_the_package(warm):
    assert warm.compiled
    assert warm.said.count("\n") == 1
    assert warm.said.startswith("hoop: compiling a part of the flexible solver")
    assert files(warm.installation) == warm.before


def test_a_changed_callee_is_never_served_from_the_cache(tmp_path, warm):
    """Nor are the same sources compiled again, wherever they stand."""
    installation, cache = copy_of_the_packages(tmp_path / "copy"), tmp_path / "cache"
    shutil.copytree(warm.cache, cache)
    assert run(installation, cache) == (-1.5, False, "")
    text = (installation / CALLEE).read_text(encoding="utf-8")
    edited = text.replace("-factors[i] * diagonal[i]", "-2 * factors[i] * diagonal[i]")
    assert edited != text
    (installation / CALLEE).write_text(edited, encoding="utf-8")
    assert run(installation, cache)[:2] == (-3.0, True)


@pytest.mark.skipif("pipeline_class" not in as_part(), reason="a numba whose insides are not known")
def test_machine_code_is_made_of_what_python_calls(warm):
    """And of no part of that by itself, which has it made again in each function that calls it."""
    assert "by_gap" in warm.made
    assert "sum_by_gaps" not in warm.made


@pytest.mark.slow
def test_a_numba_whose_insides_are_not_known_compiles_in_its_own_way(tmp_path):
    installation = copy_of_the_packages(tmp_path / "installation")
    newer = "import rigid.kernel.insides.parts as parts\nparts._NEXT = parts._OLDEST\n"
    assert run(installation, tmp_path / "cache", newer + PROGRAM)[:2] == (-1.5, True)
    linked = "from flexible.contact.forces import contact_forces as f\nf.load()\nassert not f.overloads\n"
    assert run(installation, tmp_path / "cache", newer + linked + PROGRAM)[0] == -1.5


def test_copied_kernels_keep_their_times(tmp_path):
    """By which, and by its size, numba 0.61 knows the source of what it has compiled again."""
    source = tmp_path / "shared" / "kernel.py"
    source.parent.mkdir()
    source.write_text("pass")
    os.utime(source, ns=(10**18, 10**18 + 10**6))
    store._copy(source.parent, tmp_path / "own")
    copy = tmp_path / "own" / "kernel.py"
    assert (copy.read_text(), copy.stat().st_mtime_ns) == ("pass", 10**18 + 10**6)


def test_kernels_beside_a_shared_installation_are_used(tmp_path, warm):
    """By a user whose own cache cannot be written either: a file stands where the folder should be."""
    installation = copy_of_the_packages(tmp_path / "shared")
    shutil.copytree(warm.cache / store.NAME, installation / store.SHARED)
    (tmp_path / "file").write_text("")
    home = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "LOCALAPPDATA", "USERPROFILE"), str(tmp_path / "home"))
    assert run(installation, tmp_path / "file" / "cache", **home) == (-1.5, False, "")
    assert (tmp_path / "file").read_text() == ""


def test_another_folder_than_expected_is_told(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file" / "cache"))
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("HOME", str(tmp_path))
    folder, trouble = store.user_cache.__wrapped__()
    assert not folder.is_relative_to(tmp_path / "file")
    assert "cannot be written" in trouble


@pytest.mark.parametrize("ends", ["", ".nbc"])
def test_on_a_full_disk_nothing_is_kept_which_is_told_once(tmp_path, ends):
    """No file finds room, not even the sources, or none as large as code."""
    installation, cache = copy_of_the_packages(tmp_path / "installation"), tmp_path / "cache"
    result, compiled, told = run(installation, cache, FULL.format(ends) + PROGRAM)
    assert (result, compiled) == (-1.5, True)
    assert told.count(f"hoop: compiled code is not kept: {cache / store.NAME} is full.") == 1
    assert told.count("\n") == 2
    assert not [file for file in files(cache) if file.suffix == ".nbc" or file.name.startswith(PART)]


def test_what_else_goes_wrong_with_a_file_is_not_passed_over(monkeypatch, tmp_path):
    monkeypatch.setattr(store, "_full", set())
    with pytest.raises(PermissionError), store.as_room_allows(tmp_path):
        raise PermissionError(errno.EACCES, "denied")
    assert store.keeps()


def test_two_processes_may_begin_at_once(tmp_path, monkeypatch):
    """The other makes the folder after this one has seen that there is none."""
    monkeypatch.setattr(store, "user_cache", lambda: (tmp_path, ""))
    monkeypatch.setattr(store, "_homes", [])
    place = tmp_path / store.machine() / "kernels-0123"
    place.mkdir(parents=True)
    is_dir, too_early = Path.is_dir, [False]

    def seen(path, **options):
        return too_early.pop() if path == place and too_early else is_dir(path, **options)

    monkeypatch.setattr(Path, "is_dir", seen)
    assert store.home("kernels", "0123") == place
    assert not too_early


def test_imports_are_read_as_python_reads_them():
    """None of any file's imports is missed, whatever their layout (an example in a docstring may be one too many)."""
    for package in store.PACKAGES:
        for file in (ROOT / package).rglob("*.py"):
            wanted: set[Path] = set()
            for node in ast.walk(ast.parse(file.read_bytes())):
                if isinstance(node, ast.Import):
                    modules = [ROOT.joinpath(*alias.name.split(".")) for alias in node.names]
                elif isinstance(node, ast.ImportFrom):
                    base = file.parents[node.level - 1] if node.level else ROOT
                    module = base.joinpath(*(node.module or "").split("."))
                    modules = [module, *(module / alias.name for alias in node.names)]
                else:
                    continue
                ours = [module for module in modules if module != ROOT]
                ours = [module for module in ours if module.relative_to(ROOT).parts[0] in store.PACKAGES]
                wanted.update(p for m in ours for p in (m.with_suffix(".py"), m / "__init__.py") if p.is_file())
            assert wanted <= set(store._imports(file)), file


def test_the_fingerprint_covers_every_source_and_nothing_else(tmp_path):
    stage = ROOT / "flexible" / "models" / "stage.py"
    covered = store.sources([stage])
    assert ROOT / CALLEE in covered
    assert ROOT / "flexible" / "run" / "solve.py" not in covered
    assert all(path.is_relative_to(ROOT) for path in covered)
    # constants enter a kernel too
    assert ROOT / "rigid" / "kernel" / "layout.py" in store.sources([ROOT / "rigid" / "phases" / "choice.py"])
    installation = copy_of_the_packages(tmp_path)
    moved = [installation / "flexible" / "models" / "stage.py"]
    assert store.fingerprint([stage]) == store.fingerprint(moved)


def test_every_kernel_stands_outside_the_packages():
    packages = [Path(package.__file__).parent for package in (rigid, flexible)]
    for module in [module for name, module in sys.modules.items() if name.startswith("flexible.")]:
        for value in vars(module).values():
            if hasattr(value, "py_func"):
                source = Path(value.py_func.__code__.co_filename)
                assert not any(source.is_relative_to(package) for package in packages)


def test_folders_are_named_by_all_that_compiled_code_depends_on():
    import numba

    name = store.machine()
    assert f"numba{numba.__version__}" in name
    assert sys.implementation.cache_tag in name
    assert re.fullmatch(r"[\w.+-]+", name)


def test_unused_kernels_are_removed_and_others_kept(tmp_path):
    day = 86400.0
    now = 1000 * day
    for name, age in (("old", 61), ("new", 59)):
        place = tmp_path / f"{name}-numba0-cp-cpu" / "flexible.contact.forces-0123"
        (place / "__pycache__").mkdir(parents=True)
        os.utime(place, (now - age * day, now - age * day))
    (tmp_path / "something else").mkdir()
    store.prune(tmp_path, now)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["new-numba0-cp-cpu", "something else"]


@pytest.mark.parametrize("variable", ["", "~/kernels"])
def test_the_environment_says_where(monkeypatch, tmp_path, variable):
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    monkeypatch.setenv("NUMBA_CACHE_DIR", variable)
    if variable:
        assert store._wanted_cache() == tmp_path / "kernels" / store.NAME
    else:
        assert store.NAME in store._wanted_cache().parts


def test_seconds_of_compiling_are_no_run_time(monkeypatch, caplog):
    """Two kernels of five seconds, each with a part of its own, told once; what others compile is not ours to tell."""
    now = [0.0]
    monkeypatch.setattr(announce.time, "perf_counter", lambda: now[0])
    monkeypatch.setattr(announce, "_told", set())
    before, clock = announce.compile_seconds(), announce.running_clock()
    for package in ("flexible", "flexible", "someone_else"):
        announce._begin(package)
        now[0] += 2.0
        announce._begin("numba")
        now[0] += 3.0
        announce._end()
        announce._end()
    assert announce.compile_seconds() - before == 10.0
    assert announce.running_clock() - clock == 5.0
    assert [record.name for record in caplog.records] == ["hoop-pulse"]


def test_a_function_of_no_module_is_not_ours():
    """numba's users make functions with exec, which stand in no file: their compiling is theirs to tell."""
    import numba

    announce.tell()
    scope: dict = {"__name__": None}
    exec("def twice(x):\n    return 2 * x", scope)
    before = announce.compile_seconds()
    assert numba.njit(scope["twice"])(2.0) == 4.0
    assert announce.compile_seconds() == before


def test_garbage_is_looked_for_less_often_while_compiling(monkeypatch):
    """As often as before afterwards, and where nobody looks for it nobody begins to."""
    monkeypatch.setattr(announce, "_told", {"flexible"})
    threshold = gc.get_threshold()
    try:
        for often in (700, 0):
            gc.set_threshold(often, 10, 10)
            announce._begin("flexible")
            announce._begin("numba")
            announce._end()
            assert gc.get_threshold()[0] == (announce._SELDOM if often else 0)
            announce._end()
            assert gc.get_threshold() == (often, 10, 10)
    finally:
        gc.set_threshold(*threshold)


def test_a_process_goes_over_to_compiled_code_sooner_where_there_is_some(monkeypatch):
    """Both steps and instants count; what is said of a process once holds for all of it."""
    for there in (True, False):
        monkeypatch.setattr(store, "is_compiled", lambda place, there=there: there)
        patience = Patience()
        assert patience.left() > 0
        patience.spend(steps=Patience.LOAD / 2)
        patience.spend(instants=Patience.INSTANTS * Patience.LOAD // 2)
        assert (patience.left() <= 0) == there
        assert patience.left(instants=Patience.INSTANTS * Patience.COMPILE) <= 0
        patience.spend(steps=Patience.COMPILE)
        assert patience.left() <= 0
        patience.renew()
        assert patience.left() > 0
        patience.renew(0)
        assert patience.left() <= 0
