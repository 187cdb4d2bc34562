"""What became of many scenes, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..lists import phases_of
from ..output import summary
from ..phases.reasons import reason
from ..record.values import Array, Kind

if TYPE_CHECKING:
    import pandas

PULSE_MEASURES = (
    "normal_impulse", "friction_impulse", "friction_loss", "peak_normal_force",
    "newton_restitution", "poisson_restitution", "energetic_restitution",
)  # fmt: skip


@dataclass(frozen=True, repr=False)
class Batch(summary.Summarised):
    """What became of ``n`` scenes, in the paper's units (R, m, g); what a scene does not have is NaN.

    Attributes
    ----------
    code : (n,) array of int
        Why each motion ended; :meth:`ended` says it in words.
    t_end : (n,) array
        When.
    phase_count, turn_count, pulse_count : (n,) array of int
        Of the whole run, however many are kept; phases as they were entered: one that lasts no time counts too.
    hop_count, jam_count : (n,) array of int
        Flights that ended on the floor; impacts without a collision.
    turn_t, turn_phi, turn_slip_velocity, turn_energy : (n, turns) array
        Turns as in :class:`rigid.Turn`: as many as were asked for, two where the run is to a time or an event.
    t_start, t_stop, phi_start, phi_stop : (n, pulses) array
        Pulses, as many as were to be kept: when and at which angles each begins and ends.
    normal_impulse, friction_impulse, friction_loss, peak_normal_force : (n, pulses) array
        As in :class:`rigid.Pulse`.
    newton_restitution, poisson_restitution, energetic_restitution : (n, pulses) array
        As there.
    cut : (n, pulses) array
        1 for a pulse in which the run begins or ends, 0 for a whole one.
    sequence : (n, pulses) array
        What the contact does in each pulse, as a number; :meth:`phases` says it in words.
    """

    code: NDArray[np.int64]
    t_end: Array
    phase_count: NDArray[np.int64]
    turn_count: NDArray[np.int64]
    pulse_count: NDArray[np.int64]
    hop_count: NDArray[np.int64]
    jam_count: NDArray[np.int64]
    turn_t: Array
    turn_phi: Array
    turn_slip_velocity: Array
    turn_energy: Array
    t_start: Array
    t_stop: Array
    phi_start: Array
    phi_stop: Array
    normal_impulse: Array
    friction_impulse: Array
    friction_loss: Array
    peak_normal_force: Array
    newton_restitution: Array
    poisson_restitution: Array
    energetic_restitution: Array
    cut: Array
    sequence: Array

    def __len__(self) -> int:
        return len(self.code)

    @property
    def impulse_ratio(self) -> Array:
        """J_F/J_N of each pulse, (n, pulses)."""
        return self.friction_impulse / self.normal_impulse

    def ended(self, scene: int) -> str:
        """In words, why a motion ended."""
        return reason(int(self.code[scene]))

    def to_dataframe(self) -> pandas.DataFrame:
        """A row for each pulse of each scene, indexed by both: the pulse's measures, and how the scene's motion ended.

        A scene without a pulse has one row, of pulse 0, whose measures are NaN.
        """
        from ..output.frame import pulses_of_scenes

        measures = ("t_start", "t_stop", "phi_start", "phi_stop", *PULSE_MEASURES, "impulse_ratio", "cut")
        scenes = {name: getattr(self, name) for name in ("phase_count", "turn_count", "pulse_count", "t_end")}
        scenes["ended"] = [reason(int(code)) for code in self.code]
        table = pulses_of_scenes({name: getattr(self, name) for name in measures}, scenes)
        table["cut"] = table["cut"] == 1
        return table

    def phases(self, scene: int, pulse: int = 0) -> tuple[Kind, ...]:
        """What the contact does in a pulse of a scene, in its order; nothing where no such pulse is kept."""
        return phases_of(self.sequence[scene, pulse]) if 0 <= pulse < self.sequence.shape[1] else ()

    def _title(self) -> str:
        return f"Batch of {len(self)} scenes"

    def _lines(self) -> list[summary.Line]:
        ends = zip(*np.unique(self.code, return_counts=True), strict=True)
        told = [("ended", f"{n}: {reason(int(code))}") for code, n in ends]
        first = self.impulse_ratio[:, :1][np.isfinite(self.impulse_ratio[:, :1])]
        if first.size:
            told.append(("J_F/J_N", f"{first.min():.6g} to {first.max():.6g} in the first pulse"))
        return told

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Batch):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name), equal_nan=True) for f in fields(self))
