"""Programs of twenty to sixty lines, one per use, and a longer one. Each writes a picture.

``python -m studies.examples.rigid_motion`` runs one.

``rigid_motion``      the paper's first cycle in closed form
``batch_map``         a plane of hoops at once: friction over normal impulse of the first pulse
``pulse``             the inside of a pulse, flexible beside rigid
``stiffness_study``   the limit of stiffness from Python
``fields_in_pyvista`` the ring's fields as a mesh series, opened with pyvista
``own_friction_law``  a law of friction in a file of its own, ``tanh_law``
``slip_weakening``    a rigid ring on a floor of one's own, whose friction falls over a distance of slip
``hop_by_rule``       which hoops hop, foreseen from the rigid motion and the ring's vibrations
"""
