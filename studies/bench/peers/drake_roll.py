"""The rigid hoop in Drake's discrete contact: a sphere on a half space, one point, friction of one coefficient.

SAP regularises friction by an amount that falls with the step. Lagged and Similar do it over a slip velocity, the
plant's stiction tolerance: F = mu N v/sqrt(v^2 + v_s^2).
"""

from __future__ import annotations

from math import cos, pi, sin
from typing import Any

import numpy as np

from .rigid_pulse import Start, States

STIFFNESS = 1e9  # of the point, m g/R
SOLVERS = {"SAP": "kSap", "Lagged": "kLagged", "Similar": "kSimilar"}


def pulse(start: Start, solver: str, step: float, tolerance: float) -> States:
    """States of a pulse, by one of the ``SOLVERS``; ``tolerance`` is the stiction velocity.

    Raises
    ------
    ImportError
        Drake is not installed.
    """
    from pydrake.systems.analysis import Simulator

    diagram, plant, joint = _built(start, solver, step, tolerance)
    simulator = Simulator(diagram)
    context = plant.GetMyMutableContextFromRoot(simulator.get_mutable_context())
    joint.set_translation(context, [0.0, 1.0 - start.normal / STIFFNESS])
    joint.set_translational_velocity(context, [start.slip + start.omega, 0.0])
    joint.set_angular_velocity(context, -start.omega)
    simulator.Initialize()
    rows = []
    for number in range(round(start.duration / step)):
        right, up = joint.get_translational_velocity(context)
        omega = -joint.get_angular_velocity(context)
        rows.append((number * step, start.phi - joint.get_rotation(context), omega, right, up))
        if (rows[-1][1] - start.edges[1]) * start.omega > 0:
            break
        simulator.AdvanceTo((number + 1) * step)
    return States(*np.array(rows).T)


def _built(start: Start, solver: str, step: float, tolerance: float) -> tuple[Any, Any, Any]:
    """Diagram, plant, and the joint: x to the right, y upward, its angle counter-clockwise."""
    from pydrake.geometry import AddContactMaterial, HalfSpace, ProximityProperties, Sphere
    from pydrake.math import RigidTransform, RollPitchYaw
    from pydrake.multibody import plant as plants
    from pydrake.multibody.tree import FixedOffsetFrame, PlanarJoint, SpatialInertia, UnitInertia
    from pydrake.systems.framework import DiagramBuilder

    builder = DiagramBuilder()
    plant, _ = plants.AddMultibodyPlantSceneGraph(builder, step)
    plant.set_discrete_contact_approximation(getattr(plants.DiscreteContactApproximation, SOLVERS[solver]))
    plant.set_contact_model(plants.ContactModel.kPoint)
    plant.mutable_gravity_field().set_gravity_vector([0.0, 0.0, -1.0])
    centre = np.array([start.e * sin(start.phi), 0.0, start.e * cos(start.phi)])
    about = UnitInertia.SolidSphere(np.sqrt(start.gyration / 0.4)).ShiftFromCenterOfMass(centre)
    hoop = plant.AddRigidBody("hoop", SpatialInertia(1.0, centre, about))
    surface = ProximityProperties()
    friction = plants.CoulombFriction(start.mu, start.mu)
    AddContactMaterial(dissipation=0.0, point_stiffness=2 * STIFFNESS, friction=friction, properties=surface)
    # SAP lifts what slides by mu v times the contact's relaxation time, a tenth of a unit by default
    surface.AddProperty("material", "relaxation_time", 0.0)
    plant.RegisterCollisionGeometry(plant.world_body(), RigidTransform(), HalfSpace(), "floor", surface)
    plant.RegisterCollisionGeometry(hoop, RigidTransform(), Sphere(1.0), "rim", surface)
    upright = RigidTransform(RollPitchYaw(pi / 2, 0.0, 0.0), [0.0, 0.0, 0.0])
    frames = [
        plant.AddFrame(FixedOffsetFrame(name, frame, upright))
        for name, frame in (("upright", plant.world_frame()), ("turning", hoop.body_frame()))
    ]
    joint = plant.AddJoint(PlanarJoint("plane", *frames, np.zeros(3)))
    plant.Finalize()
    plant.set_stiction_tolerance(tolerance)
    return builder.Build(), plant, joint
