"""What the pages of all studies share: one frame, in which each says what it found."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rigid import Scene, scene_to_dict

from ..machine.build import versions
from ..running.files import write_text

PAGE_STYLE = """\
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 86rem; margin: 2rem
auto; padding: 0 1.2rem; } h1 { font-size: 1.6rem; line-height: 1.25; margin-bottom: .3rem; } h2 { font-size:
1.15rem; margin-top: 2.2rem; } p, ul, figcaption { max-width: 52rem; } .lead { font-size: 1.15rem; }
.wide { overflow-x: auto; }
table { border-collapse: separate; border-spacing: 0; font-size: .8rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .5rem; text-align: right; border-bottom: 1px solid #e4e4e4; white-space: nowrap;
background: #fff; vertical-align: top; }
th { white-space: pre-line; } td.words { white-space: normal; min-width: 5rem; }
th:first-child, td:first-child { text-align: left; }
th:last-child, td:last-child { position: sticky; right: 0; box-shadow: -1px 0 #e4e4e4; }
thead th { border-bottom: 2px solid #999; vertical-align: bottom; }
tr.rigid td { border-top: 2px solid #999; font-weight: 600; }
td.bad { color: #a33; text-align: left; white-space: normal; }
figure { margin: 1.2rem 0 2rem; } figcaption { color: #555; font-size: .9rem; }
.enlarge { display: block; overflow-x: auto; cursor: zoom-in; } .enlarge input { position: absolute; opacity: 0; }
.enlarge img { max-width: min(100%, 66rem); height: auto; display: block; }
.enlarge input:checked + img { width: 110rem; max-width: none; cursor: zoom-out; }
.enlarge input:focus-visible + img { outline: 2px solid #0072B2; }
code, pre { font: .85rem/1.45 ui-monospace, monospace; background: #f5f5f3; } pre { padding: .7rem 1rem;
overflow-x: auto; } code { padding: .1rem .3rem; }
footer { color: #666; font-size: .85rem; margin-top: 3rem; border-top: 1px solid #ddd; padding-top: .8rem; }
"""
"""Their looks, as CSS."""


FRAME = """\
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
{% block found %}{% endblock %}
<h2>The numbers</h2>
<ul>{% for name, address in numbers %}<li><a download="{{ name }}" href="{{ address }}">{{ name }}</a></li>{% endfor
%}{% for line in beside %}<li>{{ line }}</li>{% endfor %}</ul>
<h2>The scene as it was run</h2>
{% if of_scene %}<p>{{ of_scene }}</p>
{% endif %}
<pre>{{ scene }}</pre>
<h2>How this page was made</h2>
<pre>{{ command }}</pre>
<footer>{{ versions }}</footer>
</body>
</html>
"""
"""A page around what a study tells, its block ``found``."""

PARTS = """\
{% macro table(heads, rows) %}
<div class="wide"><table><thead><tr>{% for cell in heads %}<th>{{ cell }}</th>{% endfor %}</tr></thead><tbody>
{% for row in rows %}<tr>{% for cell in row %}<td{% if " " in cell %} class="words"{% endif
%}>{{ cell }}</td>{% endfor %}</tr>
{% endfor %}</tbody></table></div>
{% endmacro %}
{% macro pictures(figures) %}
{% for name, caption, kind, image in figures %}
<figure id="{{ name }}"><label class="enlarge" title="larger, smaller"><input type="checkbox"><img alt="{{ caption }}"
src="data:image/{{ kind }};base64,{{ image }}"></label><figcaption>{{ caption }}</figcaption></figure>
{% endfor %}
{% endmacro %}
"""
"""Tables and figures of a page."""


def write_page(found: str, path: Path, scene: Scene, command: str, told: Mapping[str, Any]) -> Path:
    """Write a study's page, whole or not at all.

    Parameters
    ----------
    found : str
        What stands between its first lines and the scene: a template that may use ``table`` and ``pictures``.
    path : Path
        The page, which needs no network and no file beside it.
    scene, command
        What was studied, and how.
    told : dict
        What the template asks for, and ``title``, ``verdict``, ``images``: ``{name: (caption, SVG, PNG or GIF file)}``;
        where there are any, ``numbers``, CSV or JSON files that the page holds too, and ``beside``, lines on other
        files; ``of_scene``, which of several scenes that is.
    """
    from jinja2 import DictLoader, Environment
    from markupsafe import Markup

    inside = (
        '{% extends "frame" %}{% from "parts" import table, pictures %}{% block found %}' + found + "{% endblock %}"
    )
    loader = DictLoader({"frame": FRAME, "parts": PARTS, "page": inside})
    page = (
        Environment(autoescape=True, trim_blocks=True, loader=loader)
        .get_template("page")
        .render(
            {name: value for name, value in told.items() if name not in ("images", "numbers")},
            figures=[
                (name, caption, KINDS.get(file.suffix, file.suffix[1:]), embedded(file))
                for name, (caption, file) in told["images"].items()
            ],
            numbers=[(file.name, f"data:text/plain;base64,{embedded(file)}") for file in told.get("numbers", ())],
            style=Markup(PAGE_STYLE),
            scene=toml(scene_to_dict(scene)),
            command=command,
            versions=", ".join(f"{package} {number}" for package, number in versions().items()),
        )
    )
    return write_text(path, page)


KINDS = {".svg": "svg+xml"}
"""What a browser calls a picture whose suffix it does not go by."""


def embedded(file: Path) -> str:
    """A file as text inside a page."""
    return base64.b64encode(file.read_bytes()).decode("ascii")


def toml(data: Mapping[str, Mapping[str, Any]]) -> str:
    """A scene as it would stand in a file."""
    lines = []
    for part, table in data.items():
        if table:
            lines += [
                f"[{part}]",
                *(f"{key} = {_value(value)}" for key, value in table.items()),
                "",
            ]
    return "\n".join(lines).rstrip()


def _value(value: Any) -> str:
    """As TOML writes it; what is a string or a truth is written as in JSON."""
    return json.dumps(value) if isinstance(value, (str, bool)) else repr(value)
