"""The README's pictures and numbers have a command each, and their comparison finds a wrong one."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from studies import StudyError
from studies.readme import __main__ as command
from studies.readme import again
from studies.readme import stated as readme

TEXT = again.stated_text()


def test_every_picture_has_its_command_and_none_is_unused():
    pages = TEXT + (again.ROOT / "studies" / "README.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"\]\((?:\.\./)*\.images/([^)]+)\)", pages))
    assert shown == {picture.name for picture in readme.PICTURES}
    assert shown == {path.name for path in again.IMAGES.iterdir()}


def test_every_number_is_found_in_the_readme_and_can_be_read():
    for stated in readme.NUMBERS:
        written = stated.written(TEXT)
        assert written is not None, stated.words
        assert stated.agrees(written, readme.plain_number(written))


def test_what_the_readme_takes_from_the_benchmarks_page_is_there():
    """Times and errors of its short table, to the digit, and the scenes of the quick stress test."""
    readme, page = ((again.ROOT / name).read_text(encoding="utf-8") for name in again.PAGES)
    section = readme[readme.index("## Speed and accuracy") : readme.index("## How it is built")]
    rows = "\n".join(line for line in section.splitlines() if line.startswith("| "))
    told = re.findall(r"[\d.]+ (?:ms|s|%)(?= |;|,)|[\d.]+·10[⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+", rows)
    assert len(told) > 15
    assert [number for number in told if not re.search(rf"(?<![\d.]){re.escape(number)}", page)] == []
    assert re.findall(r"runs (\d+)", section) == re.findall(r"`--quick` runs (\d+)", page)


@pytest.mark.parametrize(
    ("written", "value", "unit"),
    [("0.1701", 0.1701, 1e-4), ("5·10⁻⁵", 5e-5, 1e-5), ("10⁻⁴", 1e-4, 1.0), ("−0.93", -0.93, 1e-2), ("190", 190, 1)],
)
def test_numbers_as_people_write_them(written, value, unit):
    assert readme.plain_number(written) == pytest.approx(value)
    assert readme.last_digit(written) == pytest.approx(unit)


def test_a_number_that_differs_is_told(capsys):
    stated = readme.Stated("limit", r"is ([\d.]+)", "command", lambda found: found["y"])
    bench = again.Bench(Path())
    bench.printed = lambda command: json.dumps({"y": 0.17004})
    assert again.check([stated], bench, "it is 0.1700") == 0
    assert again.check([stated], bench, "it is 0.1701") == 1
    assert "DIFFERS" in capsys.readouterr().out
    assert again.check([stated], bench, "it was never said") == 1
    bench.printed = lambda command: "{}"
    assert again.check([stated], bench, "it is 0.1700") == 1


@pytest.mark.slow
def test_a_picture_is_made_by_its_command(tmp_path):
    (tmp_path / "images").mkdir()
    picture = readme.Picture("ring.msh", ("hoop scenes", "hoop rigid paper-3.1 --out here"), "here/pulse.png")
    again.make([picture], again.Bench(tmp_path), tmp_path / "images")
    assert (tmp_path / "images" / "ring.msh").stat().st_size > 10_000
    with pytest.raises(StudyError, match=r"left no here/nothing"):
        again.make([readme.Picture("a", ("hoop scenes",), "here/nothing")], again.Bench(tmp_path), tmp_path)
    with pytest.raises(StudyError, match="ended with 2"):
        again.make([readme.Picture("a", ("hoop rigid nothing",), "a")], again.Bench(tmp_path), tmp_path)


@pytest.mark.parametrize("wish", ["--check", "--pictures"])
def test_an_installed_package_has_no_readme_to_compare_or_illustrate(tmp_path: Path, monkeypatch, wish: str):
    """Pictures would be written beside the packages."""
    monkeypatch.setattr(command, "ROOT", tmp_path)
    told = CliRunner().invoke(command.main, [wish, "--only", "no such", "--only", readme.NUMBERS[0].table])
    assert told.exit_code == 2
    assert "installed package" in told.output
    assert not list(tmp_path.iterdir())
