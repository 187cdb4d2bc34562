"""`hoop stress`: thousands of scenes over everything a user can type, each with a bound on its work.

``draws``               the scenes, from a seeded quasi-random sequence: within the model's range, and hostile ones
``checks``, ``flexible``, ``cycles``  what must hold of a rigid and of a flexible motion, and over a thousand cycles
``work``                the bound on the work of a run
``run``                 all of them in processes, and what came of it;  ``figures``  the map
"""
