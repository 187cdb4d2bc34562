"""The rigid hoop: scenes, and their motion phase by phase.

A :class:`Scene` goes in, a :class:`Motion` comes out::

    from rigid import simulate

    motion = simulate("paper-3.1")
    motion.phases, motion.turns, motion.pulses, motion.at([0.0, 1.0])
    motion.plot(), motion.pulses[0].plot(over="phi"), motion.to_dataframe()

``scene``      what a user describes; the constants (3), (6), (9) of a hoop; ``elastic`` the flexible solver's parts,
               ``allowed`` what is refused, in a sentence
``scenefile``  TOML to scene and back, the paper's scenes by name
``motion``     the vocabulary that both solvers speak
``solve``      one scene to its motion; ``sampler`` any instant of it; ``thresholds`` where rolling ends
``batch``      many scenes at once
``lists``      the records of a run as phases, turns and pulses
``phases``     the mechanics of each kind of phase, which one is next, and any instant of them
``output``     a motion as curves, as a table, in a few lines, in a file
``record``     what a phase leaves behind; phases, turns, pulses and states as values; the measures of a pulse
``kernel``     what phases are computed with, and why all of this runs both interpreted and compiled

What is imported from here is for everyone, and the other packages take it from here too. What is no user's business
they take from its own module: the ``kernel`` that flexible is compiled with, units, files and texts from ``output``,
single names from ``allowed``, ``elastic``, ``scenefile``, ``solve``, ``lists`` and ``phases``. The theory, with the
choices that Coulomb's law leaves open, is README.md beside this file.
"""

from typing import TYPE_CHECKING

from .allowed import SceneError
from .batch import Batch, simulate_batch
from .elastic import Contact, Ring, Solve
from .motion import Motion
from .output.file import MotionFileError
from .record.values import Kind, Phase, Pulse, Side, States, Turn
from .scene import Friction, Hoop, Landing, Release, Run, Scene
from .scenefile import SceneLike, as_scene, load_scene, scene_from_dict, scene_names, scene_to_dict
from .solve import Aloft, load_motion, simulate

if TYPE_CHECKING:
    __version__: str
    from .thresholds import inception_mu_s, rolling_k, rolling_mu_s


def __getattr__(name: str) -> object:
    """Thresholds on demand: they need scipy, which a motion does not. The version too."""
    if name == "__version__":
        from .output.file import version

        return version()
    if name in ("inception_mu_s", "rolling_k", "rolling_mu_s"):
        from . import thresholds

        return getattr(thresholds, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "Aloft",
    "Batch",
    "Contact",
    "Friction",
    "Hoop",
    "Kind",
    "Landing",
    "Motion",
    "MotionFileError",
    "Phase",
    "Pulse",
    "Release",
    "Ring",
    "Run",
    "Scene",
    "SceneError",
    "SceneLike",
    "Side",
    "Solve",
    "States",
    "Turn",
    "__version__",
    "as_scene",
    "inception_mu_s",
    "load_motion",
    "load_scene",
    "rolling_k",
    "rolling_mu_s",
    "scene_from_dict",
    "scene_names",
    "scene_to_dict",
    "simulate",
    "simulate_batch",
]
