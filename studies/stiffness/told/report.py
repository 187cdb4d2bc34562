"""A study as one page: report.html, which needs no network and no file beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

from ...plots.page import write_page
from ..found import LIMITS
from ..ladder import spread
from .rows import LIMIT_HEADING, case_cells, case_heading, limit_rows, rigid_cells, side_heading, side_rows
from .sentences import (
    damping_sentence,
    extrapolation_sentence,
    ladder_sentence,
    law_sentence,
    notes,
    prediction_sentence,
    verdict,
)

if TYPE_CHECKING:
    from ..found import StiffnessStudy

CAPTIONS = {
    "pulse": """\
Normal force, friction force and slip velocity of the contact through the first pulse, from soft (dark) to
stiff (light), over the rigid hoop (black, wide). Time counts from the instant at which the disk is lowest. On the right
what is left between each and the rigid hoop where the disk is at the same angle, on a logarithmic axis.""",
    "impulses": """\
The same pulse in impulse space. A curve that runs along a dashed line slides; one that leaves it sticks; one
that turns toward the other line has reversed its slip. The slope from the origin to the end is the impulse
ratio. On the right how far each friction impulse is from the rigid hoop's at the same normal impulse.""",
    "distance": """\
How far the flexible hoop's measures are from the rigid ones. Triangles are the numerical error, known
from a second run at a quarter of the tolerance.""",
    "energy": """\
Where the energy is and where it goes; below, the small terms on a logarithmic axis.""",
}
"""What stands under each figure, in their order; more where there is more in it, see :func:`captions`."""

_FITTED = """\
 The dashed line is what was fitted to the cases that it spans: the series whose powers are known, which dips where the
distance changes its sign, or a single power."""
_FORESEEN = """\
 The black line is the leading powers as predicted from the rigid motion, without any of the cases; """
_FROM, _ONWARD = (
    "it begins where they are the beginning of a series.",
    "they are the beginning of a series from some stiffness on that is not foretold here.",
)


def captions(study: StiffnessStudy) -> dict[str, str]:
    """What stands under each figure of a study: of lines and cases those that are drawn."""
    told = dict(CAPTIONS)
    through = [rung for rung in study.rungs if rung.outcome.histories]
    drawn = spread(through)
    if len(drawn) < len(through):
        some = f" Of the {len(through)} cases {len(drawn)} are drawn, those that the legend names."
        told |= {name: told[name] + some for name in ("pulse", "impulses")}
    distances = [study.distance(name) for name in LIMITS[:2]]
    if any(each.series is not None or isfinite(each.rate) for each in distances):
        told["distance"] += _FITTED
    if any(each.predicted is not None for each in distances):
        told["distance"] += _FORESEEN + (_FROM if study.separate > 0 else _ONWARD)
    return told


def write_figure(study: StiffnessStudy, name: str, folder: Path) -> Path | None:
    """Write the figure of one of ``CAPTIONS`` as PNG and SVG.

    Returns
    -------
    Path or None
        The SVG; none where the study has nothing to draw in it.
    """
    from ...plots.style import save_both
    from .figures import FIGURES

    figure = FIGURES[name](study)
    return None if figure is None else save_both(figure, folder / name)


FOUND = """\
<h2>The limit of the first whole pulse</h2>
{{ table(limit_heading, limits) }}
<p>{{ extrapolation }} The rate is that of the distance to the rigid value where its sign no longer changes, a dash
where the cases tell none; the last distance is that of the stiffest case.
{{ prediction }} {{ law }} {{ damping }}</p>

{{ pictures(figures) }}

<h2>Case by case</h2>
<p>{{ ladder }}</p>
<div class="wide"><table><thead><tr>{% for cell in heading %}<th>{{ cell }}</th>{% endfor
%}</tr></thead><tbody>
{% for row in cases %}<tr>{% for cell in row.cells %}<td>{{ cell }}</td>{% endfor %}
{% if row.failure %}<td class="bad" colspan="{{ heading|length - 2 }}">{{ row.failure }}</td>{% endif %}</tr>
{% endfor %}<tr class="rigid">{% for cell in rigid %}<td>{{ cell }}</td>{% endfor %}</tr>
</tbody></table></div>
<p>± is the numerical error of a case, known from a second run at a quarter of the tolerance, that of the loss no less
than what the steps themselves took of the energy; the tolerance was tightened until that error was a tenth of the
distance to the rigid value, or of the predicted one where that is more, as far as the solver's own noise and a bound on
its work let it.{{ unresolved }}</p>
{% for note in notes %}<p>{{ note }}</p>
{% endfor %}

<h2>All measures of the first whole pulse, side by side</h2>
{{ table(side_heading, side) }}
<p>The three e are restitutions of the pulse, by the vertical velocity of the mass centre: Newton's is the velocity
behind it over that before it, with the other sign; Poisson's the normal impulse while the centre rises over that while
it falls; the energetic one the square root of the work that N does on the centre while it rises over what it takes from
it while it falls.</p>
"""


def stiffness_report(
    study: StiffnessStudy,
    images: Mapping[str, Path],
    command: str,
    path: Path,
    numbers: Sequence[Path] = (),
    beside: Sequence[str] = (),
) -> Path:
    """Write the page of a stiffness study.

    Parameters
    ----------
    study : StiffnessStudy
        What is told.
    images : dict of str to Path
        Figures by name, files that are copied into the page.
    command : str
        The command that made it.
    path : Path
        The page; written whole or not at all, and last: what it names is there.
    numbers : sequence of Path
        Files of the same numbers, which the page holds too.
    beside : sequence of str
        A line on each other file that lies beside it.
    """
    scene = study.scene
    hoop = f"k = {scene.hoop.k:g}, r = {scene.hoop.r:g}, m_h/m = {scene.hoop.mass_ratio:g}"
    under = captions(study)
    slow = [rung for rung in study.rungs if not rung.outcome.failure and not rung.outcome.resolved]
    told = {
        "title": f"The flexible hoop as stiffness grows: {hoop}",
        "verdict": verdict(study),
        "limits": limit_rows(study),
        "extrapolation": extrapolation_sentence(study),
        "law": law_sentence(study),
        "damping": damping_sentence(study),
        "prediction": prediction_sentence(study),
        "images": {name: (under.get(name, name), file) for name, file in images.items()},
        "heading": case_heading(study),
        "limit_heading": LIMIT_HEADING,
        "cases": [{"cells": case_cells(study, rung), "failure": rung.outcome.failure} for rung in study.rungs],
        "rigid": rigid_cells(study),
        "unresolved": f" Not reached at {len(slow)} of the cases, marked *." if slow else "",
        "notes": notes(replace(study, rungs=tuple(study.stopped))),
        "side_heading": side_heading(study),
        "side": side_rows(study),
        "ladder": ladder_sentence(study),
        "numbers": numbers,
        "beside": beside,
    }
    return write_page(FOUND, path, scene, command, told)
