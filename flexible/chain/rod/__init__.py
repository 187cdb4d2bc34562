"""The parts of the chain: a rod with the compliance of the mesh.

``section``    what a section and the two ends at the weld give way, measured on scikit-fem's quads
``second``     how a section near the weld moves to second order
``ends``       the first and the last part, with the joint at the weld
``parts``      where the ring is cut, and all its parts
``surface``    what the rim shows of their strains
``softening``  what bends far bends easier
``corotated``  how they turn and move far
``tangent``    their stiffness where they are
"""
