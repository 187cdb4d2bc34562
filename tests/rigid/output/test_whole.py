"""Files that are there whole or not at all, whoever writes them at once."""

from __future__ import annotations

import os
import stat
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from threading import Barrier

import pytest

from rigid.output.whole import write_whole


def test_threads_that_write_one_file_do_not_meet(tmp_path):
    """Both fill their part at the same time; what is there then is one of them, whole."""
    both = Barrier(2)
    texts = ["a" * 100_000, "b" * 100_000]

    def write(text: str) -> None:
        def fill(part: Path) -> None:
            with part.open("w") as file:
                file.write(text[:50_000])
                both.wait(timeout=60)
                file.write(text[50_000:])

        write_whole(tmp_path / "file.txt", fill)

    with ThreadPoolExecutor(2) as pool:
        list(pool.map(write, texts))
    assert [path.name for path in tmp_path.iterdir()] == ["file.txt"]
    assert (tmp_path / "file.txt").read_text() in texts


@pytest.mark.parametrize("name", ["", ".", "/"])
def test_a_name_that_is_a_folders_is_refused_as_one(name):
    with pytest.raises(IsADirectoryError):
        write_whole(Path(name), Path.touch)


@pytest.mark.parametrize("synced", [False, True])
def test_an_older_file_stays_until_the_new_one_is_whole(tmp_path, synced):
    path = tmp_path / "file.txt"
    path.write_text("old")

    def breaks(part: Path) -> None:
        part.write_text("half")
        assert part.suffix == path.suffix
        assert path.read_text() == "old"
        raise KeyError

    with pytest.raises(KeyError):
        write_whole(path, breaks, synced=synced)
    assert [file.name for file in tmp_path.iterdir()] == ["file.txt"]
    write_whole(path, lambda part: part.write_text("new"), synced=synced)
    assert path.read_text() == "new"


@pytest.mark.skipif(os.name != "posix", reason="modes of files are POSIX")
def test_others_may_read_it_as_any_file(tmp_path):
    """As the user's mask has it: a temporary file of the system's is its owner's alone."""
    (tmp_path / "plain").touch()
    write_whole(tmp_path / "whole", lambda part: part.write_text("text"))
    modes = [stat.S_IMODE((tmp_path / name).stat().st_mode) for name in ("plain", "whole")]
    assert modes[0] == modes[1]
