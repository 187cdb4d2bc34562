"""Exudyn's ring of ANCF cables with a rigid disk, on a floor that is a circle of huge radius.

One coefficient of friction only (mu_s = mu). Lengths in the inner radius, masses in the disk's, g = 1; results in the
outer radius, as everywhere else.
"""

from __future__ import annotations

from math import cos, pi, radians, sin, sqrt
from typing import Any

import numpy as np

from ..truth.reference import END_OF_A

R, K, RING_MASS, MU = 1.02, 0.1, 0.1, 0.3
YOUNG = 1e8 / R
FOUNDATION = 1e7
FLOOR = 2e4  # radius of the circle
SEGMENTS = 4  # of contact to an element
RADIUS = (1 + R) / 2  # of the ring's middle line


def turn(scene: str, elements: int, step: float) -> dict[str, float]:
    """Scene A or B: normal impulse and largest normal force.

    Raises
    ------
    ImportError
        Exudyn is not installed.
    """
    import exudyn as exu
    import exudyn.itemInterface as item

    phi0, omega, t_end = (radians(10), 0.0, END_OF_A) if scene == "A" else (2.9, 4.0, 0.1426)
    system = exu.SystemContainer().AddSystem()
    ground = system.AddNode(item.NodePointGround())
    still = system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    nodes = _ring(system, item, elements, phi0, omega)
    _disk(system, item, nodes, phi0, omega)
    supports = _floor(system, item, still, elements)
    system.Assemble()
    history: list[tuple[float, float]] = []

    def note(system: Any, t: float) -> bool:
        history.append((t, float(np.array(system.systemData.GetAECoordinates())[-2])))
        return True

    system.SetPostStepUserFunction(note)
    assert len(supports) == 3
    system.SolveDynamic(_settings(exu, t_end, step))
    t, normal = np.array(history).T
    normal = normal if normal.mean() > 0 else -normal
    return {"normal_impulse": float(np.trapezoid(normal, t)) / sqrt(R), "peak_normal_force": float(normal.max())}


def _settings(exu: Any, t_end: float, step: float) -> Any:
    settings = exu.SimulationSettings()
    march = settings.timeIntegration
    march.endTime, march.numberOfSteps = t_end, round(t_end / step)
    march.generalizedAlpha.spectralRadius = 0.8
    march.newton.useModifiedNewton = False
    march.newton.relativeTolerance = march.newton.absoluteTolerance = 1e-6
    march.newton.numericalDifferentiation.minimumCoordinateSize = 1.0
    march.adaptiveStep = True
    march.discontinuous.maxIterations = 5
    march.discontinuous.iterationTolerance = 1e-3
    march.discontinuous.ignoreMaxIterations = True
    march.verboseMode = 0
    settings.solution.file.write = False
    settings.linearSolverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    return settings


def _ring(system: Any, item: Any, elements: int, phi0: float, omega: float) -> list[Any]:
    """Cables around, each with its weight; their nodes."""
    length, wall = 2 * pi * RADIUS / elements, R - 1
    nodes = []
    for i in range(elements):
        a = phi0 + 2 * pi * i / elements
        place, slope = [RADIUS * sin(a), R + RADIUS * cos(a)], [cos(a), -sin(a)]
        speed = [omega * place[1], -omega * place[0], omega * slope[1], -omega * slope[0]]
        nodes.append(
            system.AddNode(item.NodePoint2DSlope1(referenceCoordinates=place + slope, initialVelocities=speed))
        )
    for i in range(elements):
        cable = system.AddObject(
            item.ObjectANCFCable2D(
                physicsLength=length,
                massPerLength=RING_MASS / (2 * pi * RADIUS),
                bendingStiffness=YOUNG * wall**3 / 12,
                axialStiffness=YOUNG * wall,
                referenceCurvature=-1 / RADIUS,
                nodeNumbers=[nodes[i], nodes[(i + 1) % elements]],
                useReducedOrderIntegration=0,
            )
        )
        mass = system.AddMarker(item.MarkerBodyMass(bodyNumber=cable))
        system.AddLoad(item.LoadMassProportional(markerNumber=mass, loadVector=[0, -1, 0]))
    return nodes


def _disk(system: Any, item: Any, nodes: list[Any], phi0: float, omega: float) -> None:
    """The disk, pinned to the nodes of its weld."""
    centre = [(1 - K) * sin(phi0), R + (1 - K) * cos(phi0)]
    speed = [omega * centre[1], -omega * centre[0], -omega]
    node = system.AddNode(item.NodeRigidBody2D(referenceCoordinates=[*centre, 0.0], initialVelocities=speed))
    body = system.AddObject(item.ObjectRigidBody2D(mass=1.0, inertia=0.5 * K**2, nodeNumber=node))
    middle = system.AddMarker(item.MarkerBodyPosition(bodyNumber=body))
    system.AddLoad(item.LoadForceVector(markerNumber=middle, loadVector=[0, -1, 0]))
    count = len(nodes)
    half = max(count // 120, 1)
    for j in (-half, 0, half):
        a = phi0 + 2 * pi * j / count
        arm = [RADIUS * sin(a) - centre[0], R + RADIUS * cos(a) - centre[1], 0]
        here = system.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=arm))
        there = system.AddMarker(item.MarkerNodePosition(nodeNumber=nodes[j % count]))
        system.AddObject(item.RevoluteJoint2D(markerNumbers=[here, there]))


def _floor(system: Any, item: Any, still: Any, elements: int) -> list[Any]:
    """A circle held by three constraints, whose multipliers are the forces; in contact with every cable."""
    node = system.AddNode(item.NodeRigidBody2D(referenceCoordinates=[0, -FLOOR, 0]))
    body = system.AddObject(item.ObjectRigidBody2D(mass=1, inertia=1, nodeNumber=node))
    supports = [
        system.AddObject(
            item.CoordinateConstraint(
                markerNumbers=[still, system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=j))]
            )
        )
        for j in range(3)
    ]
    floor = system.AddMarker(item.MarkerBodyRigid(bodyNumber=body))
    stiffness = FOUNDATION * 2 * pi * RADIUS / elements / SEGMENTS
    for cable in range(elements):
        # the cables are the first objects
        rim = system.AddMarker(
            item.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=SEGMENTS, verticalOffset=(R - 1) / 2)
        )
        memory = system.AddNode(
            item.NodeGenericData(
                initialCoordinates=[0.1] * SEGMENTS + [-2.0] * SEGMENTS + [0.0] * SEGMENTS,
                numberOfDataCoordinates=3 * SEGMENTS,
            )
        )
        system.AddObject(
            item.ObjectContactFrictionCircleCable2D(
                markerNumbers=[floor, rim],
                nodeNumber=memory,
                numberOfContactSegments=SEGMENTS,
                contactStiffness=stiffness,
                frictionStiffness=stiffness,
                frictionVelocityPenalty=0.0,
                frictionCoefficient=MU,
                circleRadius=FLOOR,
                useSegmentNormals=False,
            )
        )
    return supports
