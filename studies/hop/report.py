"""The map as one page: report.html, which needs no network and no file beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ..plots.page import write_page
from .study import HopStudy
from .summary import (
    answer,
    case_sheet,
    rule_sentence,
    scaling_sentences,
    threshold_sheet,
    unfinished_sentences,
    verdict,
)

CAPTIONS = {
    "map": """\
Where the hoop hops, over the bending stiffness and the second key; a roll that hops at several places has the colour
of the rarest. Lines: the bending stiffness below which it leaves the floor anywhere (dots), within its first pulse
(squares), and under the disk (triangles). A cross marks a roll that stopped before its end. On the right where the
first hop begins, and the height of the highest as far as it was rolled; white: none.""",
    "where": """\
Where each hop begins and how high it goes. Light band: the first pulse, the angles at which the rigid hoop's N exceeds
the weight; dark: the contact is under the disk. A stroke at the foot marks a roll without a hop, a cross
how far one came that stopped before its end.""",
    "energies": """\
One hop: what ring and floor store, what vibrates (kinetic energy beyond that of a rigid motion), what is lost since the
picture begins, and the same on a logarithmic axis; the lowest point of the rim over the floor, and N. Shaded: off the
floor.""",
    "liftoff": """\
The ring at the first step off the floor, over the circle it would be undeformed, not exaggerated; on the right the rim
over the floor, heights enlarged.""",
    "hop": "The same hop, moving.",
}

FOUND = """\
<ul>{% for sentence in lines %}<li>{{ sentence }}</li>{% endfor %}</ul>
{% for sentence in sentences %}<p>{{ sentence }}</p>
{% endfor %}{{ pictures(figures) }}
{% for sheet in sheets %}
<h2>{{ sheet.title }}</h2>
{{ table(sheet.heads, sheet.rows) }}
{% endfor %}
"""


def hop_report(
    study: HopStudy, images: Mapping[str, Path], command: str, path: Path, numbers: Sequence[Path] = ()
) -> Path:
    """Write the page of a hop study, whole or not at all, and last; it holds the files of ``numbers`` too."""
    told = {
        "title": "Does an elastic hoop hop?",
        "verdict": answer(study),
        "lines": verdict(study),
        "sentences": [*scaling_sentences(study), rule_sentence(study), *unfinished_sentences(study)],
        "sheets": [threshold_sheet(study).to_dict(), case_sheet(study).to_dict()],
        "of_scene": _which_scene(study),
        "numbers": numbers,
        "images": {name: (CAPTIONS.get(name, name), file) for name, file in images.items()},
    }
    return write_page(FOUND, path, study.rolled, command, told)


def _which_scene(study: HopStudy) -> str:
    """Which roll the scene is of that a page shows, and what the others have in its place."""
    rtol = study.rolled.solve.rtol
    finer = min((case.scene.solve.rtol for line in study.lines for case in line.finer), default=rtol)
    keys = "ring.bending_stiffness is" if study.second is None else f"ring.bending_stiffness and {study.second} are"
    times = f" and run.t_end goes with {study.second}" if study.second is not None else ""
    again = f", and at {finer:g} once more at the ends of thresholds" if finer < rtol else ""
    return (
        f"That of the first roll: in each other one {keys} as in the table{times}. "
        f"They are rolled at a tolerance of {rtol:g}{again}."
    )
