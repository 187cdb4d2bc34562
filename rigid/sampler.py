"""Any instant of a motion, from what its run left: its lists, states between its records, impulses through a pulse."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from math import inf, pi
from typing import Any, NamedTuple
from weakref import ref

import numpy as np
from numpy.typing import NDArray

from .kernel import layout as at
from .kernel.compile import compiled, patience
from .kernel.spectral import workspace
from .lists import Listing
from .motion import Motion
from .output.file import Stored
from .output.units import in_units, without_units
from .phases import instant
from .record.values import Array, Pulse, Side, States
from .scene import Scene, is_point_mass

UNTIL_CODES = {None: at.NOTHING, "pulse": at.FIRST_PULSE, "rest": at.REST}


def parameters(scene: Scene) -> list[float]:
    """The constants of a motion, R = g = M = 1 (see :mod:`rigid.kernel.layout`)."""
    hoop, run = scene.hoop, scene.run
    constants = hoop.constants
    e, one_minus_e, gyr, zeta = constants.e, constants.one_minus_e, constants.K, constants.zeta
    if is_point_mass(constants):
        e, one_minus_e, gyr, zeta = 1.0, 0.0, 0.0, 0.0
    turns = inf if run.turns is None else float(run.turns)
    t_end = without_units(run, scene).t_end
    friction = scene.friction
    bounce = scene.landing.restitution
    return [
        e, one_minus_e, gyr, zeta, friction.mu_s, friction.mu, bounce, turns,
        inf if t_end is None else t_end, float(UNTIL_CODES[run.until]),
    ]  # fmt: skip


class Log(NamedTuple):
    """What a run leaves: all of its motion follows."""

    code: int  # why it ended
    records: Array  # (n, WIDTH)
    final: list[float]  # the state at its end


@dataclass(frozen=True, eq=False)
class Sampler:
    """Lists a motion and evaluates it at given times, from what its run left; a plain value."""

    scene: Scene
    log: Log

    @cached_property
    def listing(self) -> Listing:
        """Phases, turns and pulses."""
        _, records, final = self.log
        # a reference that does not count: in a circle of them every motion would wait for the garbage collector
        return Listing(records.tolist(), [float(at.END), *final[: at.MOVING]], self.scene, ref(self))

    @cached_property
    def _flat(self) -> list[float]:
        """The starts of all phases and the end, one after the other, ``WIDTH`` numbers each."""
        return [number for row in self.listing.starts for number in (*row, *[0.0] * (at.WIDTH - len(row)))]

    @cached_property
    def _table(self) -> Array:
        """The same as an array."""
        return np.array(self._flat)

    def __getstate__(self) -> dict[str, Any]:
        return {"scene": self.scene, "log": self.log}

    def stored(self, motion: Motion) -> Stored:
        """What a file keeps of the motion."""
        code, records, final = self.log
        return Stored("rigid", {"code": code}, {"records": records, "final": np.array(final)})

    def __call__(self, t: Array, side: Side) -> States:
        """States at times of any shape, in the units of the scene."""
        scene = self.scene
        order = np.argsort(t, axis=None, kind="stable")
        told = t.ravel()[order]
        starts = self._table[1 + at.T :: at.WIDTH][:-1]
        # compared as the phases state their times: a division could put an instant on the wrong side of a boundary
        owner = np.searchsorted(starts * scene.time_unit, told, side) - 1
        once, again = told / scene.time_unit, np.zeros(len(told))
        fold = self.listing.fold
        if fold is not None:
            once, again = fold.back(once)
            owner = np.where(again > 0, np.searchsorted(starts, once, side) - 1, owner)
        owner = np.maximum(owner, 0)
        once = np.maximum(once, starts[owner])
        within = np.argsort(once, kind="stable")
        rows = np.empty((len(told), instant.COLUMNS))
        rows[within] = self._rows(once[within], owner[within], side)
        if fold is not None:
            rows[:, 0] += again * 2 * pi * fold.whole
            rows[:, 2] += again * fold.way
        table = np.empty_like(rows)
        table[order] = rows
        columns = [column.reshape(t.shape) for column in table.T]
        phi, omega, x, gap, slip, normal, friction, energy, alpha = columns
        mass = 1 + scene.hoop.mass_ratio
        found = States(t, phi, omega, alpha, x, 1 + gap, slip, normal * mass, friction * mass, energy * mass)
        return replace(in_units(found, scene), t=t)  # to the last bit as asked for

    def impulses(self, pulse: Pulse, t: Array) -> tuple[Array, Array]:
        """Normal and friction impulse since a pulse began, from the momentum of the mass centre.

        No quadrature: dJ_N = M (dydot_G + g dt) and dJ_F = M dxdot_G, over an impact inside the pulse (a jam) as
        anywhere. The hoop is on the floor throughout, for a flight ends a pulse; so ydot_G is that of the rotation.

        Parameters
        ----------
        pulse : Pulse
            Of this motion.
        t : (n,) array
            Times from the pulse's start to its end, both among them.

        Returns
        -------
        two (n,) arrays
            The last of each is the pulse's own.
        """
        scene, states = self.scene, without_units(self(t, "right"), self.scene)
        e, unit = scene.hoop.e, (1 + scene.hoop.mass_ratio) * scene.impulse_unit
        along = states.slip_velocity + states.omega * (1 + e * np.cos(states.phi))
        up = states.t - e * np.sin(states.phi) * states.omega
        normal = np.maximum.accumulate(unit * (up - up[0]))  # it never falls, but in its last digits
        friction = unit * (along - along[0])
        normal[-1], friction[-1] = pulse.normal_impulse, pulse.friction_impulse
        return normal, friction

    def _rows(self, times: Array, owner: NDArray[np.int64], side: Side) -> Array:
        """A row of the kernel's columns for each time, in the phase of the number ``owner``."""
        width, flat = instant.COLUMNS, self._flat
        if side == "left" and len(flat) == 2 * at.WIDTH:
            # of a release in a jam that turns the hoop and so ends the motion: what was before the blow
            flat = [*flat[: at.WIDTH], float(at.CHOOSE), *flat[at.WIDTH + 1 :]]
        constants = parameters(self.scene)
        if patience.left(len(times)) > 0:
            patience.spend(instants=len(times))
            out: Any = [0.0] * (len(times) * width)
            work: Any = workspace()[0]
            state = [0.0] * at.STATE
            instant.entry_sample(constants, flat, owner.tolist(), times.tolist(), out, work, state)
            return np.array(out, dtype=float).reshape(len(times), width)
        out = np.zeros(len(times) * width)
        work = np.zeros((at.SERIES, at.ORDER + 1))
        table = self._table if flat is self._flat else np.array(flat)
        compiled()["entry_sample"](np.array(constants), table, owner, times, out, work, np.zeros(at.STATE))
        return out.reshape(len(times), width)
