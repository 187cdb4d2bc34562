"""Pulses that begin or end with an event: at that angle a compliant hoop is in the middle of its layer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from rigid import Run, Scene, as_scene, simulate
from studies.inner.events import START, Stretch, passage
from studies.inner.march.body import arms
from studies.inner.march.equations import FRICTION_IMPULSE, NORMAL_IMPULSE
from studies.limit.compliant import at_foundation, go_through, march_through
from studies.limit.prediction import CREEP, powers, predict

MEASURES = ("friction_impulse", "normal_impulse")


def at_infinity(of_foundation: Callable[[float], np.ndarray]) -> np.ndarray:
    """What distances over eps, at two foundations, make of it at infinity: the next power of eps falls out."""
    soft, stiff = of_foundation(1e10), of_foundation(1e12)
    share = 100 ** (-1 / 3)
    return (stiff - share * soft) / (1 - share)


@pytest.fixture(scope="module")
def scene() -> Scene:
    """N falls from 3.8 Mg to 0.77 where its pulse ends; a compliant hoop slips earlier, and is in a layer there."""
    return as_scene("paper-3.3-massless").replace(
        hoop={"k": 0.0425201539, "r": 1.1360293958},
        friction={"mu_s": 0.9888216465, "mu": 0.7739118211},
        release={"phi0_deg": -149.151211972, "slip0": -0.687187736},
        contact={"damping": 0.05, "tangential_ratio": 1.0},
    )


def test_a_pulse_that_ends_as_a_slip_starts(scene: Scene) -> None:
    last = passage(scene).last
    assert last is not None
    assert last.kind == START
    assert last.psi == passage(scene).edges[1]
    terms = [predict(scene).terms[name] for name in MEASURES]

    def distances(foundation: float) -> np.ndarray:
        passed = go_through(at_foundation(scene, foundation))
        away = [getattr(passed, name) - term.limit for name, term in zip(MEASURES, terms, strict=True)]
        return np.array(away) * foundation ** (1 / 3)

    # the layer is 1e-2 of J_F; at 1e10 the next power is 2e-2, and one behind it would be 1e-3 of that and less
    assert [term.coefficient for term in terms] == pytest.approx(at_infinity(distances), abs=1e-3)


def test_a_window_that_begins_as_a_slip_starts(scene: Scene) -> None:
    """The same layer, seen from its other side: from the angle of the slip's start on to 0.05 behind it."""
    way, whole = passage(scene, 1.0), passage(scene)
    event = whole.last
    assert event is not None
    slide = Stretch(event.psi, event.psi - 0.05, event.omega, event.behind)
    edges = event.psi, slide.psi_end
    window = replace(
        way, stretches=(*way.stretches, slide), events=(*way.events, event), edges=edges, slips=(0.0, 0.0), last=None
    )

    motion = simulate(scene.replace(run=Run(t_end=1.0)))
    begins = motion.pulses[0].t_end
    ends = brentq(lambda t: float(motion.at(t).phi) - event.bottom - edges[1], begins, 1.0, xtol=1e-15)
    momenta = []
    for t, psi in zip((begins, ends), edges, strict=True):
        now, (a, b, _) = motion.at(t), arms(*way.body[:2], psi)
        momenta.append(np.array([now.slip_velocity + b * now.omega, t - a * now.omega]))

    def distances(foundation: float) -> np.ndarray:
        eps = float(foundation ** (-1 / 3))
        gained = march_through(window, eps)[0][[FRICTION_IMPULSE, NORMAL_IMPULSE]]
        return np.array(gained - (momenta[1] - momenta[0]) / eps)

    found = powers(window)[CREEP][:2]
    # as above; what the layer takes is 1e-2 of J_F here too
    assert found == pytest.approx(at_infinity(distances), abs=1e-3)
