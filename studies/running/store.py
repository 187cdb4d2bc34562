"""The folder of a study: one SQLite file of rows and, beside it, histories as compressed arrays.

Each case is written whole or not at all: its arrays under a temporary name and renamed, then its row in one
transaction. A row is therefore never there without its arrays; whatever dies in between leaves at most a file
that nothing refers to, and the next run writes it again. Several runs may write into one folder: SQLite's
lock orders their transactions, and they would write the same rows under the same keys.

Disks lose bits and people move files: a row carries the digest of its own text and of each of its files, and is found
again only if all of them are as they were written.
"""

from __future__ import annotations

import dataclasses
import hashlib
import io
import json
import sqlite3
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from math import isinf
from pathlib import Path
from typing import Any

import numpy as np

from .case import Outcome
from .files import StudyError, folder, to_json, write_whole
from .history import Columns

FILE = "study.sqlite"
"""Name of the file of rows."""

NUMBERS = ("pulses", "numerical_error")
"""What of an outcome is measures by name, once for each pulse."""

_FORMAT = 2
"""Of the file; another number is another version's."""

_AT_ONCE = 200
"""Rows read in one transaction."""

_SCHEMA = """
CREATE TABLE IF NOT EXISTS cases (
    key TEXT PRIMARY KEY, solver TEXT NOT NULL, version TEXT NOT NULL, failure TEXT NOT NULL,
    seconds REAL NOT NULL, outcome TEXT NOT NULL, histories TEXT NOT NULL, checksum TEXT NOT NULL
)
"""


class Damaged(Exception):
    """A row or a file of it that is not what was written."""


class Store:
    """Outcomes by key, in ``out``.

    Raises
    ------
    StudyError
        The folder cannot be written to, the disk is full, or ``study.sqlite`` there is something else.
    """

    def __init__(self, out: str | Path) -> None:
        self.folder = folder(out)
        self.file = self.folder / FILE
        if (self.folder / "histories").exists():
            folder(self.folder / "histories")
        with self._connection() as connection:
            (found,) = connection.execute("PRAGMA user_version").fetchone()
            if found != _FORMAT and connection.execute("SELECT 1 FROM sqlite_master").fetchone() is not None:
                raise StudyError(f"{self.file} is another version's: results of this one need a folder of their own.")
            connection.execute(_SCHEMA)
            connection.execute(f"PRAGMA user_version = {_FORMAT}")

    @contextmanager
    def _connection(self) -> Iterator[sqlite3.Connection]:
        """One transaction: committed whole, or rolled back.

        The rollback journal is kept rather than WAL, which needs shared memory and fails on network folders.
        """
        try:
            connection = sqlite3.connect(self.file, timeout=60.0, isolation_level=None)
            connection.text_factory = _text
            try:
                connection.execute("PRAGMA synchronous = FULL")
                connection.execute("BEGIN IMMEDIATE")
                try:
                    yield connection
                    connection.execute("COMMIT")
                except BaseException:
                    if connection.in_transaction:
                        connection.execute("ROLLBACK")
                    raise
            finally:
                connection.close()
        except sqlite3.Error as error:
            raise StudyError(f"{self.file} cannot be used: {_words(error)}.") from None

    def add(self, outcome: Outcome) -> None:
        """Keep an outcome, in place of what its key had before."""
        digests = []
        for number, columns in enumerate(outcome.histories):
            packed = _packed(columns)
            write_whole(self._history(outcome.key, number), partial(_put, packed))
            digests.append(hashlib.sha256(packed).hexdigest())
        told = dataclasses.asdict(dataclasses.replace(outcome, histories=()))
        for name in NUMBERS:
            told[name] = [{measure: _told(value) for measure, value in entry.items()} for entry in told[name]]
        text = to_json(told, indent=None)
        files = json.dumps(digests)
        about = (outcome.key, outcome.solver, outcome.version, outcome.failure, outcome.seconds)
        row = (*about, text, files, _checksum(outcome.key, outcome.failure, text, files))
        with self._connection() as connection:
            connection.execute("INSERT OR REPLACE INTO cases VALUES (?, ?, ?, ?, ?, ?, ?, ?)", row)

    def find(
        self, keys: Iterable[str], histories: bool = True, made: Callable[[Outcome], Outcome] | None = None
    ) -> tuple[dict[str, Outcome], set[str]]:
        """The results kept under any of ``keys``, and which of the keys have a damaged one.

        A case that failed has no result. Without ``histories`` the arrays are verified and left on the disk. What is
        ``made`` of each, as it is read, comes back in its place.
        """
        found, damaged = {}, set()
        for key, row in self._rows(set(keys)):
            try:
                outcome = self._read(key, row, histories)
            except Damaged:
                damaged.add(key)
            else:
                if not outcome.failure:
                    found[key] = outcome if made is None else made(outcome)
        return found, damaged

    def _rows(self, keys: set[str]) -> Iterator[tuple[str, tuple[Any, ...]]]:
        """Rows some hundred at a time: all of them may be more than memory, or than others should wait for."""
        asked = sorted(keys)
        for low in range(0, len(asked), _AT_ONCE):
            some = asked[low : low + _AT_ONCE]
            marks = ", ".join("?" * len(some))
            query = f"SELECT key, failure, outcome, histories, checksum FROM cases WHERE key IN ({marks})"
            with self._connection() as connection:
                rows = connection.execute(query, some).fetchall()
            yield from ((key, tuple(rest)) for key, *rest in rows)

    def get(self, key: str, histories: bool = True) -> Outcome | None:
        """The result kept under a key, or None where there is none or it is damaged."""
        return self.find([key], histories)[0].get(key)

    def done(self) -> set[str]:
        """Keys of the cases that have a result, as their rows say; :meth:`find` looks whether it is sound."""
        with self._connection() as connection:
            return {key for (key,) in connection.execute("SELECT key FROM cases WHERE failure = ''")}

    def size(self) -> int:
        """Bytes of the rows and arrays kept here."""
        places = [self.file, *(self.folder / "histories").glob("*.npz")]
        return sum(place.stat().st_size for place in places if place.exists())

    def _history(self, key: str, number: int) -> Path:
        place = self.folder / "histories"
        place.mkdir(exist_ok=True)
        return place / f"{key}-{number + 1}.npz"

    def _read(self, key: str, row: tuple[Any, ...], histories: bool) -> Outcome:
        failure, text, files, checksum = row
        if checksum != _checksum(key, failure, text, files):
            raise Damaged(key)
        columns = [self._verified(key, number, digest) for number, digest in enumerate(json.loads(files))]
        values: dict[str, Any] = json.loads(text)
        for name in NUMBERS:
            values[name] = tuple(
                {measure: _number(value) for measure, value in entry.items()} for entry in values[name]
            )
        values["phases"] = tuple(values["phases"])
        values["histories"] = tuple(map(_unpacked, columns)) if histories else ()
        return Outcome(**values)

    def _verified(self, key: str, number: int, digest: str) -> bytes:
        try:
            packed = self._history(key, number).read_bytes()
        except OSError as error:
            raise Damaged(key) from error
        if hashlib.sha256(packed).hexdigest() != digest:
            raise Damaged(key)
        return packed


def finished(out: Path) -> int:
    """How many cases of a folder have a result; none where there is no study, or none that can be read."""
    if not (out / FILE).is_file():
        return 0
    try:
        return len(Store(out).done())
    except StudyError:
        return 0


def _checksum(*texts: Any) -> str:
    """Of texts, told apart; of whatever else has come to stand in their place, too."""
    return hashlib.sha256(repr(texts).encode("utf-8", "surrogatepass")).hexdigest()


def _text(stored: bytes) -> str:
    """Text of a row, whatever has become of its bytes: its checksum says whether it is what was written."""
    return stored.decode("utf-8", "surrogateescape")


def _told(value: float) -> float | str:
    """A number in JSON, which has no infinity; what is not known is null there."""
    return str(value) if isinf(value) else value


def _number(value: float | str | None) -> float:
    return float("nan") if value is None else float(value)


def _packed(columns: Mapping[str, Any]) -> bytes:
    """Columns as an npz file: the same bytes for the same numbers."""
    file = io.BytesIO()
    np.savez_compressed(file, **columns)
    return file.getvalue()


def _put(packed: bytes, part: Path) -> None:
    part.write_bytes(packed)


def _unpacked(packed: bytes) -> Columns:
    with np.load(io.BytesIO(packed)) as arrays:
        return {name: arrays[name] for name in arrays.files}


def _words(error: sqlite3.Error) -> str:
    """What SQLite says, in the words used for other files."""
    message = str(error)
    for said, words in (
        ("full", "the disk is full"),
        ("readonly", "it or its folder is read-only"),
        ("unable to open", "it cannot be opened for writing"),
        ("not a database", "it is not a study's file"),
        ("malformed", "it is damaged; remove it to begin anew"),
        ("no such column", "it is not a study's file"),
        ("locked", "another program has held it for a minute"),
        ("disk I/O", "the disk is full or failing"),
    ):
        if said in message:
            return words
    return message
