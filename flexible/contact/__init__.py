"""Compliant frictional contact of the rim with the floor, in compiled code.

``detection``  material points of the rim near the floor
``normal``     the foundation under them
``friction``   the bristles along it
``assembly``   from points to unknowns
``forces``     all of it together: forces, tangent, state of the patch
"""
