"""The folder of a study: one SQLite file of rows and, beside it, histories as compressed arrays.

Each case is written whole or not at all: its arrays under a temporary name and renamed, then its row in one
transaction. A row is therefore never there without its arrays; whatever dies in between leaves at most a file
that nothing refers to, and the next run writes it again. Several runs may write into one folder: SQLite's
lock orders their transactions, and they would write the same rows under the same keys.
"""

from __future__ import annotations

import dataclasses
import json
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from .case import Outcome
from .files import StudyError, folder, to_json, write_whole

_SCHEMA = """
CREATE TABLE IF NOT EXISTS cases (
    key TEXT PRIMARY KEY, solver TEXT NOT NULL, version TEXT NOT NULL, failure TEXT NOT NULL,
    seconds REAL NOT NULL, outcome TEXT NOT NULL, histories INTEGER NOT NULL
)
"""


class Store:
    """Outcomes by key, in ``out``.

    Raises
    ------
    StudyError
        The folder cannot be written to, the disk is full, or ``study.sqlite`` there is something else.
    """

    def __init__(self, out: str | Path) -> None:
        self.folder = folder(out)
        self.file = self.folder / "study.sqlite"
        with self._connection() as connection:
            connection.execute(_SCHEMA)

    @contextmanager
    def _connection(self) -> Iterator[sqlite3.Connection]:
        """One transaction: committed whole, or rolled back.

        The rollback journal is kept rather than WAL, which needs shared memory and fails on network folders.
        """
        try:
            connection = sqlite3.connect(self.file, timeout=60.0, isolation_level=None)
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
        for number, columns in enumerate(outcome.histories):
            write_whole(self._history(outcome.key, number), partial(_save, columns))
        bare = dataclasses.asdict(dataclasses.replace(outcome, histories=()))
        row = (
            outcome.key,
            outcome.solver,
            outcome.version,
            outcome.failure,
            outcome.seconds,
            to_json(bare, indent=None),
            len(outcome.histories),
        )
        with self._connection() as connection:
            connection.execute("INSERT OR REPLACE INTO cases VALUES (?, ?, ?, ?, ?, ?, ?)", row)

    def get(self, key: str, histories: bool = True) -> Outcome | None:
        """The outcome kept under a key, or None."""
        with self._connection() as connection:
            row = connection.execute("SELECT outcome, histories FROM cases WHERE key = ?", (key,)).fetchone()
        if row is None:
            return None
        values: dict[str, Any] = json.loads(row[0])
        for name in ("pulses", "numerical_error"):
            values[name] = tuple(
                {measure: _number(value) for measure, value in entry.items()} for entry in values[name]
            )
        values["phases"] = tuple(values["phases"])
        values["histories"] = tuple(self._load(key, number) for number in range(row[1])) if histories else ()
        return Outcome(**values)

    def done(self) -> set[str]:
        """Keys of the cases that have a result."""
        with self._connection() as connection:
            return {key for (key,) in connection.execute("SELECT key FROM cases WHERE failure = ''")}

    def _history(self, key: str, number: int) -> Path:
        place = self.folder / "histories"
        place.mkdir(exist_ok=True)
        return place / f"{key}-{number + 1}.npz"

    def _load(self, key: str, number: int) -> dict[str, np.ndarray]:
        path = self._history(key, number)
        try:
            with np.load(path) as arrays:
                return {name: arrays[name] for name in arrays.files}
        except (OSError, ValueError, KeyError) as error:
            raise StudyError(f"{path} cannot be read: {error}.") from None


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


def _save(columns: dict[str, Any], part: Path) -> None:
    np.savez_compressed(part, **columns)


def _words(error: sqlite3.Error) -> str:
    """What SQLite says, in the words used for other files."""
    message = str(error)
    for said, words in (
        ("full", "the disk is full"),
        ("readonly", "it or its folder is read-only"),
        ("unable to open", "it cannot be opened for writing"),
        ("not a database", "it is not a study's file"),
        ("malformed", "it is damaged"),
        ("locked", "another program has held it for a minute"),
        ("disk I/O", "the disk is full or failing"),
    ):
        if said in message:
            return words
    return message
