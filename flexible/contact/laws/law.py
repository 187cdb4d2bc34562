"""What the rest of the program may ask of a friction law."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, ClassVar, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from rigid import Friction, Kind

from ..points.data import Bristles, Parameters, Rates, Resultants

Array = NDArray[np.float64]


class PatchState(Protocol):
    """The patch at an instant of the march."""

    @property
    def mode(self) -> int:
        """What the patch does, of the modes that its law knows."""

    @property
    def slip_velocity(self) -> float:
        """Of the patch as a whole, along the floor, sqrt(g R)."""

    @property
    def rates(self) -> Rates:
        """How it changes."""

    @property
    def res(self) -> Resultants:
        """Its forces and energies."""


class Rolling(NamedTuple):
    """The pose of a rolling hoop whose flexible motion begins."""

    phi: float
    omega: float
    relaxation: float  # the damper's time


class Law:
    """A friction law with the parameters of a scene.

    As it stands here, a law of one mode, without a stick that could break, whose limit has mu_s = mu.

    Attributes
    ----------
    name : str
        In a scene.
    code : int
        In compiled code, one for each law.
    points : int
        To a patch under the weight, for ``rtol`` = 1e-3; a friction that ends inside the patch wants more.
    points_of_soft : int
        The same on a ring whose sections turn far: the fewer bristles, the more of the friction breaks with one.
    steps_of_soft : float
        Share of a step's tolerance there, where N's peak and the instants of events hang on the ring's vibrations.
    rolls_to : float
        Share of mu N up to which a rolling patch is that of the rigid hoop; from there on it creeps its own way.
    lost_when_soft : bool
        Whether a march on a soft ring may be lost where the contact is damped.
    tractions : compiled function
        ``tractions(forces, points, foundation, carried, mode, load, slip, parameters) -> Tractions``: fills in the
        ``forces``, zero before (:class:`~flexible.contact.points.data.PointForces`), that pull at
        ``points`` (:class:`~flexible.contact.points.detection.Points`) pressed by ``foundation``, with bristles
        ``carried`` to the end of the step; stretches and directions of the bristles are brought up to date in place.
        See :mod:`flexible.contact.points.data` for the rest.
    """

    name: ClassVar[str]
    code: ClassVar[int]
    points: ClassVar[int] = 8
    points_of_soft: ClassVar[int] = 8
    steps_of_soft: ClassVar[float] = 1.0
    rolls_to: ClassVar[float] = 1.0
    lost_when_soft: ClassVar[bool] = False
    tractions: ClassVar[Callable[..., Any]]

    def __init__(self, parameters: Parameters) -> None:
        self.parameters = parameters

    # modes

    def start(self, kind: Kind) -> int:
        """The mode in which the patch begins out of a rigid phase."""
        return 0

    def rolls(self, state: PatchState, omega: float, share: float) -> bool:
        """Whether the hoop rolls, of which N and F of a rigid one that rolled so would have the ratio ``share``."""
        return state.res.stuck > 0

    # what is stored

    def rolled_in(self, bristles: Bristles, res: Resultants, pose: Rolling) -> tuple[Bristles, float]:
        """Bristles of a patch in steady rolling under its friction, and the creep velocity that it has."""
        return bristles, 0.0

    def slid_in(self, bristles: Bristles, res: Resultants) -> Bristles:
        """Bristles of a patch that has been sliding under its friction."""
        return bristles

    # along the patch, for output

    def pulls(self, state: PatchState, stretch: Array, pressure: Array) -> Array:
        """Tangential force per length at points with elastic ``pressure``; ``stretch`` is nan where none is stored."""
        res = state.res
        return res.friction * pressure / res.elastic if res.elastic > 0 else 0 * pressure

    def slipping(self, state: PatchState, sliding: Array) -> NDArray[np.bool_]:
        """Which points slip; ``sliding`` is what is stored of them."""
        return np.full(len(sliding), state.res.stuck == 0)

    # the limit

    @classmethod
    def static_coefficient(cls, friction: Friction) -> float:
        """mu_s of the rigid hoop that a hoop with this law becomes as its stiffness grows."""
        return friction.mu

    @classmethod
    def breaks_by_points(cls, friction: Friction) -> bool:
        """Whether points break one at a time, so that what a step misses of it is a matter of chance."""
        return False

    @classmethod
    def explanation(cls, friction: Friction) -> str:
        """A sentence that says which rigid hoop that is."""
        raise NotImplementedError

    @classmethod
    def rolls_below(cls, contact: Any) -> float:
        """Slip velocity below which a patch that stores nothing is called rolling, over sqrt(g R); 0 if it stores."""
        return 0.0

    @classmethod
    def stiffened(cls, contact: Any, factor: float) -> dict[str, float]:
        """Other keys of a scene's contact that go with a foundation ``factor`` times as stiff, towards that limit."""
        return {}
