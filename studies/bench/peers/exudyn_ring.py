"""Exudyn's ring of geometrically exact cables (ANCF) with a rigid disk, on a floor that is a circle of huge radius.

It is given a scene, whose mu is its one coefficient of friction and whose damping it does not have. Its cables run
along the middle line of the wall, with the wall's bending and axial stiffness; within the weld they are pinned to the
disk; penalty and bristles act on segments of the cables. Units R = m = g = 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, sin
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rigid import Scene, simulate

Array = NDArray[np.float64]

FLOOR = 2e4
"""Radius of the circle, on which the hoop rolls near its top."""
SEGMENTS = 4
"""Of contact to a cable."""
REST, REST_STEP = 4.0, 0.01
"""Time in which the ring comes to rest before a release, and its steps."""
BENDING_DAMPER, CONTACT_DAMPER = 0.2, 0.01
"""Over the stiffness of bending and contact, meanwhile."""
ACROSS = 20
"""Points of a cable among which is the rim's lowest: with 120 cables that misses it by 1e-6."""


class Cables(NamedTuple):
    """A motion of the ring, step by step."""

    t: Array
    phi: Array
    """Rotation of the disk."""
    normal_force: Array
    gap: Array
    """Height of the rim's lowest point over the floor, below 0 where it is pressed in."""
    sag: float
    """Of the disk, before it is released."""


def roll(scene: Scene, elements: int, step: float, segments: int = SEGMENTS, clamped: bool = True) -> Cables:
    """The motion of a scene from its release to ``run.t_end``.

    It starts as ``solve.start`` says: undeformed, moving as a rigid hoop that rolls, or, from rest, in the equilibrium
    of the ring under its weight and the accelerations of a rigid hoop that begins to roll. Not ``clamped`` its weld is
    three pins, at the ends and in the middle, which gives way as that of a wall of 2 % at its inner rim does.

    Raises
    ------
    ImportError
        Exudyn is not installed.
    RuntimeError
        It did not come through.
    """
    import exudyn as exu

    ring = _Ring(exu, scene, elements, segments, clamped)
    ring.add_cables()
    ring.add_disk()
    ring.add_floor()
    ring.system.Assemble()
    sag = ring.settle() if scene.solve.start == "equilibrium" else 0.0
    history: list[tuple[float, float, float, float]] = []

    def note(system: Any, t: float) -> bool:
        history.append((t, *ring.read()))
        return True

    ring.system.SetPostStepUserFunction(note)
    assert scene.run.t_end is not None
    ring.system.SolveDynamic(_settings(exu, scene.run.t_end, step))
    t, phi, normal, gap = np.array(history).T
    return Cables(t, phi, normal if normal.mean() > 0 else -normal, gap, sag)


def turn(scene: Scene, elements: int, step: float) -> dict[str, float]:
    """Normal impulse and largest normal force of a scene."""
    found = roll(scene, elements, step, clamped=False)
    impulse = float(np.trapezoid(found.normal_force, found.t))
    return {"normal_impulse": impulse, "peak_normal_force": float(found.normal_force.max())}


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
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.parallel.numberOfThreads = 1
    return settings


@dataclass
class _Ring:
    """The system as it is put together: cables first, so that their numbers are those of the objects."""

    exu: Any
    scene: Scene
    elements: int
    segments: int
    clamped: bool

    def __post_init__(self) -> None:
        import exudyn.itemInterface as item

        self.item = item
        self.system = self.exu.SystemContainer().AddSystem()
        self.phi0, self.omega = self.scene.release.phi0, self.scene.release.omega0
        self.inner = 1 / self.scene.hoop.r
        self.wall = self.scene.ring.thickness or 1 - self.inner
        self.radius = 1 - self.wall / 2
        self.length = 2 * pi * self.radius / self.elements
        ground = self.system.AddNode(item.NodePointGround())
        self.still = self.system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        self.holds: list[Any] = []
        self.dampers: list[Any] = []
        """Of the disk's coordinates, for its start."""
        self.contacts: list[tuple[Any, float]] = []
        """With the stiffness of a segment."""
        self.weights: list[tuple[Any, Array]] = []
        """Loads on a unit of mass, and where they act."""

    def point(self, angle: float, radius: float) -> Array:
        """At an angle from the top, where the hoop is released."""
        return np.array([radius * sin(angle), 1 + radius * cos(angle)])

    def velocity(self, place: Array) -> list[float]:  # of rolling about the lowest point
        return [self.omega * place[1], -self.omega * place[0]]

    def add_cables(self) -> None:
        """Cables around, each with its weight."""
        item, bending, nodes = self.item, self.scene.ring.bending_stiffness, []
        for i in range(self.elements):
            a = self.phi0 + 2 * pi * i / self.elements
            place, slope = self.point(a, self.radius), np.array([cos(a), -sin(a)])
            speed = [*self.velocity(place), self.omega * slope[1], -self.omega * slope[0]]
            node = item.NodePoint2DSlope1(referenceCoordinates=[*place, *slope], initialVelocities=speed)
            nodes.append(self.system.AddNode(node))
        mass = self.scene.hoop.mass_ratio / (2 * pi * self.radius)
        for i in range(self.elements):
            cable = self.system.AddObject(
                item.ObjectANCFCable2D(
                    length=self.length,
                    massPerLength=mass,
                    bendingStiffness=bending,
                    axialStiffness=12 * bending / self.wall**2,
                    referenceCurvature=-1 / self.radius,
                    nodeNumbers=[nodes[i], nodes[(i + 1) % self.elements]],
                    useReducedOrderIntegration=0,
                )
            )
            marker = self.system.AddMarker(item.MarkerBodyMass(bodyNumber=cable))
            load = self.system.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=[0, -1, 0]))
            self.weights.append((load, self.point(self.phi0 + 2 * pi * (i + 0.5) / self.elements, self.radius)))

    def add_disk(self) -> None:
        """The disk, welded to the cables, and what holds it before it is released."""
        item, k = self.item, self.scene.hoop.k * self.inner
        centre = self.point(self.phi0, self.inner - k)
        speed = [*self.velocity(centre), -self.omega]
        disk = self.system.AddNode(item.NodeRigidBody2D(referenceCoordinates=[*centre, 0.0], initialVelocities=speed))
        self.inertia = 0.5 * k**2
        body = self.system.AddObject(item.ObjectRigidBody2D(mass=1.0, inertia=self.inertia, nodeNumber=disk))
        middle = self.system.AddMarker(item.MarkerBodyPosition(bodyNumber=body))
        load = self.system.AddLoad(item.LoadForceVector(markerNumber=middle, loadVector=[0, -1, 0]))
        self.weights.append((load, centre))
        whole = self.system.AddMarker(item.MarkerBodyRigid(bodyNumber=body))
        self.torque = self.system.AddLoad(item.LoadTorqueVector(markerNumber=whole, loadVector=[0, 0, 0]))
        for j in (0, 1, 2):
            moved = self.system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=disk, coordinate=j))
            ends = [self.still, moved]
            hold = item.CoordinateConstraint(markerNumbers=ends, activeConnector=False)
            damper = item.ObjectConnectorCoordinateSpringDamper(markerNumbers=ends)
            self.holds.append(self.system.AddObject(hold))
            self.dampers.append(self.system.AddObject(damper))
        self._weld(body, centre)

    def _weld(self, body: Any, centre: Array) -> None:
        """Pin nodes and middles of the cables within the weld to the disk, which leaves no bending; or three nodes."""
        item = self.item
        half = max(round(self.scene.ring.weld_half_angle / (2 * pi) * self.elements), 1)
        for j in range(-2 * half, 2 * half + 1, 1 if self.clamped else 2 * half):
            # on the Hermite cubic, which misses the circle by 1e-8 in the middle
            arm = self.point(self.phi0 + pi * j / self.elements, self.radius) - centre
            here = self.system.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=[*arm, 0]))
            cable = (j - j % 2) // 2 % self.elements
            along = [self.length / 2 * (j % 2), 0, 0]
            there = self.system.AddMarker(item.MarkerBodyPosition(bodyNumber=cable, localPosition=along))
            self.system.AddObject(item.RevoluteJoint2D(markerNumbers=[here, there]))

    def add_floor(self) -> None:
        """A circle held by three constraints, whose multipliers are the forces; in contact with every cable."""
        item, contact = self.item, self.scene.contact
        node = self.system.AddNode(item.NodeRigidBody2D(referenceCoordinates=[0, -FLOOR, 0]))
        body = self.system.AddObject(item.ObjectRigidBody2D(mass=1, inertia=1, nodeNumber=node))
        for j in range(3):
            held = self.system.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=j))
            self.system.AddObject(item.CoordinateConstraint(markerNumbers=[self.still, held]))
        floor = self.system.AddMarker(item.MarkerBodyRigid(bodyNumber=body))
        count = self.segments
        stiffness = contact.stiffness * self.length / count
        before = [0.1] * count + [-2.0] * count + [0.0] * count  # gap, no contact yet, place of sticking
        for cable in range(self.elements):
            rim = self.system.AddMarker(
                item.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=count, verticalOffset=self.wall / 2)
            )
            memory = self.system.AddNode(
                item.NodeGenericData(initialCoordinates=before, numberOfDataCoordinates=len(before))
            )
            contact_of = self.system.AddObject(
                item.ObjectContactFrictionCircleCable2D(
                    markerNumbers=[floor, rim],
                    nodeNumber=memory,
                    numberOfContactSegments=count,
                    contactStiffness=stiffness,
                    frictionStiffness=stiffness * contact.tangential_ratio,
                    frictionVelocityPenalty=0.0,
                    frictionCoefficient=self.scene.friction.mu,
                    circleRadius=FLOOR,
                    useSegmentNormals=False,
                )
            )
            self.contacts.append((contact_of, stiffness))

    def settle(self) -> float:
        """Bring the ring to rest under its weight and the accelerations of the rigid hoop, the disk held from turning.

        By damped motion: a floor that is not touched gives a static solver no stiffness to begin with. First without
        friction, the disk held from shifting too, then with friction, which comes to what accelerates the rigid hoop.
        Returns by how much the disk has sunk.
        """
        self._load(float(simulate(self.scene).at(0.0).alpha))
        for held, mu, damping in (((0, 2), 0.0, 10.0), ((2,), self.scene.friction.mu, 3.0)):
            self._rest(held, mu, damping)
            self.system.SolveDynamic(_settings(self.exu, REST, REST_STEP), updateInitialValues=True)
        self._rest((), self.scene.friction.mu, 0.0)
        self._load(0.0)
        data = self.system.systemData
        still = 0 * np.array(data.GetODE2Coordinates_t())
        data.SetODE2Coordinates_t(still, configuration=self.exu.ConfigurationType.Initial)
        return -float(data.GetODE2Coordinates()[4 * self.elements + 1])

    def _rest(self, held: tuple[int, ...], mu: float, damping: float) -> None:
        """Hold coordinates of the disk; friction; damping of the disk, with which that of bending and contact comes."""
        change, damped = self.system.SetObjectParameter, float(damping > 0)
        for j in (0, 1, 2):
            change(self.holds[j], "activeConnector", j in held)
            change(self.dampers[j], "damping", damping)
        for cable in range(self.elements):
            change(cable, "bendingDamping", BENDING_DAMPER * self.scene.ring.bending_stiffness * damped)
        for number, stiffness in self.contacts:
            change(number, "contactDamping", CONTACT_DAMPER * stiffness * damped)
            change(number, "frictionCoefficient", mu)

    def _load(self, alpha: float) -> None:
        """Weight, less what it takes to roll with an angular acceleration."""
        for load, place in self.weights:
            self.system.SetLoadParameter(load, "loadVector", [-alpha * place[1], -1 + alpha * place[0], 0])
        self.system.SetLoadParameter(self.torque, "loadVector", [0, 0, alpha * self.inertia])

    def read(self) -> tuple[float, float, float]:
        """Rotation of the disk, multiplier of the floor's vertical support, gap."""
        data = self.system.systemData
        count, form = 4 * self.elements, self.exu.ConfigurationType.Reference
        moved = np.array(data.GetODE2Coordinates())
        nodes = (moved + data.GetODE2Coordinates(configuration=form))[:count].reshape(-1, 4)
        return self.phi0 - moved[count + 2], float(data.GetAECoordinates()[-2]), self._gap(nodes)

    def _gap(self, nodes: Array) -> float:
        """Of the rim's lowest point, on the Hermite cubics of the three nodes' cables that are lowest."""
        place, slope = nodes[:, :2], nodes[:, 2:]
        low = int(np.argmin(place[:, 1]))
        x = np.linspace(0, 1, ACROSS + 1)[:, None]
        found = []
        for i in (low - 2, low - 1, low, low + 1):
            a, b = i % self.elements, (i + 1) % self.elements
            curve = (1 - 3 * x**2 + 2 * x**3) * place[a] + (3 * x**2 - 2 * x**3) * place[b]
            curve += self.length * ((x - 2 * x**2 + x**3) * slope[a] + (x**3 - x**2) * slope[b])
            along = (6 * x**2 - 6 * x) * (place[a] - place[b])
            along += self.length * ((1 - 4 * x + 3 * x**2) * slope[a] + (3 * x**2 - 2 * x) * slope[b])
            normal = np.column_stack([-along[:, 1], along[:, 0]]) / np.hypot(*along.T)[:, None]
            rim = curve + self.wall / 2 * normal
            found.append(float((rim[:, 1] + rim[:, 0] ** 2 / (2 * FLOOR)).min()))
        return min(found)
