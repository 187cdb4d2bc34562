"""Bad input of any kind: exit status 2 and one sentence, never a traceback, never a hang."""

from __future__ import annotations

import contextlib
import io
import json
import string

import pytest
from command_line import is_one_sentence
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from studies.cli import hoop as cli

KEYS = {
    "hoop": ["k", "r", "mass_ratio", "R", "m", "g", "point_mass"],
    "friction": ["mu_s", "mu"],
    "release": ["phi0_deg", "omega0", "slip0"],
    "run": ["turns", "t_end", "until"],
    "landing": ["restitution"],
    "ring": ["bending_stiffness", "poisson", "thickness", "weld_half_angle_deg"],
    "contact": ["law", "stiffness", "tangential_ratio", "damping"],
    "solve": ["level", "resolve", "start", "rtol", "elements"],
}
GOOD = {
    "hoop": {"k": "0.1"},
    "friction": {"mu_s": "0.35", "mu": "0.3"},
    "release": {"phi0_deg": "10"},
}
HUGE = "1" + "0" * 400
WORDS = [
    "nan",
    "-inf",
    "inf",
    HUGE,
    "-1",
    "1e300",
    "1.7976931348623157e308",
    "-1e300",
    '"a"',
    "[1, 2]",
    "{a = 1}",
    "true",
    "1979-05-27",
    '""',
    "0",
]

values = st.one_of(
    st.sampled_from(WORDS),
    st.floats().map(str),
    st.integers(-(10**30), 10**30).map(str),
    st.text(string.printable, max_size=8),
)


def _known(text: str) -> str:
    """What was printed, without the numbers that do not exist: a pulse in which the run begins or ends has no
    restitution, one that jams no largest force."""
    if not text.startswith("{"):
        return text
    said = json.loads(text)
    jams = [phase["t_start"] for phase in said["phases"] if phase["kind"] == "impact"]
    for pulse in said["pulses"]:
        if pulse["cut"]:
            for name in ("newton_restitution", "poisson_restitution", "energetic_restitution"):
                del pulse[name]
        if any(pulse["t_start"] <= t <= pulse["t_end"] for t in jams):
            del pulse["peak_normal_force"]
    return json.dumps(said)


def _run(*arguments: str) -> tuple[int, str]:
    """Exit status and stderr of a command line, within this process; no other number on stdout may be missing."""
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stderr(err), contextlib.redirect_stdout(out):
        status = cli.run(list(arguments))
    assert "null" not in _known(out.getvalue())
    return status, err.getvalue()


def _is_fine_or_one_sentence(status: int, err: str) -> None:
    """1 where a motion needs too much work: a disk of k < 1e-13 is through the bottom in no time at all."""
    assert status in (0, 2) or (status == 1 and "the work bound is reached" in err)
    if status:
        assert is_one_sentence(err), err


def _write(folder, tables) -> str:
    lines = []
    for part, table in tables.items():
        lines.append(f"[{part}]")
        lines += [f"{key} = {value}" for key, value in table.items()]
    path = folder / "scene.toml"
    path.write_text("\n".join(lines), encoding="utf-8", errors="surrogatepass")
    return str(path)


@settings(max_examples=250, deadline=20_000, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(data=st.data())
def test_any_value_of_any_key(tmp_path, data):
    """One key of a good scene takes a value that makes no sense, or one at the end of what floats hold."""
    part = data.draw(st.sampled_from(sorted(KEYS)))
    key = data.draw(st.sampled_from(KEYS[part]))
    tables = {name: dict(table) for name, table in GOOD.items()}
    tables.setdefault(part, {})[key] = data.draw(values)
    _is_fine_or_one_sentence(*_run("rigid", _write(tmp_path, tables), "--json"))


@pytest.mark.parametrize("part", KEYS)
def test_the_ends_of_every_key(tmp_path, part):
    """Every key at the ends of what numbers hold, and as things that are no numbers."""
    for key in KEYS[part]:
        for word in WORDS:
            tables = {name: dict(table) for name, table in GOOD.items()}
            tables.setdefault(part, {})[key] = word
            path = _write(tmp_path, tables)
            try:
                _is_fine_or_one_sentence(*_run("rigid", path, "--json"))
            except Exception as error:
                raise AssertionError(f"{part}.{key} = {word[:30]}: {error}") from error


@settings(max_examples=150, deadline=20_000, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    content=st.one_of(st.binary(max_size=60), st.text(max_size=60).map(lambda text: text.encode("utf-8", "replace")))
)
@example(content=b"\xff\xfe\x00")
@example(content=b"[hoop]\n" * 3)
@example(content=b"a=" + b"[" * 5000)
@example(content=b"")
def test_any_bytes_as_a_scene(tmp_path, content):
    path = tmp_path / "scene.toml"
    path.write_bytes(content)
    status, err = _run("rigid", str(path))
    assert status == 2
    assert is_one_sentence(err)


COMMANDS = "rigid flexible scenes study stiffness sweep view bench stress paper-3.1 nothing / /dev/null/x nan 0 -1"
OPTIONS = "--json --out --quick --check --seed --scenes --frames --times --only --fields --low --count --nothing"
WORD = st.one_of(
    st.sampled_from([*COMMANDS.split(), *OPTIONS.split(), ""]),
    st.text(string.printable, max_size=6),
)


@settings(max_examples=200, deadline=20_000)
@given(words=st.lists(WORD, min_size=1, max_size=5))
def test_any_words_on_the_command_line(words):
    """Parsed only: what parses is not run, what does not is one sentence and status 2."""
    runnable = {"flexible", "study", "view", "bench", "stress", "paper"}
    if words[0] in runnable:
        words = [*words, "--no-such-option"]
    status, err = _run(*words)
    _is_fine_or_one_sentence(status, err)


@pytest.mark.parametrize(
    "line",
    [
        "bench",
        "bench nothing",
        "bench rigid x",
        "bench rigid --quick --out /dev/null/x",
        "stress --seed -1",
        "stress --scenes 0",
        "stress --scenes x",
        "stress --out /dev/null/x",
    ],
)
def test_bench_and_stress_say_what_is_wrong(line):
    status, err = _run(*line.split())
    assert status == 2
    assert is_one_sentence(err)
