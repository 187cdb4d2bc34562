"""The fields of a flexible motion, for files and pictures; and the hoop as a whole.

``recovery``  displacement, velocity and stress of the whole ring at an instant
``chain_interior``  the same of a chain        ``interior``  whichever belongs to a hoop
``rim``, ``patch``, ``curves``  the rim as a line, pressure and friction along the patch, N(t) and F(t)
``body``      mass centre, spin, shares of the kinetic energy, the rim's outline and its lowest point
``instants``  which instants become frames, and the hoop at each of them
``fields``    all of it as a PVD + VTU series
"""
