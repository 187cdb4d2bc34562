"""The flexible hoop: what happens inside an interaction pulse.

A :class:`rigid.Scene` goes in, a :class:`FlexibleMotion` comes out::

    from flexible import simulate
    from rigid import load_scene

    motion = simulate(load_scene("paper-3.3-massless"))
    motion.pulses, motion.ledger, motion.at([0.0, 1.0])

In the order in which they build on each other:

``ring``       elasticity of the ring on its mesh
``reduction``  modes and static compliance of the rim
``frame``      inertia in a frame that floats on the disk
``contact``    pressure and friction on dense points of the rim
``step``       one implicit step
``march``      adaptive steps, stick and slip, the energy's books
``reduced``    the reduced hoop as a model for the march
``nodal``      inertia and elasticity of all nodes
``full``       the hoop with all nodes, as a model for the march
``exact``      the same with a geometrically exact ring
``levels``     which of them a scene gets, and where the linear ones end
``rest``       ring and patch in equilibrium
``start``      equilibrium under a rigid motion
``stretch``    records read as phases, turns and pulse measures
``limit``      the rigid hoop that a flexible one tends to
``solve``      simulate(scene)
``motion``     what is added to the common vocabulary
``interior``   displacement, stress and energy inside the ring
``profile``    pressure and friction along the patch
``rim``        the rim of a frame
``curves``     forces and phases beside the frames
``fields``     write_fields(motion, directory): all of it as a series on disk
"""

from .motion import FlexibleMotion, FlexiblePulse, History, Ledger
from .solve import simulate

__all__ = ["FlexibleMotion", "FlexiblePulse", "History", "Ledger", "simulate"]
