"""The rim as a line in a frame: the mesh's rim nodes and, where it touches the floor, the contact's own points.

Near the floor it is displaced as the contact had it, which takes the dent of a wall that is not thin point by point
(:attr:`flexible.ring.fem.Ring.within`) and not by nodes as the mesh does: undamped, its depth in the floor is that of
the pressure, of a chain to some 5 %.
"""

from __future__ import annotations

from math import pi

import numpy as np
from numpy.typing import NDArray

from meshes import Block, Placement, RingMesh
from meshes.fields import LINE

from ..contact.points.rim import shape_functions
from ..models.rim_contact import RimContact
from ..models.state import State
from .patch import FREE, Profile, displaced, profile, window_of

Array = NDArray[np.float64]

#: what is known of the rim, on its own line, which is much finer than the mesh where it touches
RIM_FIELDS = ("pressure", "traction", "stick")


def given_by(hoop: RimContact) -> float:
    """What the contact has the wall give way by point by point, in R per pressure; 0 of thin walls and of all nodes."""
    return 1 / hoop.law.parameters.eps_n - 1 / hoop.scene.contact.stiffness


def rim_of(
    mesh: RingMesh,
    points: Array,
    nodal: dict[str, Array],
    contact: tuple[RimContact, State] | None,
    place: Placement,
    asked: set[str],
    stress: float,
    length: float,
) -> Block:
    """The rim's block.

    Parameters
    ----------
    mesh : RingMesh
    points : (n_nodes, 2) array
        Undeformed nodes in the world.
    nodal : mapping of (n_nodes, 2) arrays
        Fields of the ring that the rim gets too; the displacement without what :func:`given_by` is of.
    contact : (RimContact, State) or None
        The contact at this instant; None while the hoop is rigid.
    place : Placement
    asked : set of str
        Names out of ``RIM_FIELDS``.
    stress, length : float
        The scene's units.

    Returns
    -------
    Block
        Points once around by ascending material angle, which is the field ``theta``.
    """
    theta, rim = mesh.rim_theta, mesh.rim_nodes
    at, on_line = points[rim], {name: value[rim] for name, value in nodal.items()}
    columns: dict[str, NDArray[np.generic]] = {
        "pressure": np.zeros(len(rim)),
        "traction": np.zeros(len(rim)),
        "stick": np.full(len(rim), FREE, np.int8),
    }
    patch = profile(*contact) if contact is not None else None
    if patch is not None and len(patch.theta):
        # from -pi on, as the mesh counts
        extra = (patch.theta - theta[0]) % (2 * pi) + theta[0]
        together = np.concatenate([theta, extra])
        order = np.argsort(together, kind="stable")  # both edges are there twice, the order of which counts
        at_nodes = _at(patch, theta)
        for name, inside in (("pressure", patch.pressure), ("traction", patch.traction), ("stick", patch.stick)):
            columns[name] = np.concatenate([at_nodes[name], inside])[order]
        circle = length * place.points(np.column_stack([np.cos(extra), np.sin(extra)]))
        at = np.concatenate([at, circle])[order]
        shape, nodes = _quadratic(extra, theta)
        for name, value in on_line.items():
            here = np.einsum("ni,nij->nj", shape, value[nodes])
            on_line[name] = np.concatenate([value, here])[order]
        theta = together[order]
        if contact is not None and "displacement" in on_line:
            # the contact's own points, by what they are: by angle round-off would leave out those at the patch's edges
            low, high = window_of(*contact)
            nodes_at = (mesh.rim_theta - low) % (2 * pi) + low
            counted = np.concatenate([nodes_at, patch.theta])[order]
            near = np.concatenate([nodes_at <= high, np.full(len(extra), True)])[order]
            on_line["displacement"][near] = length * place.vectors(displaced(*contact, counted[near]))
    if contact is not None and "displacement" in on_line:
        dent = given_by(contact[0]) * np.column_stack([columns["traction"], columns["pressure"]])
        on_line["displacement"] = on_line["displacement"] + length * dent
    kept = {name: value if name == "stick" else stress * value.astype(float) for name, value in columns.items()}
    kept = {name: value for name, value in kept.items() if name in asked}
    start = np.arange(len(theta))
    return Block(at, np.column_stack([start, np.roll(start, -1)]), LINE, {"theta": theta, **on_line, **kept})


def _at(patch: Profile, theta: Array) -> dict[str, NDArray[np.generic]]:
    """The profile at other angles: on its own lines, so that they change no integral."""
    within = (theta - patch.theta[0]) % (2 * pi) + patch.theta[0]
    i = np.clip(np.searchsorted(patch.theta, within, side="right") - 1, 0, len(patch.theta) - 2)
    pressure, traction = (
        np.interp(within, patch.theta, value, right=0.0) for value in (patch.pressure, patch.traction)
    )
    stick = np.where(patch.stick[i] != FREE, patch.stick[i], patch.stick[i + 1])
    return {"pressure": pressure, "traction": traction, "stick": np.where(pressure > 0, stick, FREE).astype(np.int8)}


def _quadratic(extra: Array, theta: Array) -> tuple[Array, NDArray[np.int64]]:
    """Shape functions and rim positions of the elements that hold the angles ``extra``, both (n, 3)."""
    vertex, count = theta[::2], len(theta)
    element = np.clip(np.searchsorted(vertex, extra, side="right") - 1, 0, len(vertex) - 1)
    ends = np.append(vertex, vertex[0] + 2 * pi)
    xi = (extra - ends[element]) / (ends[element + 1] - ends[element])
    shape = np.column_stack(shape_functions(xi))
    positions = (2 * element[:, None] + np.arange(3)) % count
    return shape, positions
