"""The rim as a floor feels it: evenly where that is far stiffer than the wall, and of few modes.

The rim of quads is a polygon of parabolas, and a load stands deeper on one of its nodes than between. A patch much
narrower than an element, on a floor much stiffer than the wall's own give, runs over that as over a washboard. There
the rim of the reduced ring and of the chain is finer than its mesh, and even:

``curve``      points between the nodes, on a line without kinks
``places``     what the compliance owes to the place on an element, of a ring whose mesh goes on evenly
``even``       a ring's rim with both
``reduction``  the rim of a reduced ring: fixed-interface modes, and the rest of the compliance as static
"""
