"""What the pages of all studies share."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from pathlib import Path
from typing import Any

PAGE_STYLE = """\
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #222; background: #fff; max-width: 66rem; margin: 2rem
auto; padding: 0 1.2rem; } h1 { font-size: 1.6rem; line-height: 1.25; margin-bottom: .3rem; } h2 { font-size:
1.15rem; margin-top: 2.2rem; } .lead { font-size: 1.05rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .8rem; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .5rem; text-align: right; border-bottom: 1px solid #e4e4e4; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid #999; vertical-align: bottom; }
tr.rigid td { border-top: 2px solid #999; font-weight: 600; }
td.bad { color: #a33; text-align: left; white-space: normal; }
figure { margin: 1.2rem 0 2rem; } figure img { max-width: 100%; height: auto; }
figcaption { color: #555; font-size: .9rem; max-width: 46rem; }
code, pre { font: .85rem/1.45 ui-monospace, monospace; background: #f5f5f3; } pre { padding: .7rem 1rem;
overflow-x: auto; } code { padding: .1rem .3rem; }
footer { color: #666; font-size: .85rem; margin-top: 3rem; border-top: 1px solid #ddd; padding-top: .8rem; }
"""
"""Their looks, as CSS."""


def embedded(file: Path) -> str:
    """A picture as text inside a page."""
    return base64.b64encode(file.read_bytes()).decode("ascii")


def toml(data: Mapping[str, Mapping[str, Any]]) -> str:
    """A scene as it would stand in a file."""
    lines = []
    for part, table in data.items():
        if table:
            lines += [
                f"[{part}]",
                *(f'{k} = "{v}"' if isinstance(v, str) else f"{k} = {v!r}" for k, v in table.items()),
                "",
            ]
    return "\n".join(lines).rstrip()
