"""N(t), F(t), slip and phases over a span of a motion, as a field series keeps them beside its frames."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..motion import FlexibleMotion

BETWEEN = 400  # samples where the hoop is rigid
_NAMES = ("normal_force", "friction_force", "slip_velocity")


def curves(motion: FlexibleMotion, start: float, stop: float) -> dict[str, Any]:
    """Curves from ``start`` to ``stop``: every step of the flexible segments, samples elsewhere.

    Returns
    -------
    dict
        ``t``, ``normal_force``, ``friction_force``, ``slip_velocity`` of equal lengths, ascending in time (an event
        has two values at one time), and ``phase_kind``, ``phase_start``, ``phase_end``; in the scene's units.
    """
    ends = np.array([start, stop])
    elastic = [np.array([k.states[0].t, k.states[-1].t]) * motion.scene.time_unit for k in motion.kept]
    outside = np.linspace(start, stop, BETWEEN)
    for first, last in elastic:
        outside = outside[(outside < first) | (outside > last)]
    sampled = motion.at(np.unique(np.concatenate([ends, outside])))
    columns = {"t": sampled.t, **{name: getattr(sampled, name) for name in _NAMES}}
    history = motion.history
    if history is not None and len(history.t):
        inside = (history.t > start) & (history.t < stop)
        steps = {"t": history.t[inside], **{name: getattr(history, name)[inside] for name in _NAMES}}
        order = np.argsort(np.concatenate([columns["t"], steps["t"]]), kind="stable")
        columns = {name: np.concatenate([columns[name], steps[name]])[order] for name in columns}
    phases = [p for p in motion.phases if p.t_end >= start and p.t_start <= stop]
    return {
        **columns,
        "phase_kind": [str(p.kind) for p in phases],
        "phase_start": [max(p.t_start, start) for p in phases],
        "phase_end": [min(p.t_end, stop) for p in phases],
    }
