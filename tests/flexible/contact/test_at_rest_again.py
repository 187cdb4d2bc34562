"""What a brush holds that has slid and rests: mu_s of it if it stands, mu if only the damper presses it harder."""

from math import sqrt

import pytest
from kinematic import Floor, parameters

from flexible import simulate
from flexible.contact.points.data import UNDAMPED
from rigid import scene_from_dict

EPS, MU_S, MU, DEPTH = 1e8, 0.45, 0.3, 1e-8
HALF = sqrt(2 * DEPTH)
STIFF = 0.8 * EPS
LEAST = 1e-3 * (MU_S - MU) * EPS * DEPTH / STIFF  # of the way on which a bristle goes from mu p to mu_s p


@pytest.mark.parametrize("way", [1, -1])
@pytest.mark.parametrize(
    ("pressed", "holds"),
    [
        pytest.param(("springs", 1e-3), MU + (MU_S - MU) / sqrt(3), id="by its springs"),
        pytest.param(("damper", 1.2), MU, id="by its damper"),
    ],
)
def test_what_rests_since_the_damper_presses_it_holds_mu(pressed, holds, way):
    """Points of pressure p_0 (1 - x^2) that all pull mu p and from there on as much more break from the edges inward.

    While those within x stick, F/N = mu + 3/2 (mu_s - mu) (1 - x^2) x, at most mu + (mu_s - mu)/sqrt(3). Within 2 % of
    the difference: 200 points to the patch.
    """
    floor = Floor(parameters("brush", 2 * HALF / 200, EPS, STIFF, MU_S, MU), DEPTH)
    slid = floor.move(2 * way * MU_S * EPS * DEPTH / STIFF, 0.0)
    assert slid.stuck == 0
    assert slid.friction / slid.normal == pytest.approx(-way * MU)
    by, how_much = pressed
    rise, damper = (-how_much * DEPTH, UNDAMPED) if by == "springs" else (0.0, UNDAMPED._replace(eta_0=how_much))
    rests = floor.move(way * LEAST / 1e3, 0.0, damper, rise)
    assert rests.stuck > 0.9
    pulls = [floor.move(way * LEAST, 0.0, damper) for _ in range(1200)]
    most = max(-way * res.friction / res.normal for res in pulls)
    assert most == pytest.approx(holds, abs=0.02 * (MU_S - MU))
    assert pulls[-1].stuck < 0.02
    assert pulls[-1].friction / pulls[-1].normal == pytest.approx(-way * MU, rel=2e-3)


def test_what_rests_sticks_once_it_would_without_the_damper():
    """Moved back a little, against its slide, all of it stands, however the damper presses, and then holds mu_s."""
    floor = Floor(parameters("brush", 2 * HALF / 200, EPS, STIFF, MU_S, MU), DEPTH)
    floor.move(2 * MU_S * EPS * DEPTH / STIFF, 0.0)
    damper = UNDAMPED._replace(eta_0=1.2)
    floor.move(LEAST / 1e3, 0.0, damper)
    assert set(abs(floor.bristles.sliding)) == {2}
    floor.move(-LEAST / 1e3, 0.0, damper)
    assert set(floor.bristles.sliding) == {0}
    pulls = [floor.move(LEAST, 0.0, damper) for _ in range(2500)]
    # as above, but that they begin with mu p of a pressure 1.2 times smaller: so much farther to all that they hold
    assert max(-res.friction / res.normal for res in pulls) > MU + 0.5 * (MU_S - MU) / sqrt(3)


def pulse(k, mu_s, rtol):
    """The first pulse of a massless hoop under a brush with a damper, mu = 0.3."""
    motion = simulate(
        scene_from_dict(
            {
                "hoop": {"k": k, "r": 1.02, "mass_ratio": 0.0},
                "friction": {"mu_s": mu_s, "mu": 0.3},
                "release": {"phi0_deg": 10},
                "ring": {"bending_stiffness": 1e4},
                "contact": {"law": "brush", "stiffness": 1e8, "damping": 1.0},
                "run": {"until": "pulse"},
                "solve": {"rtol": rtol},
            }
        )
    )
    return motion.pulses[0]


@pytest.mark.slow
@pytest.mark.parametrize(("k", "mu_s", "coarse", "fine"), [(0.1, 0.35, 1e-5, 5e-7), (0.1, 0.45, 1e-4, 1e-5)])
def test_what_breaks_loose_while_the_pressure_rises_has_a_limit(k, mu_s, coarse, fine):
    """Impulses change by a few ``rtol`` as it falls.

    Where all that rests sticks it breaks loose twenty times over at the finer one: J_N is 1e-3 larger, or 5e-3.
    """
    one, other = pulse(k, mu_s, coarse), pulse(k, mu_s, fine)
    assert one.normal_impulse == pytest.approx(other.normal_impulse, rel=2 * coarse)
    assert one.friction_impulse == pytest.approx(other.friction_impulse, abs=2 * coarse * other.normal_impulse)
    assert len(other.phases) <= 6
