"""Published work on hoops that hop, skim and slip of which no number could be had, and why."""

from __future__ import annotations

from collections.abc import Iterator

from .row import Row

WITHOUT = (
    (
        "Theron and Maritz, Math. Comput. Model. 47 (2008) 1077",
        "thirty-six sequences of phases of a particle on a heavy hoop",
        "its list and phase diagrams are not at hand; the closed forms of the same hoop stand above",
    ),
    (
        "Pritchett, Amer. Math. Monthly 106 (1999) 609; Pritchett and Wagon, The Hopping Hoop, COMAP 2001",
        "slip before the hop, and its time",
        "not at hand; what they refute, a hop at 90 degrees for any friction, stands above",
    ),
    (
        "Butler, Amer. Math. Monthly 106 (1999) 565",
        "a hoop without mass does not hop",
        "an argument without a number; see the rows on hop and skim",
    ),
    (
        "Theron, Am. J. Phys. 68 (2000) 812",
        "rolling motion of an eccentrically loaded wheel",
        "not at hand; its threshold m/m_h = 13 from rest is derived above",
    ),
    (
        "Theron, Math. Comput. Model. 35 (2002) 1135",
        "the elastic hopping hoop",
        "not at hand; `hoop study hop` asks the same of a hoop with a heavy disk",
    ),
    (
        "Gomez, Hernandez-Gomez and Marquina, Eur. J. Phys. 33 (2012) 1359, arXiv:1204.0600",
        "where an eccentric cylinder jumps off a slope of 15, 30 and 45 degrees",
        "the floor here is level",
    ),
)


def rows() -> Iterator[Row]:
    """One for each, without a number."""
    for source, what, why in WITHOUT:
        yield Row(source, what, None, None, why=why)
