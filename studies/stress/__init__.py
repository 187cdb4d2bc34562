"""`hoop stress`: thousands of scenes over everything a user can type, each with a bound on its work.

``draws``               the scenes, from a seeded quasi-random sequence
``checks``, ``flexible``, ``cycles``  what must hold of a rigid and of a flexible motion, and over a thousand cycles
``run``                 all of them in processes, and what came of it;  ``figures``  the map
"""
