"""Many scenes as a table, a row for each, and their parameters for the kernel."""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from decimal import Decimal
from math import inf, pi
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..allowed import SceneError, shown
from ..kernel import layout as at
from ..output.units import without_units
from ..record.values import Array
from ..sampler import UNTIL_CODES
from ..scene import (  # fmt: skip
    LIGHTEST,
    Friction,
    Hoop,
    Landing,
    Release,
    Scene,
    hoop_constants,
    is_point_mass,
    looks_like_degrees,
)
from ..scenefile import SceneLike, as_scene

QUANTITIES = ("k", "r", "mass_ratio", "mu_s", "mu", "phi0", "omega0", "slip0", "restitution")
DEFAULTS = {"r": 1.0, "mass_ratio": 0.0, "omega0": 0.0, "slip0": 0.0, "restitution": 0.0}


def table_of(scenes: Sequence[SceneLike] | Mapping[str, ArrayLike]) -> Array:
    """One row of ``QUANTITIES`` per scene."""
    if hasattr(scenes, "columns"):  # a table of pandas: no Mapping, but like one
        scenes = {name: scenes[name] for name in scenes.columns}
    if isinstance(scenes, Mapping):
        unknown = set(map(str, scenes)) - set(QUANTITIES)
        missing = set(QUANTITIES) - set(scenes) - set(DEFAULTS)
        if unknown or missing:
            single = len(unknown or missing) == 1
            if unknown:
                what = "is not a quantity of" if single else "are not quantities of"
            else:
                what = f"{'is' if single else 'are'} missing in"
            hint = " phi0 = np.radians(...) is the angle." if "phi0_deg" in unknown else ""
            raise SceneError(
                f"{', '.join(sorted(unknown or missing))} {what} a batch, which has {', '.join(QUANTITIES)};"
                f" angles in radians.{hint}"
            )
        table = _broadcast([_numbers(name, scenes.get(name, DEFAULTS.get(name))) for name in QUANTITIES])
        _check(table)
        _question(table[:, QUANTITIES.index("phi0")])
        return np.ascontiguousarray(table)
    if isinstance(scenes, (str, os.PathLike, Scene)):
        raise SceneError(f"{shown(scenes)} is one scene: a batch takes a list of them, or a dict of arrays.")
    if not isinstance(scenes, Iterable):
        raise SceneError(f"{shown(scenes)} is no batch: that is a list of scenes, or a dict of arrays.")
    rows = []
    for index, one in enumerate(scenes):
        try:
            scene = as_scene(one)
        except SceneError as error:
            raise SceneError(f"scene {index} of the batch: {error}") from None
        hoop, friction, release = scene.hoop, scene.friction, without_units(scene.release, scene)
        hoop_and_friction = (hoop.k, hoop.r, hoop.mass_ratio, friction.mu_s, friction.mu)
        rows.append((*hoop_and_friction, release.phi0, release.omega0, release.slip0, scene.landing.restitution))
    return np.array(rows, dtype=float).reshape(len(rows), len(QUANTITIES))


def _numbers(name: str, values: ArrayLike | None) -> Array:
    kind = getattr(getattr(values, "dtype", None), "kind", "O")
    try:
        # else a float would be made of what is none
        if kind in "fiu" or (kind == "O" and all(map(_is_number, np.asarray(values, dtype=object).ravel()))):
            if np.ma.isMA(values):  # what is masked is no number, and refused as one that is none
                return np.ma.asarray(values, dtype=float).filled(np.nan)
            return np.asarray(values, dtype=float)
    except (OverflowError, TypeError, ValueError):
        pass
    raise SceneError(f"{name} = {shown(values)} is not possible: a batch takes a number, or an array of them.")


def _is_number(one: Any) -> bool:
    return isinstance(one, (Real, Decimal)) and not isinstance(one, (bool, np.bool_))


def _broadcast(columns: list[Array]) -> Array:
    """One row for each scene of columns that broadcast to (n,)."""
    try:
        columns = list(np.broadcast_arrays(*np.atleast_1d(*columns)))
    except ValueError:
        columns = []
    if not columns or columns[0].ndim > 1:
        raise SceneError("The arrays of a batch are numbers, or of one length: they do not broadcast to (n,).")
    return np.stack(columns, axis=1)


def _check(table: Array) -> None:
    """Raise what the first impossible row would raise as a scene."""
    k, r, mass, mu_s, mu, *_, bounce = table.T
    fine = np.isfinite(table).all(axis=1) & (k >= 0) & (k < 1) & (r >= 1) & (mu >= 0) & (mu_s >= mu)
    fine &= (bounce >= 0) & (bounce <= 1) & ((k > 0) | (mass > 0) | (r == 1)) & ((mass == 0) | (mass >= LIGHTEST))
    fine &= (np.abs(np.delete(table, 2, axis=1)) <= 1e9).all(axis=1) & (mass <= 1e12)
    if not fine.all():
        index = int(np.argmin(fine))
        row = [float(number) for number in table[index]]
        try:
            Hoop(*row[:3])
            Friction(*row[3:5])
            Release(*row[5:8])
            Landing(row[8])
        except SceneError as error:
            raise SceneError(f"scene {index} of the batch: {error}") from None


def _question(phi0: Array) -> None:
    """Warn of the first angle that looks like degrees, as a release warns of its own."""
    beyond = looks_like_degrees(phi0)
    if beyond.any():
        index = int(np.argmax(beyond))
        angle = float(phi0[index])
        said = f"is {abs(angle) / (2 * pi):.2g} turns in radians: did you mean phi0 = np.radians({angle!r})?"
        warnings.warn(f"scene {index} of the batch: phi0 = {angle!r} {said}", stacklevel=4)


def parameters_of(table: Array, turns: int | None, t_end: float | None, until: str | None) -> Array:
    """Parameters of all scenes, as :func:`rigid.sampler.parameters` makes them for one."""
    k, r, mass_ratio, mu_s, mu, *_, bounce = table.T
    hoop = hoop_constants(k, r, mass_ratio)
    point = is_point_mass(hoop)
    pars = np.empty((len(table), at.PARAMETERS))
    pars[:, at.ECC], pars[:, at.ONE_MINUS_E] = np.where(point, 1, hoop.e), np.where(point, 0, hoop.one_minus_e)
    pars[:, at.GYR] = np.where(point, 0, hoop.K)
    pars[:, at.ZETA] = np.where(point, 0, hoop.zeta)
    pars[:, at.MU_S], pars[:, at.MU], pars[:, at.RESTITUTION] = mu_s, mu, bounce
    pars[:, at.TURNS] = inf if turns is None else turns
    pars[:, at.T_END] = inf if t_end is None else t_end
    pars[:, at.UNTIL] = UNTIL_CODES[until]
    return pars
