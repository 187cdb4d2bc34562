"""Programs of twenty to fifty lines, one per use. Each writes a picture: ``python -m studies.examples.rigid_motion``.

``rigid_motion``      the paper's first cycle in closed form
``batch_map``         a plane of hoops at once: friction over normal impulse of the first pulse
``pulse``             the inside of a pulse, flexible beside rigid
``stiffness_study``   the limit of stiffness from Python
``fields_in_pyvista`` the ring's fields as a mesh series, opened with pyvista
``own_friction_law``  a law of friction in a file of its own, ``tanh_law``
"""
