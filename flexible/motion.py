"""What the flexible solver adds to the common vocabulary: what happens inside a pulse, and where the energy went."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from dataclasses import dataclass
from math import nan
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rigid import Motion, Phase, Pulse, Scene, Side, States
from rigid.output import summary
from rigid.output.same import Same
from rigid.output.units import (
    AngularAcceleration,
    AngularVelocity,
    Energy,
    Force,
    Impulse,
    Length,
    Number,
    Time,
    Velocity,
    unit_names,
)

if TYPE_CHECKING:
    import pandas

    from .models.select import Hoop
    from .models.state import State
    from .time.course import Marched

Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Ledger:
    """Where the energy went, in the scene's unit of energy: ``initial`` is the sum of all the others.

    Each of them but the last is found by itself. Held at the end: ``kinetic``, ``gravity``, ``ring_strain``,
    ``contact_spring``. Lost on the way: ``friction_loss``, the work of friction (with what bristles keep when they
    leave the patch stretched), ``damping_loss``, that of the contact's damper, and ``landing_loss``, of landings of the
    rigid hoop between pulses, and of the blow by which it may be stopped at its release. ``numerical_loss`` is what the
    integrator's error takes (gives, where negative), step by step from the work of the floor on frame and ring; it
    tends to zero with ``solve.rtol``, about in proportion, and like the root of the steps' length where a ring lands
    and rings faster than they follow.
    ``hand_over`` is what went out (came in, where negative) where the rigid hoop was replaced by a flexible one,
    sagged and with a patch, and where it was put back: it tends to zero with growing stiffness, but for a hoop with
    mass and without thickness (README.md, section 1). ``residual`` is all that the others leave unexplained: the
    work of a patch's points beyond that of the patch as a whole, which is summed by trapezoids over the steps, and
    falls like the square of their length, rtol^(2/3): a hundredth of ``solve.rtol`` of the initial energy, or less,
    down to 1e-5 in thin walls that are not soft, but up to 0.4 of it in thick soft ones, and some times
    ``solve.rtol`` in hoops that land in a pulse (README.md, section 4). It is a limit of the books, and no part of
    the motion.
    """

    initial: Energy[float]
    kinetic: Energy[float]
    gravity: Energy[float]
    ring_strain: Energy[float]
    contact_spring: Energy[float]
    friction_loss: Energy[float]
    landing_loss: Energy[float]
    damping_loss: Energy[float]
    hand_over: Energy[float]
    numerical_loss: Energy[float]
    residual: Energy[float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class FlexiblePulse(Pulse):
    """A pulse as the flexible hoop goes through it, over the phi-interval of the rigid pulse.

    What every pulse has is said at :class:`rigid.Pulse`. One that a soft wall throws back leaves that interval where it
    came in.
    ``time_off_floor`` is the time without contact (hopping, the paper's footnote 1); the energy peaks are those of
    the ring's strain and of the contact's springs; ``phases`` is what the patch does inside.
    """

    time_off_floor: Time[float]
    ring_energy_peak: Energy[float]
    contact_energy_peak: Energy[float]
    damping_loss: Energy[float]
    numerical_loss: Energy[float]
    phases: tuple[Phase, ...]

    def _lines(self) -> list[summary.Line]:
        energy = summary.unit_in(self, "friction_loss")
        return [
            *Pulse._lines(self),
            ("other losses", f"damper {self.damping_loss:.3g}, integrator {self.numerical_loss:.3g}{energy}"),
            ("peaks", f"ring strain {self.ring_energy_peak:.6g}, contact {self.contact_energy_peak:.6g}{energy}"),
            ("off the floor", f"{self.time_off_floor:.6g}{summary.unit_in(self, 'time_off_floor')}"),
            ("phases", summary.some([str(phase.kind) for phase in self.phases])),
        ]

    def to_dict(self) -> dict[str, Any]:
        """All measures by name, the ratio among them, and the phases inside."""
        return Pulse.to_dict(self) | {"phases": [dataclasses.asdict(phase) for phase in self.phases]}

    def marked_cut(self) -> FlexiblePulse:
        """The same as one in which the run begins or ends: it has no restitution."""
        return dataclasses.replace(
            self, cut=True, newton_restitution=nan, poisson_restitution=nan, energetic_restitution=nan
        )


@dataclass(frozen=True, slots=True, repr=False, eq=False)
class History(Same):
    """Every accepted step of the flexible segments, as arrays over time; stored only when asked for.

    Names that :class:`rigid.States` has too mean the same. ``patch_length`` is that of the rim which presses on the
    floor, ``stick_fraction`` the part of it that sticks, 0 to 1; energies are those of :class:`Ledger`.
    Losses and impulses are running ``TOTALS`` over these segments: what the rigid hoop between them loses, and the
    floor gives it, is not among them.
    """

    TOTALS: ClassVar = ("normal_impulse", "friction_impulse", "friction_loss", "damping_loss", "numerical_loss")

    t: Time[Array]
    phi: Number[Array]
    omega: AngularVelocity[Array]
    alpha: AngularAcceleration[Array]
    x_C: Length[Array]
    y_C: Length[Array]
    slip_velocity: Velocity[Array]  # mean of the patch, by pressure, against the floor; off it the lowest node's
    vertical_velocity: Velocity[Array]  # of the hoop's centre C, upward
    normal_force: Force[Array]
    friction_force: Force[Array]
    patch_length: Length[Array]
    stick_fraction: Number[Array]
    kinetic: Energy[Array]
    gravity: Energy[Array]
    ring_strain: Energy[Array]
    contact_spring: Energy[Array]
    friction_loss: Energy[Array]
    damping_loss: Energy[Array]
    numerical_loss: Energy[Array]
    normal_impulse: Impulse[Array]
    friction_impulse: Impulse[Array]

    def __repr__(self) -> str:
        return f"History({len(self.t)} steps)"

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each step, in the units of :attr:`FlexibleMotion.units`."""
        import pandas

        return pandas.DataFrame({entry.name: getattr(self, entry.name) for entry in dataclasses.fields(self)})


@dataclass(frozen=True, slots=True, eq=False)
class Kept:
    """States of the ring at every accepted step of one flexible segment, in the solver's units (R = m = g = 1)."""

    hoop: Hoop
    states: tuple[State, ...]

    def __repr__(self) -> str:
        return f"Kept({len(self.states)} states)"

    def __reduce__(self) -> tuple[Any, ...]:
        """A copy, in this process or another, has a hoop of its own, since a factored matrix cannot be copied."""
        return _kept, (self.hoop.scene, self.states)


def _kept(scene: Scene, states: tuple[State, ...]) -> Kept:
    from .models.select import hoop_of

    return Kept(hoop_of(scene), states)


class March(NamedTuple):
    """A march of one flexible segment, as far as it went, to be taken up again."""

    marched: Marched
    turned: tuple[tuple[float, float, float], ...]  # see :class:`flexible.models.select.Range`


@dataclass(frozen=True, kw_only=True, repr=False)
class FlexibleMotion(Motion):
    """The motion of the flexible hoop: the common vocabulary, the energy ledger, the steps if they were asked for.

    Its period is that of the rigid hoop which, released from this one's state at the end, will roll for ever.
    With the steps come the states of the ring (``kept``, one per flexible segment), of which fields are made.
    ``marches`` is what :func:`flexible.simulate` goes on from. Two motions are equal if all but these three are, which
    are arrays that follow from the same steps. :meth:`to_dict` has it as plain values; ``dataclasses.asdict`` cannot
    copy the factored matrices of ``kept``.
    """

    if TYPE_CHECKING:  # the same field, of pulses that say more
        pulses: Sequence[FlexiblePulse]

    ledger: Ledger
    steps: int
    history: History | None = dataclasses.field(default=None, compare=False)
    kept: tuple[Kept, ...] = dataclasses.field(default=(), compare=False)
    marches: tuple[March, ...] = dataclasses.field(default=(), compare=False)

    def at(self, t: ArrayLike, side: Side = "right") -> States:
        """State at times ``t`` (any shape): of the rigid hoop between flexible segments, of the steps inside them.

        Within a step the angle and ``y_C`` are cubics, as their rates are known, ``x_C`` is the way that rolls with
        that angle and what it slips, linear, and all else is linear, N, F and the slip velocity among it: F is that of
        the friction law at the steps alone, and of the ``regularised`` one no longer -mu N v/sqrt(v^2 + v_s^2) of the N
        and the v that are told with it.

        Parameters
        ----------
        t : array_like
            In the scene's unit of time.
        side : "right" or "left"
            At an instant of two steps, before and behind an event: which of them counts.

        Raises
        ------
        ValueError
            A time before release or after the end.
        """
        return Motion.at(self, t, side)

    def _lines(self) -> list[tuple[str, str]]:
        scene, books = self.scene, self.ledger
        lost = {"friction": books.friction_loss, "damper": books.damping_loss, "landings": books.landing_loss,
                "integrator": books.numerical_loss}  # fmt: skip
        lost |= {"hand-overs": books.hand_over} if books.hand_over else {}
        return [
            *Motion._lines(self),
            ("ring", f"E I/(m g R^2) = {scene.ring.bending_stiffness:g}, foundation {scene.contact.stiffness:g}, "
                     f"{scene.contact.law}, damping {scene.contact.damping:g}"),
            ("energy", f"{books.initial:.6g}"),
            ("lost to", ", ".join(f"{name} {value:.3g}" for name, value in lost.items())),
            ("steps", f"{self.steps}{', all kept' if self.history is not None else ''}"),
        ]  # fmt: skip

    @property
    def units(self) -> dict[str, str]:
        """What each number of this motion, its ledger and its history is measured in, by its name."""
        common = super().units
        return common | unit_names(self.scene, FlexiblePulse, Ledger, History) | {"steps": "1"}

    def to_dict(self) -> dict[str, Any]:
        """The common keys and ``energy_ledger``."""
        return {
            **Motion.to_dict(self),
            "energy_ledger": dataclasses.asdict(self.ledger),
            "steps": self.steps,
        }
