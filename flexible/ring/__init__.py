"""The ring by itself: elasticity and inertia, from the mesh to modes.

``possible``   which scenes have none
``corners``    what the wall yields besides at the corners of the weld
``mirror``     what half of a ring says of all of it
``fem``        stiffness, mass, static compliance of the rim, vibration modes, stress, by scikit-fem
``choice``     which of these a scene stands on: elements by tolerance, stiffness and wall
``exact``      its elasticity with Green's strain, where it turns far
``frame``      inertia of disk and modes in axes that float on the disk
``nodal``      the same with every node free
``rim``        as a floor feels it: evenly, and of few modes
"""
