"""What is compared, swept, drawn and reported, and the command line::

    from studies import Ladder, stiffness_study

    study = stiffness_study("paper-3.3-massless", Ladder("both", low=1e7, high=1e13, count=7))
    study.limits["impulse_ratio"], study.rungs, study.plot(), study.to_dataframe()

``stiffness``  the flexible hoop against the rigid one as stiffness grows: ladder, rates, limit, figures, page
``limit``      that limit solved, from the inner problems (``inner``) of the rigid hoop's events
``atlas``      a map of a million rigid hoops over two quantities
``hop``        the paper's footnote: which hoops, released at rest, leave the floor, and where
``sweep``      the product of scene keys over processes or a Dask cluster, ``sweepfile`` as a TOML file says it
``paper``      every number and figure of the paper again
``validate``   published and provable results beside what the solvers find
``bench``      run time against error;  ``stress``  thousands of scenes and what must hold of them
``machine``    processes side by side, and what is compiled for them
``running``    scenes through solvers, in processes, kept in a folder, whatever the study
``plots``      what all figures share
``examples``   a short program for each use;  ``notebooks``  three with their output
``readme``     the README's pictures and numbers made again;  ``site``  docstrings and theory as a static site
``cli``        ``hoop ...``

Everything here is loaded when it is asked for. Of another package a module takes what its face has from the face; a
name that the face has not, because it would make it heavy or is no user's business, comes from its own module.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    __version__: str

    from .atlas.study import Atlas, atlas_of
    from .hop.rolling.asked import HopMap
    from .hop.study import HopStudy, hop_study
    from .limit.study import LimitStudy, limit_study
    from .running.files import StudyError
    from .running.measures import MEASURES, Measure, Unit, measure, measures
    from .running.workers import pool
    from .stiffness.extrapolation.limits import Limit, limit_of
    from .stiffness.found import StiffnessStudy
    from .stiffness.ladder import Ladder
    from .stiffness.rung import Rung
    from .stiffness.study import stiffness_study
    from .sweep import Table, run_sweep
    from .sweepfile import Sweep, load_sweep, sweep_from_dict

_HOMES = {
    "Atlas": "atlas.study",
    "atlas_of": "atlas.study",
    "HopMap": "hop.rolling.asked",
    "HopStudy": "hop.study",
    "hop_study": "hop.study",
    "LimitStudy": "limit.study",
    "limit_study": "limit.study",
    "MEASURES": "running.measures",
    "Ladder": "stiffness.ladder",
    "Limit": "stiffness.extrapolation.limits",
    "Measure": "running.measures",
    "Rung": "stiffness.rung",
    "StiffnessStudy": "stiffness.found",
    "StudyError": "running.files",
    "Sweep": "sweepfile",
    "Table": "sweep",
    "Unit": "running.measures",
    "limit_of": "stiffness.extrapolation.limits",
    "load_sweep": "sweepfile",
    "measure": "running.measures",
    "measures": "running.measures",
    "pool": "running.workers",
    "run_sweep": "sweep",
    "stiffness_study": "stiffness.study",
    "sweep_from_dict": "sweepfile",
}


def __getattr__(name: str) -> object:
    """What a study needs (pandas, matplotlib, a solver) is loaded with it and not before."""
    if name == "__version__":
        import rigid

        return rigid.__version__
    if name in _HOMES:
        return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "MEASURES",
    "Atlas",
    "HopMap",
    "HopStudy",
    "Ladder",
    "Limit",
    "LimitStudy",
    "Measure",
    "Rung",
    "StiffnessStudy",
    "StudyError",
    "Sweep",
    "Table",
    "Unit",
    "__version__",
    "atlas_of",
    "hop_study",
    "limit_of",
    "limit_study",
    "load_sweep",
    "measure",
    "measures",
    "pool",
    "run_sweep",
    "stiffness_study",
    "sweep_from_dict",
]
