"""What a hop study is asked to roll, and the scene of each roll."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from rigid import Scene, SceneError, as_scene, scene_from_dict, scene_to_dict
from rigid.allowed import plain, require_whole, shown
from rigid.elastic import UNITS

from .roll import RTOL, from_rest, through_the_pulse

STIFFNESS = "ring.bending_stiffness"

DEFAULT = (0.5, 1e4, 24)
"""Range of the bending stiffness, and number of cases over it."""

SAID_ELSEWHERE = {
    STIFFNESS: "its range is the map's other axis",
    "solve.rtol": "the tolerance is --rtol",
    "solve.resolve": "a roll is flexible throughout",
    "solve.start": "a roll starts from equilibrium",
    "run": "how far to roll is --turns, or the scene's own",
}
"""Keys, and a table, that no second key can be of: a roll replaces what they say."""


class Ask(NamedTuple):
    """A roll that the study wants."""

    line: int
    stiffness: float
    rtol: float
    whole: bool
    """To the end, or only through the first pulse."""


@dataclass(frozen=True, slots=True)
class HopMap:
    """What a hop study rolls; ``scenes`` are made of it, one for each value of the second key, ready to roll.

    Parameters
    ----------
    scene : Scene, str, path or dict
        What is rolled at each bending stiffness, or what says so, as :func:`rigid.simulate` takes it.
    stiffness : sequence of float
        E I/(m g R^2), in any order, each once however often it is given; 24 from 0.5 to 1e4 by default.
    second : str or None
        A key more for a map, "hoop.k" for instance.
    values : sequence
        Its values, likewise.
    rtol : float
        Tolerance of the rolls.
    bisections : int
        How often the bracket of each threshold is halved; 0 is the map alone.
    level : str or None
        Of the ring; the scene's own by default.
    whole : bool
        Whether rolls of the map go on to their end where all is decided before.

    Raises
    ------
    SceneError
        A second key of which a roll replaces what it says or whose values are words, a value that no scene can have, no
        value at all, or ``bisections`` that are no whole number from 0 to 30.
    StudyError
        A hoop that is not released at rest, or stands still.
    """

    scene: Scene
    stiffness: tuple[float, ...] = tuple(np.geomspace(*DEFAULT).tolist())
    second: str | None = None
    values: tuple[Any, ...] = (None,)
    rtol: float = RTOL
    bisections: int = 4
    level: str | None = None
    whole: bool = False
    scenes: tuple[Scene, ...] = field(init=False)

    def __post_init__(self) -> None:
        if not (self.second is None or isinstance(self.second, str)):
            raise SceneError(f"second = {shown(self.second)} is not possible: it is the key that values vary, or None.")
        for key in (self.second, (self.second or "").partition(".")[0]):
            if key in SAID_ELSEWHERE:
                raise SceneError(f"{self.second} cannot be varied in a hop study: {SAID_ELSEWHERE[key]}.")
        scene = as_scene(self.scene)
        object.__setattr__(self, "scene", scene)
        object.__setattr__(self, "bisections", require_whole("bisections", self.bisections, 0, 30))
        for name in ("stiffness", "values"):
            given = getattr(self, name)
            row = np.ndim(given) > 0 if isinstance(given, np.ndarray) else isinstance(given, (list, tuple))
            if not row or len(given) == 0:
                raise SceneError(f"{name} = {shown(given)} is not possible: it lists what is rolled.")
        if self.second is None and tuple(self.values) != (None,):
            raise SceneError(f"values = {shown(self.values)} are of no key: second is the key that they vary.")
        if any(isinstance(value, str) for value in self.values):
            raise SceneError(
                f"{self.second} cannot be varied in a hop study: its values are words, and a map has numbers."
            )
        if self.second is not None:
            object.__setattr__(self, "values", tuple(plain(self.second, value) for value in self.values))
        rings = [scene.replace(ring={"bending_stiffness": value}).ring for value in self.stiffness]
        object.__setattr__(self, "stiffness", tuple(sorted({ring.bending_stiffness for ring in rings})))
        object.__setattr__(self, "values", tuple(sorted(set(self.values))))
        object.__setattr__(self, "scenes", tuple(self._scene(value) for value in self.values))

    def _scene(self, value: Any) -> Scene:
        solve: dict[str, Any] = {"rtol": self.rtol} | ({} if self.level is None else {"level": self.level})
        scene = self.scene.replace(solve=solve)
        if self.second is not None:
            data = scene_to_dict(scene)
            if scene.dimensionless:  # one of R, m, g alone would be in other units than the others
                data["hoop"] = {name: its for name, its in data["hoop"].items() if name not in UNITS}
            part, _, key = self.second.partition(".")
            table = data.setdefault(part, {})
            table[key] = value
            if key.endswith("_deg"):  # in radians beside, to the last bit
                table.pop(key.removesuffix("_deg"), None)
            scene = scene_from_dict(data)
        return from_rest(scene)

    def scene_of(self, ask: Ask) -> Scene:
        """The scene of a roll."""
        scene = self.scenes[ask.line] if ask.whole else through_the_pulse(self.scenes[ask.line])
        return scene.replace(ring={"bending_stiffness": ask.stiffness}, solve={"rtol": ask.rtol})

    @property
    def count(self) -> int:
        """Number of rolls of the map."""
        return len(self.stiffness) * len(self.values)
