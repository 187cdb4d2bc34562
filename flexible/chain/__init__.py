"""The ring as a chain of parts between rigid sections: geometrically exact, at the price of the reduced one.

``rod``        its parts: as stiff as the mesh there, and how they turn and move far
``mass``       inertia of the sections and of the wall beside the weld, in the frame that floats on the disk
``rim``        which follows them
``corner``     and moves to second order where the wall bends beside the weld
``ring``       the chain of a scene, and the compliance of its wall that a chain lacks
``bordered``   the matrix of it all, eliminated down to a small core
``whole``      frame and chain as one vector
``lowest``     where the rim is lowest
``touch``      the rim at the floor
``misfit``     what they lack of equilibrium
``stage``      one implicit stage
"""
