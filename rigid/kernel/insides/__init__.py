"""What reaches into numba beyond its decorators.

``parts``    functions of which intermediate code is all that is made
``address``  functions that are compiled by themselves, and called by their address
"""
