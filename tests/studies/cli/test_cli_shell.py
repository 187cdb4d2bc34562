"""The command line in a shell: completion, silence, folders that are taken, names in messages, other systems."""

from __future__ import annotations

import ast
import importlib
import logging
import pkgutil
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from command_line import HANGS, ROOT, SCENE, command, environment, is_one_sentence, process

from rigid import SceneError, load_scene, scene_from_dict, scene_names, scene_to_dict
from studies import StudyError
from studies.atlas.plane import plane
from studies.cli import run
from studies.cli.hop import map_of
from studies.cli.shared.options import atlas_keys, hop_keys, number_keys
from studies.hop.rolling.asked import STIFFNESS
from studies.machine.processes import Processes
from studies.running import progress

# what the standard library of Windows does not have
POSIX_MODULES = ("fcntl", "grp", "pwd", "resource", "termios", "tty", "pty", "syslog", "posix")
POSIX_NAMES = {
    "os": ("fork", "getuid", "geteuid", "getgid", "sched_getaffinity", "sysconf", "killpg", "setsid", "mkfifo"),
    "signal": ("SIGKILL", "SIGHUP", "SIGALRM", "pthread_sigmask", "alarm", "setitimer"),
}


def completed(*words: str) -> list[str]:
    """What bash is told when the last of ``words`` is begun and the key is pressed."""
    asked = {"_HOOP_COMPLETE": "bash_complete", "COMP_WORDS": " ".join(words), "COMP_CWORD": str(len(words) - 1)}
    done = subprocess.run(command(), env=environment(**asked), capture_output=True, text=True, timeout=HANGS)
    assert done.stderr == ""
    return [line.partition(",")[2] for line in done.stdout.splitlines()]


@pytest.mark.slow
def test_a_shell_completes_commands_scenes_and_keys():
    assert set(completed("hoop", "st")) == {"study", "stress"}
    assert set(completed("hoop", "study", "")) >= {"stiffness", "limit", "hop", "sweep"}
    for line in (("rigid",), ("flexible",), ("view",), ("scenes",), ("study", "stiffness"), ("study", "limit")):
        assert completed("hoop", *line, "paper-3.3") == [n for n in scene_names() if n.startswith("paper-3.3")]
    assert completed("hoop", "study", "hop", "--over", "ring.ben") == ["ring.bending_stiffness="]
    assert completed("hoop", "study", "hop", "--over", "release.") == ["release.phi0_deg="]
    assert "landing.restitution=" in completed("hoop", "study", "atlas", "--over", "")
    assert completed("hoop", "flexible", "--only", "von_mises,dis") == ["von_mises,displacement"]
    offered = completed("hoop", "view", "x", "--field", "")
    assert "hoop_stress" in offered
    assert "stress" not in offered  # which is a tensor
    assert "--quiet" in completed("hoop", "study", "limit", "--q")


def test_files_are_completed_where_no_scene_begins_so(tmp_path):
    asked = {"_HOOP_COMPLETE": "bash_complete", "COMP_WORDS": "hoop rigid ./x", "COMP_CWORD": "2"}
    done = subprocess.run(command(), env=environment(**asked), capture_output=True, text=True, cwd=tmp_path)
    assert done.stdout == "file,./x\n"


def test_keys_that_are_completed_can_be_set():
    scene = load_scene("paper-3.1")
    for key in number_keys():
        part, _, name = key.partition(".")
        assert hasattr(getattr(scene, part), name.removesuffix("_deg"))
    file = scene_to_dict(scene)
    assert {"release.phi0_deg", "ring.weld_half_angle_deg"} <= set(number_keys())
    assert not {"release.phi0", "ring.weld_half_angle"} & set(number_keys()), "of a file, which is in degrees"
    for key in number_keys():
        part, _, name = key.partition(".")
        if name in file[part]:
            assert scene_from_dict({**file, part: {**file[part], name: file[part][name]}}) == scene


def test_keys_that_are_completed_are_taken():
    """By the command that they are completed for, with values that the scene may have."""
    scene = load_scene("paper-3.3-heavier").replace(
        hoop={"r": 1.0, "R": 0.4, "m": 0.3, "g": 9.81}, ring={"thickness": 0.02, "weld_half_angle_deg": 2.0}
    )
    others = {"release.phi0_deg": "20,30", "ring.weld_half_angle_deg": "2,3", "hoop.r": "1,1", "friction.mu": "0.1,0.2"}
    others["contact.stiffness"] = "35,40"  # on which a hoop can stand
    for key in hop_keys():
        asked = map_of(scene, (f"{key}={others.get(key, '0.35,0.4')}",))
        assert key == STIFFNESS or asked.second == key
    for key in set(number_keys()) - set(hop_keys()):
        with pytest.raises((SceneError, StudyError)):
            map_of(scene, (f"{key}=0.1,0.2",))
    with pytest.raises(SceneError, match="is not a key that an atlas can vary") as refused:
        plane(scene, {"hoop.R": (0.1, 0.2), "hoop.k": (0.1, 0.2)})
    assert all(key in str(refused.value) for key in atlas_keys())


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_the_shell_takes_the_script(hoop, shell):
    status, out, err = hoop("completion", shell)
    assert (status, err) == (0, "")
    assert "_HOOP_COMPLETE" in out
    if program := shutil.which(shell):
        assert subprocess.run([program, "-n"], input=out, text=True, capture_output=True).returncode == 0


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (("view",), {"--time": "seconds", "--start": "seconds", "--stop": "default", "--frames": "60 by default"}),
        (("view",), {"--field": "von_mises by default", "--factor": "by default", "--zoom": "default"}),
        (("flexible",), {"--times": "seconds"}),
        (("stress",), {"--seed": "0 by default", "--soft": "0 by default", "--scenes": "3000 by default"}),
        (("study", "stiffness"), {"--low": "eps_n R^2/(m g)", "--high": "by default"}),
        (("study", "hop"), {"--turns": "by default"}),
    ],
)
def test_help_has_units_and_defaults(hoop, line, said):
    status, out, _ = hoop(*line, "-h")
    assert status == 0
    options = [" ".join(entry.split()) for entry in re.split(r"\n  (?=-)", out)]
    for option, words in said.items():
        assert any(entry.startswith(f"{option} ") and words in entry for entry in options), option


def test_quiet_is_silence_on_stderr(hoop, tmp_path):
    (tmp_path / "two.toml").write_text(SCENE.format(k="[0.1, 0.2]") + '[sweep]\nsolvers = ["rigid"]\n')
    line = ("study", "sweep", tmp_path / "two.toml", "--workers", 1)
    status, loud, err = hoop(*line, "--out", tmp_path / "a")
    assert (status, "2 cases" in err) == (0, True)
    status, quiet, err = hoop(*line, "--out", tmp_path / "b", "--quiet")
    assert (status, err) == (0, "")
    assert quiet.replace(str(tmp_path / "b"), str(tmp_path / "a")) == loud
    # only as long as the command: what comes next is told again
    assert hoop(*line, "--out", tmp_path / "c")[2] != ""


def test_quiet_holds_back_what_is_said_of_compiling(caplog):
    with progress.quietly():
        logging.getLogger("hoop-pulse").warning("compiling")
    assert not caplog.records
    logging.getLogger("hoop-pulse").warning("compiling")
    assert len(caplog.records) == 1


def test_workers_are_as_quiet_as_who_has_them():
    """They compile too."""
    level = logging.getLogger("hoop-pulse").getEffectiveLevel
    with progress.quietly():
        workers = Processes(1)
        try:
            assert workers.submit(level).result() == level() == logging.ERROR
        finally:
            workers.stop()


def test_what_went_wrong_is_said_however_quiet(hoop):
    status, out, err = hoop("rigid", "no-such-scene", "--quiet")
    assert (status, out) == (2, "")
    assert is_one_sentence(err)


@pytest.mark.slow
def test_a_folder_of_another_command_is_taken(hoop, tmp_path):
    out = tmp_path / "results"
    assert hoop("rigid", "paper-3.1", "--out", out)[0] == 0
    before = {path.name: path.read_bytes() for path in out.iterdir()}
    status, _, err = hoop("paper", "--out", out)
    assert status == 2
    assert is_one_sentence(err)
    assert "hoop rigid paper-3.1" in err
    assert "--overwrite" in err
    assert before == {path.name: path.read_bytes() for path in out.iterdir()}
    # the same command may, another scene included; and so may any that is told to
    assert hoop("rigid", "paper-3.4-rough", "--out", out)[0] == 0
    assert hoop("paper", "--out", out, "--overwrite", "--format", "svg")[0] == 0
    assert (out / "command.txt").read_text().startswith("hoop paper")
    assert hoop("rigid", "paper-3.1", "--out", out)[0] == 2


@pytest.mark.parametrize("line", [("mesh", "paper-3.1", "{}/ring.msh"), ("view", "paper-3.1", "--png", "{}/a.png"),
                                  ("view", "paper-3.1", "--gif", "{}/a.gif", "--frames", "2")])  # fmt: skip
def test_no_message_names_a_temporary_file(tmp_path, capfd, line):
    """The folder is not there; what is named is the file that was asked for."""
    pytest.importorskip("pyvista")
    asked = [word.format(tmp_path / "nowhere") for word in line]
    assert run(asked) == 2
    err = capfd.readouterr().err  # what libraries say to the system's own stderr too
    assert is_one_sentence(err)
    named = next(word for word in asked if "nowhere" in word)
    assert named in err
    assert not re.search(r"\.\d+-|\.part", err.replace(str(tmp_path), ""))


@pytest.mark.parametrize("broken", [OSError("cannot write {}"), OSError(28, "No space left on device", "{}")])
def test_a_writer_that_fails_half_way_is_told_by_the_name_asked_for(tmp_path, broken):
    from rigid.output.whole import write_whole
    from studies import StudyError
    from studies.running.files import write_whole as write_result

    def fails(part: Path) -> None:
        part.write_text("half")
        told = [word.format(part) if isinstance(word, str) else word for word in broken.args]
        raise OSError(*told, *([str(part)] if broken.filename else []))

    for write, kind in ((write_whole, OSError), (write_result, StudyError)):
        with pytest.raises(kind) as caught:
            write(tmp_path / "asked.gif", fails)
        said = str(caught.value).replace(str(tmp_path / "asked.gif"), "asked.gif")
        assert "asked.gif" in said
        assert str(tmp_path) not in said
        assert list(tmp_path.iterdir()) == []


def test_the_module_is_the_command():
    done = subprocess.run([sys.executable, "-m", "studies.cli", "scenes"], env=environment(), capture_output=True,
                          text=True, timeout=HANGS)  # fmt: skip
    assert (done.returncode, done.stderr) == (0, "")
    assert "paper-3.1" in done.stdout


def modules() -> list[str]:
    names = []
    for package in ("rigid", "meshes", "flexible", "studies"):
        found = importlib.import_module(package)
        names += [package, *(info.name for info in pkgutil.walk_packages(found.__path__, f"{package}."))]
    return names


def test_nothing_is_imported_at_the_top_that_windows_has_not():
    """Where a POSIX module is used it is asked for in the function, which has an answer without it."""
    for package in ("rigid", "meshes", "flexible", "studies"):
        for path in (ROOT / package).rglob("*.py"):
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.Import | ast.ImportFrom):
                    names = [a.name for a in node.names] if isinstance(node, ast.Import) else [node.module or ""]
                    assert not {name.partition(".")[0] for name in names} & set(POSIX_MODULES), path


STUB = f"""
import multiprocessing, subprocess, sys, os, signal, shutil, tempfile, concurrent.futures, platform, sqlite3
for name in ("numba", "pandas", "platformdirs", "rich.console", "matplotlib.figure", "meshio", "skfem", "pyvista"):
    try:
        __import__(name)  # what others do is their own business
    except ImportError:
        pass
for name in {POSIX_MODULES}:
    sys.modules[name] = None
for module, names in {POSIX_NAMES}.items():
    for name in names:
        if hasattr(sys.modules[module], name):
            delattr(sys.modules[module], name)
"""


def without_posix(program: str, *arguments: object) -> subprocess.CompletedProcess[str]:
    """A program where the modules and functions of POSIX are hidden."""
    line = [sys.executable, "-c", STUB + program, *map(str, arguments)]
    return subprocess.run(line, env=environment(), capture_output=True, text=True, timeout=HANGS)


@pytest.mark.slow
def test_every_module_imports_without_posix():
    ours = [name for name in modules() if ".peers." not in name and not name.endswith(".__main__")]
    done = without_posix(f"import importlib\nfor name in {ours}: importlib.import_module(name)")
    assert done.returncode == 0, done.stderr[-2000:]


@pytest.mark.slow
def test_motions_run_and_are_written_without_posix(tmp_path):
    program = "from studies.cli import run; sys.exit(run(sys.argv[1:]))"
    for words in (("rigid", "paper-3.1"), ("flexible", "paper-3.3-massless", "--json")):
        out = tmp_path / words[0]
        done = without_posix(program, *words, "--out", out, "--quiet")
        assert (done.returncode, done.stderr) == (0, "")
        assert (out / "motion.npz").is_file()


@pytest.mark.slow
def test_what_has_no_answer_without_posix_says_so():
    program = """
from studies.bench.race import Contestant, peak_memory
from rigid.batch.cores import cores
from rigid.kernel.store import user_cache
memory = peak_memory(Contestant("", "", "", lambda: None, lambda found: 0.0))
print(memory != memory, cores() >= 1, user_cache()[0] is not None)
"""
    done = without_posix(program)
    assert done.stdout == "True True True\n", done.stderr


def test_without_a_compiler_rigid_motions_are_the_same_and_flexible_ones_say_what_forbids_them():
    forbidden = environment(NUMBA_DISABLE_JIT="1")
    rigid = process("rigid", "paper-3.1", "--json", env=forbidden)
    assert rigid.stdout == process("rigid", "paper-3.1", "--json").stdout != ""
    flexible = process("flexible", "paper-3.1", env=forbidden)
    assert (flexible.returncode, flexible.stdout) == (2, "")
    assert "NUMBA_DISABLE_JIT" in flexible.stderr
    assert is_one_sentence(flexible.stderr)
