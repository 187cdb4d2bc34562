"""The map as one page: report.html, which needs no network and no file beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from rigid import scene_to_dict

from ..plots.page import PAGE_STYLE, embedded, toml
from ..plots.sheet import Sheet
from ..running.files import write_text
from ..running.solvers import versions
from .study import HopStudy
from .summary import case_sheet, rule_sentence, scaling_sentence, threshold_sheet, unfinished_sentences, verdict

CAPTIONS = {
    "map": """\
Height of the highest hop between release and end, over the bending stiffness and the second key; white: no hop.
Lines: the bending stiffness below which the hoop leaves the floor anywhere, within its first pulse, and under the disk.
A cross marks a roll that stopped before its end.""",
    "where": """\
Where each hop begins and how high it goes. Light band: the first pulse, the angles at which the rigid hoop's N exceeds
the weight; dark: the contact is under the disk. A cross marks how far a roll came that stopped before its end.""",
    "energies": """\
One hop: what ring and floor store, what vibrates (kinetic energy beyond that of a rigid motion), what is lost since the
picture begins; the lowest point of the rim over the floor, and N. Shaded: off the floor.""",
    "liftoff": """\
The ring at the first step off the floor, over the circle it would be undeformed, not exaggerated; on the right the rim
over the floor, heights enlarged.""",
    "hop": "The same hop, moving.",
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
{% for sentence in verdict %}<p class="lead">{{ sentence }}</p>
{% endfor %}{% for sentence in told %}<p>{{ sentence }}</p>
{% endfor %}{% for name, caption, kind, image in figures %}
<figure id="{{ name }}"><img alt="{{ caption }}" src="data:image/{{ kind }};base64,{{ image }}"><figcaption>{{
caption }}</figcaption></figure>
{% endfor %}{% for sheet in sheets %}
<h2>{{ sheet.title }}</h2>
<div class="wide"><table><thead><tr>{% for cell in sheet.heads %}<th>{{ cell }}</th>{% endfor %}</tr></thead><tbody>
{% for row in sheet.rows %}<tr>{% for cell in row %}<td>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}</tbody></table></div>
{% endfor %}
<h2>The scene</h2>
<pre>{{ scene }}</pre>
<h2>How this page was made</h2>
<pre>{{ command }}</pre>
<footer>{{ versions }}</footer>
</body>
</html>
"""


def hop_report(study: HopStudy, images: Mapping[str, Path], command: str, path: Path) -> Path:
    """Write the page of a hop study, whole or not at all."""
    from jinja2 import Environment
    from markupsafe import Markup

    told = [*scaling_sentence(study), rule_sentence(study), *unfinished_sentences(study)]
    page = (
        Environment(autoescape=True, trim_blocks=True)
        .from_string(PAGE)
        .render(
            title="Does an elastic hoop hop?",
            style=Markup(PAGE_STYLE),
            verdict=verdict(study),
            told=told,
            figures=[(n, CAPTIONS.get(n, n), file.suffix[1:], embedded(file)) for n, file in images.items()],
            sheets=[_rows(threshold_sheet(study)), _rows(case_sheet(study))],
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
