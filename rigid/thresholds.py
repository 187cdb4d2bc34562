"""Where the kind of motion changes: inception of slip (9), and the smallest friction or disk that rolls
throughout.
"""

from __future__ import annotations

import dataclasses
from math import inf, pi, tan

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from .allowed import shown
from .kernel.angle import trig
from .kernel.layout import MU_S, ZETA
from .phases.rolling.closed_form import ceiling, margin_polynomials, rolling_forces, turning_point
from .sampler import parameters
from .scene import Friction, Hoop, Release, Scene, SceneError
from .solve import release_state

DISKS = 200  # sizes between which the friction that a roll asks for has one minimum at the most
NARROW = {"xatol": 1e-12}


def inception_mu_s(hoop: Hoop, phi0: float) -> float:
    """Smallest mu_s at which a hoop released at rest starts rolling, (9): |F|/N of rolling at the release.

    Parameters
    ----------
    hoop : Hoop
    phi0 : float
        Angle of the release, in radians.

    Returns
    -------
    float
        ``inf`` where rolling takes N <= 0.
    """
    par, state = _at_release(hoop, Release(phi0))
    normal, friction = rolling_forces(par, 0.0, state[1], state[2])
    return abs(friction) / normal if normal > 0 else inf


def rolling_mu_s(hoop: Hoop, release: Release) -> float:
    """Smallest mu_s at which a motion released in rolling rolls throughout: the largest |F|/N of its swing.

    Parameters
    ----------
    hoop : Hoop
    release : Release
        With slip0 = 0.

    Returns
    -------
    float
        ``inf`` where N of rolling falls to 0 within the swing, so that no friction keeps the hoop rolling.

    Raises
    ------
    SceneError
        A release that slips.
    """
    if not isinstance(release, Release):
        raise SceneError(f"release = {shown(release)} is not possible: it must be a Release.")
    if release.slip0 != 0.0:
        raise SceneError(f"release.slip0 = {release.slip0!r} is not possible here: what is released so does not roll.")
    par, state = _at_release(hoop, release)
    if release.omega0 == 0 and state[1] == 0:
        return 0.0  # upside down it stands: the swing that would begin there never does
    par[MU_S] = 1.0
    _, _, h, low = trig(state[1], state[2])
    g, below = ceiling(par[ZETA], state[4], h, low)
    offset, top = turning_point(g, below)
    worst = 0.0
    # |F|/N = odd(y)/even(y) in y = tan|psi/2| below the hoop's height of centre and in 1/y above
    for upper in (False, True):
        if upper and top == 0.0:
            break
        plus, minus = [0.0] * 7, [0.0] * 7
        margin_polynomials(par, g, upper, plus, minus)
        odd = np.polynomial.Polynomial([0.0 if i % 2 == 0 else plus[i] for i in range(7)])
        even = np.polynomial.Polynomial([-plus[i] if i % 2 == 0 else 0.0 for i in range(7)])
        first, last = (tan(offset / 2), 1.0) if upper else (0.0, tan(offset / 2) if top == 0.0 else 1.0)
        peaks = (odd.deriv() * even - odd * even.deriv()).roots()
        vanishing = even.roots()
        real = vanishing[np.abs(vanishing.imag) <= 1e-12 * np.abs(vanishing)].real
        if np.any((real >= first) & (real <= last)):
            return inf
        inside = peaks.real[(np.abs(peaks.imag) <= 1e-6 * np.abs(peaks)) & (peaks.real > first) & (peaks.real < last)]
        for y in (first, *inside, last):
            worst = max(worst, abs(odd(y) / even(y)))
    return worst


def rolling_k(mu_s: float, release: Release, *, r: float = 1.0, mass_ratio: float = 0.0) -> float:
    """Smallest k that rolls throughout for a given mu_s; of a thrown hoop larger ones may slip again.

    Parameters
    ----------
    mu_s : float
    release : Release
        With slip0 = 0.
    r, mass_ratio : float
        As of :class:`Hoop`.

    Raises
    ------
    SceneError
        A number that no scene can have.
    ValueError
        Every disk slips, or the smallest does not.
    """
    hoop, mu_s = Hoop(0.5, r, mass_ratio), Friction(mu_s, 0.0).mu_s

    def lack(k: float) -> float:
        needed = rolling_mu_s(dataclasses.replace(hoop, k=k), release)
        return min(needed, 1e6) - mu_s

    sizes = 0.5 - (0.5 - 1e-6) * np.cos(np.linspace(0.0, pi, DISKS))  # close to each other at both ends
    lacks = [lack(k) for k in sizes]
    if lacks[0] <= 0:
        raise ValueError(f"the smallest disks roll throughout with mu_s = {mu_s} already")
    for i in range(1, DISKS):
        if lacks[i] <= 0:
            return float(brentq(lack, sizes[i - 1], sizes[i], xtol=1e-14, rtol=1e-14))
        if i + 1 < DISKS and lacks[i - 1] > lacks[i] < lacks[i + 1]:  # the least lies between
            least = minimize_scalar(lack, bounds=(sizes[i - 1], sizes[i + 1]), method="bounded", options=NARROW)
            if least.fun <= 0:
                return float(brentq(lack, sizes[i - 1], least.x, xtol=1e-14, rtol=1e-14))
    raise ValueError(f"every disk slips with mu_s = {mu_s}")


def _at_release(hoop: Hoop, release: Release) -> tuple[list[float], list[float]]:
    scene = Scene(hoop, Friction(1.0, 1.0), release)
    return parameters(scene), release_state(scene)
