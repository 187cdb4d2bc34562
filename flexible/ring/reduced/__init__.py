"""The ring by a few modes and the compliance of its rim, which a floor far stiffer than the wall feels evenly.

The rim of quads is a polygon of parabolas, and a load stands deeper on one of its nodes than between. A patch much
narrower than an element, on a floor much stiffer than the wall's own give, runs over that as over a washboard. There
the rim is finer than its mesh, and the same at all places of an element:

``curve``      points between the nodes, on a line without kinks
``places``     what the compliance owes to the place on an element, of a ring whose mesh goes on evenly
``even``       a ring's rim with both
``reduction``  the ring as the stepper sees it
"""
