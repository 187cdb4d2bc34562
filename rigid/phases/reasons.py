"""Why a motion ends, in words."""

from __future__ import annotations

from ..kernel import layout as at
from .rolling.phase import LISTED_PERIODS

_REASONS = {
    at.TIME_REACHED: "the time to run is over",
    at.PULSE_OVER: "the first whole pulse is over",
    at.RESTS: "rests: nothing moves any more",
    at.SLIDES: "slides for ever: a smooth floor takes no energy",
    at.HITS_FLOOR: "the point mass hits the floor",
    at.CREEPS: "creeps up to the top and never gets there",
    at.SETTLES: "goes on all but for ever: in a hundred slips it lost less than a ten-thousandth of its energy",
    at.TURNS_REACHED: "the last turn asked for is reached",
    at.ROLLS: "rolls for ever: |F| < mu_s N over the whole swing",
    at.WHIRLS: "rolls for ever, over the top in every revolution, so there is no turn to wait for",
    at.ROLLS_ON: f"the time to run is over; it rolls for ever, of which {LISTED_PERIODS:g} periods are listed",
    at.WORK_BOUND: "the work bound is reached",
    at.LIFTED: "the point mass is too fast for the hoop and takes it off the floor",
}


def reason(code: int) -> str:
    """Why a motion ends, by the kernel's code."""
    return _REASONS[code]
