"""The structure of the code: imports point one way, among the packages and among the rooms of each; sizes.

A room is a folder of modules. The modules at the top of a package are a room too; the faces (``__init__``) only pass
on what their room holds.
"""

from __future__ import annotations

import ast
import importlib
import re
import subprocess
import sys
from collections.abc import Callable, Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

from rigid.elastic import LAWS

ROOT = Path(__file__).parent.parent
PACKAGES = ("rigid", "meshes", "flexible", "studies")  # an import never points to one further right
MOST = 9  # modules of a room, its face not counted


def name_of(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


SOURCES = {name_of(path): path for package in PACKAGES for path in sorted((ROOT / package).rglob("*.py"))}


def room_of(module: str) -> str:
    return module if SOURCES[module].name == "__init__.py" else module.rpartition(".")[0]


@cache
def tree_of(path: Path) -> ast.Module:
    return ast.parse(path.read_text(encoding="utf-8"))


@cache
def nodes_of(path: Path) -> list[ast.AST]:
    return list(ast.walk(tree_of(path)))


def imported(module: str) -> set[str]:
    """Modules of this project that a module imports, wherever in it."""
    path = SOURCES[module]
    package = room_of(module).split(".")
    found = set()
    for node in nodes_of(path):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            start = ".".join([*base, *([node.module] if node.module else [])])
            names = [f"{start}.{alias.name}" if f"{start}.{alias.name}" in SOURCES else start for alias in node.names]
        else:
            continue
        found.update(name for name in names if name in SOURCES)
    return found


@cache
def imports() -> dict[str, set[str]]:
    """By the first test that asks, and not whenever tests are collected."""
    return {module: imported(module) for module in SOURCES}


def test_imports_point_from_studies_to_rigid() -> None:
    upward = [
        (module, target)
        for module, targets in imports().items()
        for target in targets
        if PACKAGES.index(target.split(".")[0]) > PACKAGES.index(module.split(".")[0])
    ]
    assert not upward


@pytest.mark.parametrize("package", PACKAGES)
def test_rooms_import_one_way(package: str) -> None:
    graph: dict[str, set[str]] = {}
    for module, targets in imports().items():
        if module.split(".")[0] != package or SOURCES[module].name == "__init__.py":
            continue
        rooms = graph.setdefault(room_of(module), set())
        rooms.update(
            room_of(target) for target in targets if target.split(".")[0] == package and target not in (package, module)
        )
        rooms.discard(room_of(module))
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(f"rooms import each other: {' <- '.join(error.args[1])}")


def test_no_module_imports_itself_in_a_circle() -> None:
    deep = {module: {t for t in targets if SOURCES[t].name != "__init__.py"} for module, targets in imports().items()}
    try:
        TopologicalSorter(deep).prepare()
    except CycleError as error:
        pytest.fail(f"modules import each other: {' <- '.join(error.args[1])}")


def test_a_room_has_at_most_nine_modules() -> None:
    rooms: dict[str, list[str]] = {}
    for module, path in SOURCES.items():
        if path.name != "__init__.py":
            rooms.setdefault(room_of(module), []).append(path.stem)
    assert not {room: modules for room, modules in rooms.items() if len(modules) > MOST}


def imports_of_names(path: Path) -> list[tuple[str, str]]:
    """(module, name) of everything that a file imports from the packages by ``from ... import ...``."""
    return [
        (node.module, alias.name)
        for node in nodes_of(path)
        if isinstance(node, ast.ImportFrom) and not node.level and node.module in SOURCES
        for alias in node.names
        if f"{node.module}.{alias.name}" not in SOURCES
    ]


def test_what_a_face_has_is_taken_from_the_face() -> None:
    faces = {package: set(importlib.import_module(package).__all__) for package in PACKAGES}
    around = [
        (path.name, module, name)
        for path in [*SOURCES.values(), *(ROOT / "tests").rglob("*.py")]
        for module, name in imports_of_names(path)
        if module not in PACKAGES and name in faces[module.split(".")[0]]
    ]
    assert not around


def test_nothing_private_leaves_its_package() -> None:
    private = [
        (module, name)
        for module, path in SOURCES.items()
        for source, name in imports_of_names(path)
        if name.startswith("_") and source.split(".")[0] != module.split(".")[0]
    ]
    assert not private


@pytest.mark.parametrize("package", PACKAGES)
def test_a_face_has_what_it_lists(package: str) -> None:
    face = importlib.import_module(package)
    assert set(face.__all__) <= set(dir(face)), "dir() helps"
    assert all(hasattr(face, name) for name in face.__all__)


def test_a_face_is_light() -> None:
    """What a package loads on demand only: scipy, a compiler, tables and figures take seconds."""
    for package, heavy in (("rigid", "numba scipy"), ("studies", "numba scipy pandas matplotlib flexible")):
        line = f"import sys, {package}; assert not set(sys.modules) & set({heavy.split()}), sys.modules.keys()"
        subprocess.run([sys.executable, "-c", line], cwd=ROOT, check=True)


LONGEST_FILE, LONGEST_FUNCTION, MOST_ARGUMENTS = 300, 80, 8
"""Lines of a file, lines of a function without its docstring, arguments of a function."""


def functions(path: Path) -> Iterator[ast.FunctionDef | ast.AsyncFunctionDef]:
    for node in nodes_of(path):
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            yield node


def is_command(function: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    """Whether its arguments are the options of a command line, which click hands over one by one."""
    return any(ast.unparse(decorator).split("(")[0].endswith(".command") for decorator in function.decorator_list)


def long_files() -> set[str]:
    return {m for m, path in SOURCES.items() if len(path.read_text(encoding="utf-8").splitlines()) > LONGEST_FILE}


def long_functions() -> set[str]:
    long = set()
    for module, path in SOURCES.items():
        for function in functions(path):
            docstring = ast.get_docstring(function, clean=False) or ""
            lines = (function.end_lineno or 0) - function.lineno + 1 - len(docstring.splitlines())
            if lines > LONGEST_FUNCTION:
                long.add(f"{module}.{function.name}")
    return long


def functions_of_many_arguments() -> set[str]:
    many = set()
    for module, path in SOURCES.items():
        for function in functions(path):
            taken = function.args.posonlyargs + function.args.args + function.args.kwonlyargs
            count = len([argument for argument in taken if argument.arg not in ("self", "cls")])
            if count > MOST_ARGUMENTS and not is_command(function):
                many.add(f"{module}.{function.name}")
    return many


@pytest.mark.parametrize("larger", [long_files, long_functions, functions_of_many_arguments])
def test_nothing_is_larger_than_one_can_read(larger: Callable[[], set[str]]) -> None:
    assert not larger()


def test_what_is_public_says_what_it_is() -> None:
    """Functions, classes and their methods have a docstring, or a class of the project that they derive from has it.

    Examples are scripts, each told by its file.
    """
    said: dict[str, set[str]] = {}  # methods by class
    silent, bases = {}, {}
    for module, path in SOURCES.items():
        if module.startswith("studies.examples"):
            continue
        for owner, node in definitions(tree_of(path)):
            if isinstance(node, ast.ClassDef):
                bases[node.name] = [ast.unparse(base).split("[")[0] for base in node.bases]
            if ast.get_docstring(node):
                said.setdefault(owner, set()).add(node.name)
            elif not any(ast.unparse(decorator) == "overload" for decorator in node.decorator_list):
                silent[f"{module}.{owner}.{node.name}".replace("..", ".")] = owner, node.name

    def inherited(owner: str, name: str) -> bool:
        return any(name in said.get(base, ()) or inherited(base, name) for base in bases.get(owner, ()))

    left = {place for place, (owner, name) in silent.items() if not (owner and inherited(owner, name))}
    assert left <= TERSE


TERSE = {"studies.cli.hoop.hoop"}  # what it does is told to click as an argument


Defined = ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef


def definitions(tree: ast.Module | ast.ClassDef, owner: str = "") -> Iterator[tuple[str, Defined]]:
    """Public functions, classes and methods of a module, each with its class."""
    for node in tree.body:
        if isinstance(node, Defined) and not node.name.startswith("_"):
            yield owner, node
            if isinstance(node, ast.ClassDef):
                yield from definitions(node, node.name)


def test_a_friction_law_is_known_by_its_own_file_alone() -> None:
    """The rest of the program asks :class:`flexible.contact.laws.law.Law`, and gets laws from where they are listed."""
    laws = "flexible.contact.laws"
    own = {f"{laws}.{name}" for name in LAWS}
    known = {module: targets & own for module, targets in imports().items() if module != f"{laws}.listing"}
    assert own <= set(SOURCES)
    assert not {module: targets for module, targets in known.items() if targets}
    allowed = own | {"rigid.elastic"}
    said = {module for module, path in SOURCES.items() if names_a_law(path)} - allowed
    # scenes of a benchmark and of an example, what the README says of one, and what theory does
    assert said == {
        "studies.bench.truth.reference",
        "studies.examples.own_friction_law",
        "studies.readme.stated",
        "studies.validate.contact",
    }


def names_a_law(path: Path) -> bool:
    """Whether a text in it, its docstrings aside, is the name of a law or has one in quotes."""
    quoted = re.compile(rf"([\"'])({'|'.join(LAWS)})\1")
    nodes = nodes_of(path)
    docstrings = {node.value for node in nodes if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)}
    texts = [node.value for node in nodes if isinstance(node, ast.Constant) and node not in docstrings]
    return any(isinstance(text, str) and (text in LAWS or quoted.search(text)) for text in texts)


def test_tests_lie_where_the_packages_have_their_rooms() -> None:
    folders = {path.parent.relative_to(ROOT / "tests") for path in (ROOT / "tests").rglob("test_*.py")}
    assert {folder for folder in folders if not (ROOT / folder).is_dir()} == set()
    assert {Path(package) for package in PACKAGES} <= folders


NAMED = re.compile(r"`([\w/]+\.py)` ((?:`_?[A-Za-z]\w+`[,; ]*)+)")  # `room/file.py` `ONE`, `two`


@pytest.mark.parametrize(
    "page", [ROOT / "flexible/README.md", ROOT / "flexible/chain/README.md"], ids=lambda page: page.parent.name
)
def test_numbers_that_a_page_names_are_there(page: Path) -> None:
    """Files by their path from the page's folder, its package or the root."""
    folders = {page.parent, ROOT / page.relative_to(ROOT).parts[0], ROOT}
    named = NAMED.findall(page.read_text(encoding="utf-8"))
    assert len(named) > 20
    for file, numbers in named:
        sources = [folder / file for folder in folders if (folder / file).is_file()]
        assert len(sources) == 1, file
        source = sources[0].read_text(encoding="utf-8")
        missing = [
            number
            for number in re.findall(r"\w+", numbers)
            if not re.search(rf"^ *(def |self\.|(\w+, )*){number}\b", source, re.M)
        ]
        assert not missing, file


#: by why they are none; file and name of each, with a star all of a file
NO_THRESHOLDS = {
    "codes, sizes and places in arrays": """
        contact/assembly.py:X contact/assembly.py:Y contact/laws/brush.py:CODE contact/laws/patch.py:CODE
        contact/laws/patch.py:SLIDE_LEFT contact/laws/patch.py:SLIDE_RIGHT contact/laws/patch.py:STICK
        contact/laws/regularised.py:CODE contact/newton.py:FRAME contact/room.py:*
        chain/bordered.py:WIDTH chain/rod/surface.py:ONWARD chain/rod/surface.py:OUTWARD chain/rod/surface.py:SLOPE
        chain/rod/surface.py:STRETCH models/stage.py:FORESEEN models/stage.py:HELD models/stage.py:LET_GO
        models/stage.py:RAISED output/patch.py:FREE output/patch.py:SLIPS output/patch.py:STICKS run/pulses.py:BACKWARD
        run/pulses.py:FORWARD time/advance.py:COLUMNS time/course.py:CAPPED time/course.py:LACKS
        time/course.py:MODE_ENDED time/course.py:NO_FORCES time/course.py:PAUSED time/course.py:REACHED
        time/course.py:STALLED time/course.py:UNSOLVED time/events.py:HIGH_END time/events.py:LOW_END
        time/events.py:MODE_ENDS time/events.py:NO_EVENT time/events.py:TURN
    """,
    "round-off, and steps of differences that lose next to nothing beside it": """
        airborne.py:LOWEST airborne.py:ON chain/bordered.py:FADED chain/corner.py:_SMALL chain/rod/orders.py:_SMALL
        contact/points/data.py:EXACTLY contact/points/detection.py:TURNED_ON contact/points/entry.py:ENTERS
        output/chain_interior.py:_SMALL run/pulses.py:AT_REST segment.py:NO_TIME time/advance.py:SHORTEST
        time/control.py:SHORT time/course.py:PAST time/events.py:ANGLE time/events.py:RATE time/events.py:SHARE
        time/events.py:TIME time/events.py:VELOCITY time/stages.py:INSTANT
    """,
    "how long is tried, and how much at once": """
        contact/guess.py:GUESSES contact/guess.py:SEARCHES contact/points/data.py:MOST_ITERATIONS
        contact/points/entry.py:MOST_STEPS models/full.py:_WINDOWS models/stage.py:MOST_POINTS
        output/fields.py:_TOGETHER ring/fem.py:COLUMNS ring/fem.py:LOT time/advance.py:SPAN time/events.py:OTHERS
    """,
    "what is shown of a motion": "output/curves.py:BETWEEN output/instants.py:_AROUND",
}


def numbers_of(path: Path) -> set[str]:
    """Names, all in capitals, of the numbers of a module, and of its rows of numbers."""
    found = set()
    for node in tree_of(path).body:
        targets = (
            node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        )
        names = {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
        found |= {name for name in names if name.isupper()}
    module = importlib.import_module(".".join(path.relative_to(ROOT).with_suffix("").parts))
    rows = {name: value if type(value) is tuple else (value,) for name in found for value in [getattr(module, name)]}
    return {name for name, row in rows.items() if row and all(type(number) in (int, float) for number in row)}


def test_every_number_stands_on_a_page() -> None:
    """Of the flexible hoop: on one of the pages of thresholds, or for a reason among those that are none."""
    package = ROOT / "flexible"
    pages = [(package / folder / "README.md").read_text(encoding="utf-8") for folder in (".", "chain")]
    told = {
        f"{file}:{name}" for page in pages for file, names in NAMED.findall(page) for name in re.findall(r"\w+", names)
    }
    none = [number for numbers in NO_THRESHOLDS.values() for number in numbers.split()]
    paths = {path.relative_to(package).as_posix(): path for path in SOURCES.values() if package in path.parents}
    there = {f"{file}:{name}" for file, path in paths.items() for name in numbers_of(path)}
    listed = {number for number in there for one in none if number == one or one == f"{number.split(':')[0]}:*"}
    assert sorted(there - told - listed) == []
    assert not listed & told, "which is it?"
    assert all(one.endswith(":*") or one in there for one in none), "names that are no more"
