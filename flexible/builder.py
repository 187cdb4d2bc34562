"""A motion put together from rigid and flexible pieces: phases, turns, pulses, and the ledger over all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rigid import Hoop, Kind, Motion, Phase, Scene, States, Turn
from rigid.output.units import in_units

from .models.select import Hoop as FlexibleHoop
from .models.select import Range
from .models.state import State, momentum
from .motion import FlexibleMotion, FlexiblePulse, Kept, Ledger, March
from .pieces import Piece, Sampler
from .segment import Segment, history_of
from .time.adaptive import LIMITS, Limits, march
from .time.course import Course, Marched, Stop, goes_past
from .time.events import Ends
from .time.methods import chosen

Array = NDArray[np.float64]


def _lost_in_landings(motion: Motion, until: float) -> float:
    """Energy that a rigid motion lost by then where it came down after a flight."""
    lost = 0.0
    for before, phase in pairwise(motion.phases):
        if phase.kind == Kind.IMPACT and before.kind in (Kind.FLIGHT, Kind.SKIM) and phase.t_start <= until:
            # nothing is lost off the floor
            energy = motion.at(np.array([(before.t_start + before.t_end) / 2, phase.t_end])).energy
            lost += float(energy[0] - energy[1])
    return lost


class Builder:
    """Collects the pieces of a motion, in the solver's units.

    Parameters
    ----------
    scene : Scene
    within : Range
        In which the hoop's model holds, told of all that is run.
    keeps : bool
        Whether the ring's states are kept.
    most_steps : int, optional
        Of all marches together.
    stop : callable, optional
        Asked every few steps; where it says so a march stops.
    earlier : FlexibleMotion, optional
        From which to go on.
    """

    def __init__(
        self,
        scene: Scene,
        within: Range,
        keeps: bool = False,
        most_steps: int | None = None,
        stop: Callable[[], bool] | None = None,
        earlier: FlexibleMotion | None = None,
    ) -> None:
        self.scene = scene
        self.hoop: Hoop = scene.hoop
        self.range = within
        self.kept: list[Kept] | None = [] if keeps else None
        self.most_steps = most_steps
        self.stop = stop
        self.earlier = earlier
        self.pieces: list[Piece] = []
        self.phases: list[Phase] = []
        self.turns: list[Turn] = []
        self.pulses: list[FlexiblePulse] = []
        self.steps = 0
        self.marches: list[March] = []
        self.t = 0.0
        self.x_C = 0.0
        self.initial: float | None = None
        self.hand_over = 0.0
        self.friction_loss = 0.0
        self.landing_loss = 0.0
        self.damping_loss = 0.0
        self.numerical_loss = 0.0
        self.residual = 0.0
        self.held: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)

    def _add_phase(self, phase: Phase) -> None:
        if phase.t_end <= phase.t_start and phase.kind != Kind.IMPACT:
            return
        if self.phases and self.phases[-1].kind == phase.kind != Kind.IMPACT:
            self.phases[-1] = replace(self.phases[-1], t_end=phase.t_end, phi_end=phase.phi_end)
        else:
            self.phases.append(phase)

    def lost_to_hand_overs(self, energy: float) -> float:
        """So far and to a piece that begins now with ``energy``: what differs from the end of the last one."""
        return self.hand_over + (0.0 if self.initial is None else sum(self.held) - energy)

    def _meet(self, energy: float) -> None:
        """Energy at the start of a piece."""
        self.hand_over = self.lost_to_hand_overs(energy)
        if self.initial is None:
            self.initial = energy

    def add_rigid(self, motion: Motion, until: float) -> States:
        """The first ``until`` of a rigid motion that begins now; its states at both ends."""
        ends, released = motion.at(np.array([0.0, until])), float(motion.at(0.0, "left").energy)
        if until <= 0 and self.pieces:
            return ends
        self._meet(released)
        blows = released - float(ends.energy[0]) + _lost_in_landings(motion, until)
        self.landing_loss += blows
        self.friction_loss += released - float(ends.energy[1]) - blows
        potential = float((1 + self.hoop.mass_ratio) * (ends.y_C[1] + self.hoop.e * np.cos(ends.phi[1])))
        self.held = (float(ends.energy[1]) - potential, potential, 0.0, 0.0)
        for phase in motion.phases:
            if phase.t_start < until or (phase.kind == Kind.IMPACT and phase.t_start == until):
                end = min(phase.t_end, until)
                phi_end = phase.phi_end if end == phase.t_end else float(ends.phi[1])
                self._add_phase(replace(phase, t_start=self.t + phase.t_start, t_end=self.t + end, phi_end=phi_end))
        self.turns += [replace(turn, t=self.t + turn.t) for turn in motion.turns if turn.t <= until]
        self.pieces.append(Piece(self.t, self.t + until, motion=motion, origin=self.t, x_C=self.x_C))
        self.x_C += float(ends.x_C[1])
        self.t += until
        return ends

    def _add_flexible(self, marched: Marched, rise: float) -> Segment:
        """A flexible segment that begins now, with the mass centre rising so fast."""
        records = marched.records
        segment = Segment(records, self.scene, rise)
        held = segment.held()
        self._meet(float(held[0]))
        last = records[-1]
        self.friction_loss += last.friction_loss
        self.damping_loss += last.damping_loss
        self.numerical_loss += last.numerical_loss
        lost = last.friction_loss + last.damping_loss + last.numerical_loss
        self.residual += float(held[0] - held[-1]) - lost
        self.held = (last.kinetic, last.gravity, last.ring_strain, last.contact_spring)
        for phase in segment.phases():
            self._add_phase(phase)
        self.turns += segment.turns()
        self.pieces.append(Piece(segment.t_start, segment.t_end, segment=segment))
        self.t, self.x_C = last.t, last.x_C
        self.steps += marched.attempts
        return segment

    def list_pulse(self, pulse: FlexiblePulse, cut: bool) -> None:
        """A pulse, if it is one: a hoop that flies over the floor all along has none."""
        if pulse.peak_normal_force > 0:  # an impulse is a difference of two totals, with their round-off
            self.pulses.append(pulse.marked_cut() if cut else pulse)

    def march(
        self, hoop: FlexibleHoop, state: State, ends: Ends, rtol: float, progress: Callable[[float, float], None] | None
    ) -> tuple[State, Segment, Stop | None]:
        """March, or go over a march of the earlier motion that this one goes on from; its last one is taken up.

        Returns
        -------
        state : State
            At the end.
        segment : Segment
        stop : Stop, optional
            Why it stopped early, if it did.
        """

        def watch(rows: Array) -> None:
            self.range(rows[:, 0], rows[:, -1], rows[:, 1])
            if progress is not None:
                for t, phi in rows[:, :2].tolist():
                    progress(t, phi)

        number, states = len(self.marches), list[State]()
        earlier, last = self._earlier(number, state, ends)
        if earlier is not None and self.kept is not None and self.earlier is not None:
            states = list(self.earlier.kept[number].states)
        if earlier is not None and not last:
            marched = earlier.marched
            self.range.records += earlier.turned
        else:
            most = LIMITS.most if self.most_steps is None else max(self.most_steps - self.steps, 1)
            limits = Limits(most=most, before=self.steps, stop=self.stop or LIMITS.stop)
            methods = chosen(self.scene.solve.integrator, rtol, hoop.vibrates)
            start: State | Course = state
            if earlier is not None:
                start = earlier.marched.course
                del states[start.length :]
                self.range.records += [turned for turned in earlier.turned if turned[0] <= start.now.state.t]
            keep = None if self.kept is None else states.append
            marched = march(hoop, start, ends, rtol, limits, watch, keep, methods)
        if self.kept is not None:
            self.kept.append(Kept(hoop, tuple(states)))
        first = marched.records[0].t
        self.marches.append(March(marched, tuple(turned for turned in self.range.records if turned[0] > first)))
        rise = momentum(hoop, state, np.eye(len(state.vel))[1]) / (1 + self.hoop.mass_ratio)
        return marched.state, self._add_flexible(marched, rise), marched.stop

    def _earlier(self, number: int, state: State, ends: Ends) -> tuple[March | None, bool]:
        """The march of that number in the motion to go on from, and whether it is to be taken up, as its last one, or
        one so near the end of its run, or of this one, that this may have cut the step in which it ends.

        One that went on where this run ends is none, nor is one to be taken up that begins elsewhere for that.
        """
        known = self.earlier.marches if self.earlier is not None else ()
        if self.earlier is None or number >= len(known):
            return None, False
        marched, t_end = known[number].marched, self.earlier.scene.to_dimensionless().run.t_end
        first, until = marched.records[0], min(t_end or np.inf, ends.t)
        last = number == len(known) - 1 or marched.state.t > until - LIMITS.longest
        began, now = (first.t, first.phi, first.omega), (state.t, state.pos[2], state.vel[2])
        if goes_past(marched, ends):
            return None, False
        if np.allclose(began, now, rtol=0 if last else 1e-6, atol=0 if last else 1e-6):  # machines differ in round-off
            return known[number], last
        if not last:
            raise ValueError("The motion to resume does not come from this scene.")
        return None, False

    def motion(
        self, scene: Scene, ended: str, completed: bool, history: bool, period: float | None = None
    ) -> FlexibleMotion:
        """The motion in the units of ``scene``; of one that will roll for ever, its period without them."""
        ledger = Ledger(
            self.initial or 0.0, *self.held, self.friction_loss, self.landing_loss, self.damping_loss, self.hand_over,
            self.numerical_loss, self.residual,
        )  # fmt: skip
        sample = Sampler(tuple(self.pieces), scene)
        return FlexibleMotion(
            scene=scene,
            phases=tuple(in_units(phase, scene) for phase in self.phases),
            turns=tuple(in_units(turn, scene) for turn in self.turns),
            pulses=tuple(replace(in_units(pulse, scene), sample=sample) for pulse in self.pulses),
            ended=ended,
            completed=completed,
            sample=sample,
            period=None if period is None else period * scene.time_unit,
            ledger=in_units(ledger, scene),
            steps=self.steps,
            history=in_units(history_of(piece.segment for piece in self.pieces), scene) if history else None,
            kept=tuple(self.kept or ()),
            marches=tuple(self.marches),
        )
