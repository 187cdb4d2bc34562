"""Run the notebooks where they are, and keep the output."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).parent
BOOKS = ("pulse", "limit", "hop")
"""In the order in which they are read."""


def run(path: Path) -> Any:
    """A notebook executed from its first cell to its last.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        A cell that fails.
    """
    import nbformat
    from nbclient import NotebookClient

    book = nbformat.read(path, as_version=4)
    NotebookClient(book, timeout=600, record_timing=False).execute()
    for cell in book.cells:  # which Python ran them is no part of what they say
        cell.metadata.pop("execution", None)
    book.metadata.pop("widgets", None)
    book.metadata["language_info"] = {"name": "python"}
    return book


def main(names: tuple[str, ...] = BOOKS) -> None:
    """Run and rewrite the notebooks named."""
    import nbformat

    for name in names:
        path = HERE / f"{name}.ipynb"
        book = run(path)
        nbformat.write(book, path)
        print(path.name)


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or BOOKS)
