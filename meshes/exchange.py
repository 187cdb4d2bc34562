"""The ring's mesh in the formats of other programs, by meshio: Gmsh, Abaqus, VTU and what else holds its quads."""

from __future__ import annotations

from math import inf
from numbers import Real
from pathlib import Path

import numpy as np

from rigid.output.whole import write_whole

from .ring import MeshError, RingMesh

HOLD = (".msh", ".vtu", ".vtk", ".inp", ".mdpa", ".e", ".ex2", ".exo", ".hmf")
"""Formats in which meshio writes nine-node quads and reads them again; others it writes without them, or breaks off."""


def save_mesh(ring: RingMesh, path: str | Path, length: float = 1.0) -> None:
    """Write the mesh: nine-node quads, and the three-node lines of its boundaries, in .msh, .vtu and .vtk with numbers.

    Parameters
    ----------
    ring : RingMesh
    path : path
        Its suffix says which format, one of ``HOLD``; points have a third coordinate 0.
    length : float
        What a length of 1 in ``ring`` is in the file: R in m, of a mesh in units of R.

    Raises
    ------
    MeshError
        A suffix that is no format for nine-node quads, or needs a package that is not installed; a length not above 0.
    OSError
        The file cannot be written.
    """
    import meshio

    path = Path(path)
    if not (isinstance(length, Real) and 0 < length < inf):
        raise MeshError(f"length = {length!r} is not possible: it must be above 0.")
    suffix = path.suffix or "no suffix"
    if path.suffix not in HOLD:
        known = ", ".join(HOLD)
        raise MeshError(f"{path} cannot be written: {suffix} is no format for nine-node quads; these are: {known}.")
    points = length * np.column_stack([ring.points, np.zeros(len(ring.points))])
    lines, numbers = [], []
    for number, nodes in enumerate((ring.outer_nodes, ring.inner_nodes, ring.weld_nodes), 1):
        ends = nodes[::2] if number == 3 else np.append(nodes[::2], nodes[0])  # the weld is an arc, the rims close
        lines.append(np.column_stack([ends[:-1], ends[1:], nodes[1::2]]))
        numbers += [number] * len(lines[-1])
    cells = [("quad9", ring.quad9), ("line3", np.concatenate(lines))]
    gmsh = path.suffix == ".msh"
    whole = np.int32 if gmsh else np.int64  # VTK knows no name that meshio gives the shorter ones
    tags = [np.zeros(len(ring.quad9), whole), np.array(numbers, whole)]
    data = {"gmsh:physical": tags, "gmsh:geometrical": tags} if gmsh else {"boundary": tags}
    try:
        mesh = meshio.Mesh(points, cells, cell_data=data)
        write_whole(path, lambda part: mesh.write(part, **({"file_format": "gmsh22"} if gmsh else {})))
    except (meshio.WriteError, meshio.ReadError, KeyError, NotImplementedError):
        raise MeshError(f"{path} cannot be written: {suffix} is no format for nine-node quads.") from None
    except ModuleNotFoundError as error:
        needed = f"{path.suffix} needs {error.name}, which is not installed"
        raise MeshError(f"{path} cannot be written: {needed}.") from None
