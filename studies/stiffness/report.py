"""A study as one page: report.html, which needs no network and no file beside it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from rigid import scene_to_dict

from ..plots.page import PAGE_STYLE, embedded, toml
from ..running.files import write_text
from ..running.solvers import versions
from .page import CAPTIONS, PAGE
from .summary import (
    LIMIT_HEADING,
    case_cells,
    case_heading,
    damping_sentence,
    extrapolation_sentence,
    law_sentence,
    limit_rows,
    prediction_sentence,
    rigid_cells,
    side_heading,
    side_rows,
    verdict,
)

if TYPE_CHECKING:
    from .study import StiffnessStudy


def stiffness_report(study: StiffnessStudy, images: Mapping[str, Path], command: str, path: Path) -> Path:
    """Write the page of a stiffness study.

    Parameters
    ----------
    study : StiffnessStudy
        What is told.
    images : dict of str to Path
        Figures by name, PNG files that are copied into the page.
    command : str
        The command that made it.
    path : Path
        The page; written whole or not at all.
    """
    from jinja2 import Environment
    from markupsafe import Markup

    scene = study.scene
    hoop = f"k = {scene.hoop.k:g}, r = {scene.hoop.r:g}, m_h/m = {scene.hoop.mass_ratio:g}"
    slow = [rung for rung in study.rungs if not rung.outcome.failure and not rung.outcome.resolved]
    page = (
        Environment(autoescape=True, trim_blocks=True)
        .from_string(PAGE)
        .render(
            style=Markup(PAGE_STYLE),
            title=f"The flexible hoop as stiffness grows: {hoop}",
            verdict=verdict(study),
            limits=limit_rows(study),
            along=study.ladder.label,
            extrapolation=extrapolation_sentence(study),
            law=law_sentence(study),
            damping=damping_sentence(study),
            prediction=prediction_sentence(study),
            figures=[(name, CAPTIONS.get(name, name), embedded(file)) for name, file in images.items()],
            heading=case_heading(study),
            limit_heading=LIMIT_HEADING,
            cases=[{"cells": case_cells(rung), "failure": rung.outcome.failure} for rung in study.rungs],
            rigid=rigid_cells(study),
            unresolved=f" Not reached at {len(slow)} of the cases, marked *." if slow else "",
            side_heading=side_heading(study),
            side=side_rows(study),
            scene=toml(scene_to_dict(scene)),
            command=command,
            versions=", ".join(f"{package} {number}" for package, number in versions().items()),
        )
    )
    return write_text(path, page)
