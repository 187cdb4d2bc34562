"""How the rim beside the corners of the weld moves to second order with the strains of the wall there.

A wall that bends beside the weld pulls its rim over the disk inward, by the square of its strains: where a soft ring
comes down beside the weld, by more than the patch there is deep. Without it the largest force of a hoop of E I = 0.5
was 3 % too large. What the strains of both parts do together is not asked: in walls as thick as half the weld is wide,
where it is as much, all of it is left out.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from .rim import RimNodes, follow
from .rod.corotated import Rod
from .rod.ends import BACK, chord_strains
from .rod.orders import second_order
from .rod.section import RodCompliance

Array = NDArray[np.float64]

_SMALL = 1e-4  # of a strain; what is of third order cancels


def bow_of_rim(
    rod: Rod, compliance: RodCompliance, nodes: RimNodes, from_mesh: Callable[[Array], Array], theta: Array
) -> Array:
    """Second derivatives, (n_rim, 2, 2, 3, 3), of the rim's displacement by the strains of the first and the last part.

    Those with which nodes up to the first section move as on the mesh when forces far behind it bend the wall, to
    second order; the chain's own are taken off. ``nodes.root`` must be known; ``from_mesh`` makes displacements of
    these ``nodes`` of those of the mesh's.
    """
    answers = second_order(compliance, float(rod.theta[1]))
    weld, end, half = float(rod.theta[0]), float(rod.theta[1]), len(rod.theta) // 2
    by = chord_strains(rod.place[0], rod.place[1], 2)
    load = np.linalg.inv(by @ answers.first)  # that makes a unit of each strain

    def moved(strains: Array) -> Array:
        f, q = load @ strains, np.zeros((len(rod.theta), 3))
        u = answers.first @ f + np.einsum("abc,b,c->a", answers.second, f, f)
        c, s = np.cos(u[2]) - 1, np.sin(u[2])
        arm = rod.place[1:half] - rod.place[1]
        q[1:half, :2] = u[:2] + arm @ np.array([[c, s], [-s, c]])
        q[1:half, 2] = u[2]
        return np.asarray(follow(rod, q, nodes)[0])

    rim = from_mesh(answers.rim.reshape(-1, 9)).reshape(-1, 2, 3, 3)
    mesh = 2 * np.einsum("kabc,bi,cj->kaij", rim, load, load)
    chain, unit = np.zeros_like(mesh), _SMALL * np.diag([1.0, 1.0, 1.0])
    for i in range(3):
        for j in range(3):
            ways = (unit[i] + unit[j], unit[i] - unit[j])
            chain[..., i, j] = sum(
                sign * (moved(way) + moved(-way)) for sign, way in zip((1, -1), ways, strict=True)
            ) / (4 * _SMALL**2)
    first = mesh - chain
    first[(theta > end) | (theta < -weld - 1e-9)] = 0.0
    mirror = np.argmin(np.abs(np.exp(1j * theta)[:, None] - np.exp(-1j * theta)), axis=0)
    last = np.einsum("kaij,im,jn->kamn", first[mirror] * np.array([1.0, -1.0])[:, None, None], BACK, BACK)
    return np.ascontiguousarray(np.stack([first, last], axis=2))
