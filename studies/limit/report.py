"""The limit as one page: report.html, which needs no network and no file beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from rigid import scene_to_dict

from ..plots.page import PAGE_STYLE, embedded, toml
from ..plots.sheet import Sheet
from ..running.files import write_text
from ..running.solvers import versions
from .study import LimitStudy
from .summary import damping_sentences, limit_sheets, other_sentences, verdict

CAPTIONS = {
    "approach": """\
Distance to the limit against the foundation. The line is predicted from the rigid motion, without a fitted number;
circles are a rigid ring on a compliant floor, squares the flexible solver.""",
    "layers": """\
Normal force, friction force and slip velocity through the layer of each event on its own clock, over the rigid hoop's
forces before and behind it and the creep towards which the patch goes (grey).""",
    "damping": """\
J_F/J_N over damping ratio and foundation; on the right what is left beyond the predicted distance, over how often the
ringing falls by e within the stick.""",
}

PAGE = """\
<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{{ title }}</title>
<style>
{{ style }}</style>
</head>
<body>
<h1>{{ title }}</h1>
<p class="lead">{{ verdict }}</p>
<p>Where J<sub>F</sub>/J<sub>N</sub> tends by what is compliant:</p>
<ul>{% for other in others %}<li>{{ other }}</li>{% endfor %}</ul>
<p>{{ damping }}</p>
{% for sheet in sheets %}
<h2>{{ sheet.title }}</h2>
<div class="wide"><table><thead><tr>{% for cell in sheet.heads %}<th>{{ cell }}</th>{% endfor %}</tr></thead><tbody>
{% for row in sheet.rows %}<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}</tbody></table></div>
{% endfor %}
{% for sentence in failed %}<p>{{ sentence }}</p>{% endfor %}
{% for name, caption, image in figures %}
<figure id="{{ name }}"><img alt="{{ caption }}" src="data:image/png;base64,{{ image }}"><figcaption>{{
caption }}</figcaption></figure>
{% endfor %}
<h2>The scene</h2>
<pre>{{ scene }}</pre>
<h2>How this page was made</h2>
<pre>{{ command }}</pre>
<footer>{{ versions }}</footer>
</body>
</html>
"""


def limit_report(
    study: LimitStudy, more: tuple[Sheet, ...], images: Mapping[str, Path], command: str, path: Path
) -> Path:
    """Write the page of a study of the limit; ``more`` sheets come below its own. Whole or not at all."""
    from jinja2 import Environment
    from markupsafe import Markup

    hoop = study.scene.hoop
    told = [*limit_sheets(study), *more]
    page = (
        Environment(autoescape=True, trim_blocks=True)
        .from_string(PAGE)
        .render(
            title=f"The limit of infinite stiffness: k = {hoop.k:g}, r = {hoop.r:g}, m_h/m = {hoop.mass_ratio:g}",
            style=Markup(PAGE_STYLE),
            verdict=verdict(study),
            others=other_sentences(study),
            damping=" ".join(damping_sentences(study)),
            sheets=[_rows(sheet) for sheet in told if isinstance(sheet, Sheet)],
            failed=[f"Foundation {s.foundation:.3g} failed: {s.failure}" for s in study.sights if s.failure],
            figures=[(name, CAPTIONS.get(name, name), embedded(file)) for name, file in images.items()],
            scene=toml(scene_to_dict(study.scene)),
            command=command,
            versions=", ".join(f"{package} {number}" for package, number in versions().items()),
        )
    )
    return write_text(path, page)


def _rows(sheet: Sheet) -> dict[str, object]:
    columns = [*sheet.keys, *sheet.columns]
    rows = list(zip(*(column.cells for column in columns), strict=True))
    return {"title": sheet.title, "heads": [column.heading for column in columns], "rows": rows}
