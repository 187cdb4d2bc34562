"""A stick that breaks before the pulse begins: impulses are those of the hoop that slides on there."""

import pytest

from rigid import as_scene
from studies.inner.stops.hanging import followed
from studies.limit.compliant import at_foundation, go_through
from studies.limit.prediction import predict


def test_begins_with_the_hoop_that_slides_on() -> None:
    scene = as_scene("paper-3.3-massless").replace(
        hoop={"k": 0.1086489, "r": 1.083183},
        friction={"mu_s": 1.0849942, "mu": 0.7515093},
        release={"phi0_deg": 4.657767},
        contact={"damping": 0.2, "tangential_ratio": 1.0},
    )
    way = followed(scene)
    assert way.events[0].kind.endswith("stick breaks")
    assert abs(way.edges[0]) < abs(way.events[0].psi)
    term = predict(scene).terms["impulse_ratio"]
    # the next power of eps is some per cent of it here; without the part that holds the edge L itself is off
    seen = go_through(at_foundation(scene, 1e11)).impulse_ratio
    assert (seen - term.limit) * 1e11 ** (1 / 3) == pytest.approx(term.coefficient, rel=0.06)
