"""The limit as one page: report.html, which needs no network and no file beside it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from ..plots.page import write_page
from ..plots.sheet import Sheet
from .study import LimitStudy
from .summary import damping_sentences, failures, limit_sheets, other_sentences, unlike_sentences, verdict

CAPTIONS = {
    "approach": """\
Distance to the limit against the foundation. The line is predicted from the rigid motion, without a fitted number;
circles are a rigid ring on a compliant floor, squares the flexible solver.""",
    "layers": """\
Normal force, friction force and slip velocity through the layer of each event at which forces jump, on its own
clock, over the rigid hoop's forces before and behind it and the creep towards which the patch goes (grey).""",
    "damping": """\
J_F/J_N over damping ratio and foundation; on the right, where a stick ends within the pulse, what is left beyond the
predicted distance, over how often the ringing falls by e within the stick.""",
}

FOUND = """\
<p>Where J<sub>F</sub>/J<sub>N</sub> tends by what is compliant, approached so with this scene's damping:</p>
<ul>{% for other in others %}<li>{{ other }}</li>{% endfor %}</ul>
<p>{{ damping }}</p>
{% for sheet in sheets %}
<h2>{{ sheet.title }}</h2>
{{ table(sheet.heads, sheet.rows) }}
{% endfor %}
{% for sentence in failed %}<p>{{ sentence }}</p>{% endfor %}
{{ pictures(figures) }}
"""


def limit_report(
    study: LimitStudy,
    more: tuple[Sheet, ...],
    images: Mapping[str, Path],
    command: str,
    path: Path,
    numbers: Sequence[Path] = (),
) -> Path:
    """Write the page of a study of the limit; ``more`` sheets come below its own, ``numbers`` are files that it holds.

    Whole or not at all, and last: what it names is there.
    """
    hoop = study.scene.hoop
    told = {
        "title": f"The limit of infinite stiffness: k = {hoop.k:g}, r = {hoop.r:g}, m_h/m = {hoop.mass_ratio:g}",
        "verdict": verdict(study),
        "others": other_sentences(study),
        "damping": " ".join(damping_sentences(study)),
        "sheets": [sheet.to_dict() for sheet in (*limit_sheets(study), *more) if isinstance(sheet, Sheet)],
        "failed": [*unlike_sentences(study), *failures(study)],
        "numbers": numbers,
        "images": {name: (CAPTIONS.get(name, name), file) for name, file in images.items()},
    }
    return write_page(FOUND, path, study.scene, command, told)
