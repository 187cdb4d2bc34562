"""Material points of the rim near the floor, and what each of them does.

``data``       what goes through compiled code by name: parameters, damper, forces of points, resultants
``rim``        where its elements and nodes are, and how far its points are over the floor
``dent``       how far sideways the rim was displaced when a step began, by the angle
``detection``  which points touch, where they are, how they moved since the step began
``normal``     the foundation under them
``entry``      when and where one touched in a step
``bristles``   the bristles that they carry along the floor
``leaving``    what these do until their points leave it
"""
