"""`hoop bench mesh`: what elements leave by wall and stiffness."""

from __future__ import annotations

import pytest

from flexible.models.select import ring_for
from flexible.ring.choice import elements_around, halved_at_rim, mesh_error
from studies.bench import mesh
from studies.bench.mesh import RTOL, meshes, places
from studies.bench.shown.figures import by_wall

ONE = next(place for place in places(quick=True) if place.r == 1.05)


@pytest.mark.parametrize("place", list(places(quick=True)), ids=lambda place: place.title)
def test_the_chosen_mesh_is_that_of_a_run(place):
    """And the finest is finer than both others, with the same modes, points and steps."""
    found = meshes(place)
    ring = ring_for(place.scene.replace(solve={"rtol": RTOL}).to_dimensionless()).mesh
    around, through = found["chosen"].around, found["chosen"].through
    assert around == len(ring.rim_theta) // 2
    layers = through + halved_at_rim(place.scene.wall, around, through)
    assert len(ring.grid) == 2 * layers + 1  # rows of nodes
    for name in ("usual", "chosen"):
        assert found[name].around < found["finest"].around
        assert found[name].through < found["finest"].through
        assert (found[name].modes, found[name].points, found[name].rtol) == tuple(
            getattr(found["finest"], key) for key in ("modes", "points", "rtol")
        )


def test_elements_are_chosen_by_what_is_assumed_here():
    """A third of rtol is left by as many as the order says; by 240 where they leave less."""
    for bending, wall in ((65.0, 0.005), (1e3, 0.005), (65.0, 0.1)):
        assumed = mesh_error(bending, wall)
        for rtol in (1e-2, 3 * assumed):
            assert elements_around(rtol, bending, wall) == 240
        assert elements_around(3 * assumed / 2**3.4, bending, wall) == pytest.approx(480, abs=1)


@pytest.mark.slow
def test_a_mesh_that_leaves_too_much_is_told_and_drawn(monkeypatch):
    """By its ring, and what is stated of the chosen ones holds: steps are fine enough not to hide it."""
    monkeypatch.setattr(mesh, "places", lambda quick: [ONE])
    monkeypatch.setattr(mesh, "STILL", 3e-5)
    monkeypatch.setattr(mesh, "OVER", 1e-9)
    result = mesh.bench(quick=True)
    assert [claim.holds for claim in result.claims] == [False, True]
    assert [row.scene for row in result.rows] == ["r = 1.05, E I = 65"] * 2
    assert all(0 < row.error < 1e-3 for row in result.rows)
    drawn = by_wall(result.rows).axes
    assert [axes.get_title() for axes in drawn] == ["usual elements", "chosen elements"]


def test_a_run_without_an_end_is_a_note(monkeypatch):
    def fails(scene, setting):
        raise RuntimeError("it cannot go on")

    monkeypatch.setattr(mesh, "places", lambda quick: [ONE])
    monkeypatch.setattr(mesh, "pulse_at", fails)
    result = mesh.bench(quick=True)
    assert [row.note for row in result.rows] == ["it cannot go on"] * 2
    assert [claim.holds for claim in result.claims] == [False], "nothing was compared"
