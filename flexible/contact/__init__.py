"""Compliant frictional contact of the rim with the floor, in compiled code.

``points``    material points of the rim: which touch, the foundation under them, the bristles along it
``laws``      friction laws, a file each
``room``      the few arrays that all of them are parts of
``assembly``  from points to unknowns
``way``       how far the patch has gone along the floor in a step, whose rate is its slip velocity
``forces``    all of it together: forces, tangent, state of the patch
``guess``     the same where Newton begins: the rim moved to where the forces say something
``foreseen``  N and F as unknowns of their own, where a damper all but gives them
``newton``    what Newton on a stage with these forces is alike for all rings
``stage``     what a stage of a step is asked, and its answer
``vectors``   sums and products of whole vectors, small systems
"""
