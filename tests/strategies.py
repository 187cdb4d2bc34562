"""What a user can type, for hypothesis."""

from __future__ import annotations

from math import pi

from hypothesis import strategies as st

from rigid import Friction, Hoop, Landing, Release, Run, Scene

RUNS = (Run(turns=2), Run(turns=4), Run(until="pulse"), Run(until="rest"), Run(t_end=10.0))


@st.composite
def scenes(draw):
    """Small disks and heavy hoops alike."""
    k = draw(st.one_of(st.floats(0.01, 0.95), st.floats(-8, -2).map(lambda x: 10**x)))
    r = draw(st.one_of(st.just(1.0), st.floats(1, 2)))
    mass = draw(st.one_of(st.just(0.0), st.floats(-4, 2).map(lambda x: 10**x)))
    mu = draw(st.one_of(st.just(0.0), st.floats(0, 3)))
    mu_s = mu * draw(st.one_of(st.just(1.0), st.floats(1, 5)))
    slip = draw(st.one_of(st.just(0.0), st.floats(-2, 2)))
    release = Release(draw(st.floats(-pi, pi)), draw(st.floats(-5, 5)), slip)
    return Scene(
        Hoop(k, r, mass), Friction(mu_s, mu), release, draw(st.sampled_from(RUNS)), Landing(draw(st.floats(0, 1)))
    )
