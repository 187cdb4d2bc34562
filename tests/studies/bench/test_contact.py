"""`hoop bench contact`: what the places of points, the books and the force at an instant leave."""

from __future__ import annotations

import pytest

from rigid import Run
from studies.bench import contact
from studies.bench.race import Row
from studies.bench.shown.tables import bench_tables


@pytest.mark.slow
def test_what_is_stated_holds():
    """Of a few scenes; each kind has a table with its rows, and what was moved is a figure's."""
    result = contact.bench(quick=True)
    assert not [row.note for row in result.rows if row.note]
    assert [claim.name for claim in result.claims if not claim.holds] == []
    tables = {sheet.title: sheet for sheet in bench_tables(result)}
    assert set(result.told) < set(tables)
    rows = [row for row in result.rows if "growth" in row.more]
    assert [row.more["growth"] > 1 for row in rows] == [False, True] * (len(rows) // 2)


def test_what_is_worse_than_stated_does_not_hold():
    """Points that matter as much as rtol, books with as much, a force off by a hundredth, steps that explode."""
    rows = [
        Row("", "", "massless", [1.0], 1e-3, more={"rtol": 1e-3, **dict.fromkeys(contact.SCATTER, 1e-3)}),
        Row("", "", "thin", [1.0], more={contact.BOOKS: -0.5, contact.STEPS: 10.0}),
        Row("", "", "rolls, E I = 500 on 1e7", [1.0], more={contact.FORCE: 0.01, contact.STEPS: 10.0}),
        Row("", "", "grows", [1.0], more={contact.STEPS: 10.0}),
        Row("", "", "grows", [1.0], more={contact.STEPS: 101.0}),
    ]
    contact._compare_steps(rows, ["grows"])
    claims = list(contact._claims(rows))
    assert [claim.measured for claim in claims] == [1.0, 0.5, 0.01, pytest.approx(10.1)]
    assert not any(claim.holds for claim in claims)


def test_a_run_without_an_end_is_a_note(monkeypatch):
    scene = next(contact.rolled(quick=True))[1]
    for kind in ("scattered", "rolled", "grown"):
        monkeypatch.setattr(contact, kind, lambda quick: [])
    monkeypatch.setattr(contact, "booked", lambda quick: [("thin", scene.replace(run=Run(t_end=1e-3)), (1e-3,))])
    monkeypatch.setattr("flexible.simulate", lambda scene, history: Stopped())
    result = contact.bench()
    assert [row.note for row in result.rows] == ["it cannot go on"]
    assert not any(claim.holds for claim in result.claims), "nothing was measured"


class Stopped:
    """A motion that did not come to its end."""

    completed, ended = False, "it cannot go on"
