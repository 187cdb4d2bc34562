"""What the phases are computed with, and why it runs both interpreted and compiled.

``compile``     functions that run as plain Python and, on demand, compiled
``store``       where compiled code is kept: a cache of the user's; ``announce`` who is told, and what it takes
``insides``     what of that reaches into numba beyond its decorators
``interrupts``  signals that come while compiled code runs
``layout``      where things stand in the flat sequences that kernels work on
``angle``       phi without loss of digits near the bottom or the top
``polynomial``  all real roots on an interval, none stepped over
``spectral``    rows of Chebyshev nodes: integrals, interpolation, the count of roots
``elliptic``    Carlson's integrals
"""
