"""Run the notebooks where they are, and keep the output."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

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


@click.command(context_settings={"help_option_names": ["-h", "--help"]})
@click.argument("names", nargs=-1, type=click.Choice(BOOKS))
def main(names: tuple[str, ...]) -> None:
    """Run the notebooks named, by default all, and rewrite them with their output."""
    try:
        import nbformat

        for name in names or BOOKS:
            path = HERE / f"{name}.ipynb"
            book = run(path)
            nbformat.write(book, path)
            click.echo(path.name)
    except ModuleNotFoundError as error:
        raise click.UsageError(f"Notebooks need {error.name}: install hoop-pulse with the extra [test].") from None


if __name__ == "__main__":
    main()
