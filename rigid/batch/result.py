"""What became of many scenes, as arrays."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ..lists import phases_of
from ..motion import Array, Kind
from ..output import summary
from ..phases.reasons import reason

if TYPE_CHECKING:
    import pandas

PULSE_MEASURES = (
    "normal_impulse", "friction_impulse", "friction_loss", "peak_normal_force",
    "newton_restitution", "poisson_restitution", "energetic_restitution",
)  # fmt: skip


@dataclass(frozen=True, repr=False)
class Batch(summary.Summarised):
    """What became of ``n`` scenes, in the paper's units (R, m, g); ``turns`` and ``pulses`` below are the numbers of
    columns asked for; what a scene does not have is NaN.
    """

    code: NDArray[np.int64]
    """Why each motion ended, (n,); :meth:`ended` says it in words."""
    t_end: Array
    """When, (n,)."""
    phase_count: NDArray[np.int64]
    """Phases as they were entered, (n,): one that lasts no time counts too."""
    turn_count: NDArray[np.int64]
    pulse_count: NDArray[np.int64]
    hop_count: NDArray[np.int64]
    """Flights that ended on the floor, (n,)."""
    jam_count: NDArray[np.int64]
    """Impacts without a collision, (n,)."""
    turn_t: Array
    """Turns: time, angle, slip velocity, energy, each (n, turns)."""
    turn_phi: Array
    turn_slip_velocity: Array
    turn_energy: Array
    t_start: Array
    """Pulses: as in :class:`rigid.Pulse`, each (n, pulses)."""
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
    """1 for a pulse in which the run begins or ends, 0 for a whole one."""
    sequence: Array
    """What the contact does in each pulse, (n, pulses), as a number; :meth:`phases` says it in words."""

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
