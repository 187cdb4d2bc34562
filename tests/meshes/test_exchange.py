"""The mesh in other programs' formats comes back as it went out."""

from __future__ import annotations

import meshio
import numpy as np
import pytest

from meshes import MeshError, ring_mesh, save_mesh
from meshes.exchange import HOLD


@pytest.mark.parametrize("suffix", sorted(set(HOLD) - {".e", ".ex2", ".exo", ".hmf"}))
def test_the_quads_come_back_in_every_format(suffix, tmp_path):
    """Those that need netCDF4 aside."""
    ring = ring_mesh(0.98, 1.0, 24)
    save_mesh(ring, tmp_path / f"ring{suffix}")
    again = meshio.read(tmp_path / f"ring{suffix}")
    np.testing.assert_allclose(again.points[again.cells_dict["quad9"], :2], ring.points[ring.quad9], atol=1e-15)
    assert len(again.cells_dict["line3"]) == 2 * 24 + len(ring.weld_nodes) // 2


@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
def test_round_trip(tmp_path, suffix):
    ring = ring_mesh(0.98, 1.0, 24)
    save_mesh(ring, tmp_path / f"ring{suffix}")
    again = meshio.read(tmp_path / f"ring{suffix}")
    assert np.array_equal(again.points[:, :2], ring.points)
    assert np.array_equal(again.cells_dict["quad9"], ring.quad9)
    lines = again.cells_dict["line3"]
    data = again.cell_data["boundary" if suffix == ".vtu" else "gmsh:physical"]
    tags = np.concatenate([d for cells, d in zip(again.cells, data, strict=True) if cells.type == "line3"])
    radius = np.linalg.norm(again.points[lines], axis=2)
    assert np.allclose(radius[tags == 1], 1.0, atol=1e-15)
    assert np.allclose(radius[np.isin(tags, (2, 3))], 0.98, atol=1e-15)
    assert (tags == 1).sum() == (tags == 2).sum() == 24
    angle = np.abs(np.arctan2(again.points[lines[tags == 3], 1], again.points[lines[tags == 3], 0]))
    assert angle.max() == pytest.approx(ring.weld_half_angle, rel=1e-12)
    # a mid-side node lies between the ends of its own line: half a chord's length from each, to second order
    ends, mids = again.points[lines[:, :2]], again.points[lines[:, 2]]
    chord = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert np.allclose(np.linalg.norm(ends[:, 0] - mids, axis=1), chord / 2, rtol=0.01)


@pytest.mark.parametrize("suffix", [".vtk", ".vtu"])
def test_vtk_reads_the_numbers_of_the_boundaries(suffix, tmp_path):
    """It does not know every kind of whole number that meshio writes, and leaves out what it does not know."""
    pyvista = pytest.importorskip("pyvista")
    ring = ring_mesh(0.98, 1.0, 24)
    save_mesh(ring, tmp_path / f"ring{suffix}")
    tags = np.asarray(pyvista.read(tmp_path / f"ring{suffix}").cell_data["boundary"])
    assert np.bincount(tags).tolist() == [len(ring.quad9), 24, 24, len(ring.weld_nodes) // 2]


@pytest.mark.parametrize("suffix", [".vtk", ".msh"])
def test_lengths_are_in_the_unit_that_is_asked(suffix, tmp_path):
    ring = ring_mesh(0.98, 1.0, 24)
    save_mesh(ring, tmp_path / f"ring{suffix}", 0.25)
    np.testing.assert_array_equal(meshio.read(tmp_path / f"ring{suffix}").points[:, :2], 0.25 * ring.points)


@pytest.mark.parametrize("length", [0.0, -1.0, float("nan"), float("inf")])
def test_a_unit_of_length_that_cannot_be(length, tmp_path):
    with pytest.raises(MeshError, match=r"length = .* is not possible"):
        save_mesh(ring_mesh(0.98, 1.0, 24), tmp_path / "ring.vtu", length)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "suffix", [".nonsense", ".stl", ".med", ".xdmf", ".mesh", ".su2", ".svg", ".wkt", ".bdf", ".f3grid", ""]
)
def test_a_suffix_without_nine_node_quads_is_a_sentence(suffix, tmp_path):
    """meshio writes some of these without any cell, and breaks off in others."""
    with pytest.raises(MeshError, match="no format for nine-node quads"):
        save_mesh(ring_mesh(0.98, 1.0, 24), tmp_path / f"ring{suffix}")
    assert not list(tmp_path.iterdir())
