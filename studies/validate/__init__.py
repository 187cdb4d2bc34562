"""Truth from outside: published and provable results beside what the solvers find, as rows of one table.

``row``         a number, where it comes from, ours beside it
``paper``       every number of the paper
``point_mass``  a particle on a thin hoop, in closed form
``dispute``     the particle on a hoop without mass: hop, skim, and what a light hoop says to both
``ring``        the elastic ring against thin-ring theory, plane stress and the elastica
``contact``     the patch against Winkler and Kalker, and a hoop at rest
``limit``       the flexible pulse against its limit, whose approach the rigid motion foretells
``published``   what could not be had as a number, and why
``table``       all of them, and as a screen shows them
"""
