"""`hoop bench`: run time against error, and the ratios that are stated.

``rigid``, ``flexible``, ``soft``, ``scaling``  what is timed, each with its claims
``knobs``, ``mesh``      what each of the four that ``rtol`` turns leaves; the elements by wall and stiffness
``contact``            what places of points, steps and books leave
``skipped``            what each thing skipped saves
``race``               contestants in turns, rows, claims
``truth``              what is taken for true: forty digits, all nodes in the limit
``peers``              the same scenes by other tools, and what those tend to
``shown``              tables and figures of it

What all of it printed is on the page beside this file (README.md).
"""
