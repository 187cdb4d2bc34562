"""The flexible hoop: what happens inside an interaction pulse.

A :class:`rigid.Scene` goes in, a :class:`FlexibleMotion` comes out::

    from flexible import simulate

    motion = simulate("paper-3.3-massless")
    motion.pulses, motion.ledger, motion.at([0.0, 1.0])
    motion.pulses[0].plot(), motion.to_dataframe()

In the order in which they build on each other:

``ring``      which scenes have none; its elasticity and inertia, from the mesh to modes and static compliance
``chain``     the same as parts between rigid sections that turn and move far
``contact``   points of the rim near the floor, the foundation under them, friction along it: a law is one file of
              ``contact.laws``, which also says which rigid hoop the flexible one becomes as its stiffness grows
``models``    a hoop that can be moved in time: reduced, all nodes, geometrically exact, chain
``time``      one implicit step; adaptive steps with located events
``airborne``  how high over the floor a hoop is in flight, and how fast it rises
``start``     where a flexible segment begins: in the equilibrium of a rigid motion
``builder``   puts a motion together: ``segment`` has records read as phases and pulses, ``pieces`` what it is made of,
              ``motion`` is what comes back, ``saved`` from a file and ``packed`` into one
``run``       simulate(scene): pulse by pulse or flexible throughout, which pulses it has, how it ends
``output``    displacement and stress, all fields as a series on disk, the hoop as a whole (not loaded here)
"""

from typing import TYPE_CHECKING

from .motion import FlexibleMotion, FlexiblePulse, History, Ledger
from .ring.possible import ensure_possible
from .run.solve import simulate
from .saved import load_motion

if TYPE_CHECKING:
    __version__: str
    from .contact.laws.listing import rigid_limit
    from .output.fields import write_fields


def __getattr__(name: str) -> object:
    """Fields and the limit on demand: a motion needs neither. The version too."""
    if name == "__version__":
        import rigid

        return rigid.__version__
    if name == "write_fields":
        from .output.fields import write_fields

        return write_fields
    if name == "rigid_limit":
        from .contact.laws.listing import rigid_limit

        return rigid_limit
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "FlexibleMotion",
    "FlexiblePulse",
    "History",
    "Ledger",
    "__version__",
    "ensure_possible",
    "load_motion",
    "rigid_limit",
    "simulate",
    "write_fields",
]
