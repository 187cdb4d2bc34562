"""The paper again: V. A. Lubarda, J. Mech. Mater. Struct. 4(6), 2009, its figures 2 to 12 and every number it prints.

``panels``    what a figure is made of, as data; ``figures`` the paper's, one record each
``sampling``  their curves as numbers; ``drawing`` as pictures and as CSV; ``extra`` two figures of our own
``numbers``   the printed numbers beside ours; ``seen`` what the text says of its figures, looked for in ours
``closing``   both as one table
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from .closing import closing, screen
from .figures import FIGURES
from .numbers import Verdict

Progress = Callable[[int, int, str], None]


def reproduce(out: Path, formats: Sequence[str] = ("png", "svg"), progress: Progress | None = None) -> list[Verdict]:
    """Draw ``figure-02`` to ``figure-12`` and two extra ones, their points as CSV, and the closing table.

    Parameters
    ----------
    out : Path
        A folder; made if it does not exist.
    formats : sequence of str
        "png", "svg" or both.
    progress : callable, optional
        Called as ``progress(done, total, what)`` after each piece.

    Returns
    -------
    list of Verdict
        The closing table, which is also in ``table.csv`` and ``table.md``.
    """
    from .closing import write
    from .drawing import write_figure
    from .extra import CAPTIONS, write_extra

    out.mkdir(parents=True, exist_ok=True)
    total = len(FIGURES) + 2

    def told(done: int, what: str) -> None:
        if progress is not None:
            progress(done, total, what)

    for done, figure in enumerate(FIGURES, 1):
        write_figure(figure, out, formats)
        told(done, f"figure {figure.number}")
    write_extra(out, formats)
    told(total - 1, "extra figures")
    verdicts = closing()
    captions = [f"* `{figure.name}`: {figure.caption}" for figure in FIGURES]
    captions += [f"* `{name}`: {caption}" for name, caption in CAPTIONS.items()]
    write(verdicts, captions, out)
    told(total, "table")
    return verdicts


__all__ = ["FIGURES", "Verdict", "closing", "reproduce", "screen"]
