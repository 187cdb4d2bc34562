"""Where a flexible segment begins.

``pose``         instants of a rigid motion in the units of the flexible solver
``settling``     ring and patch brought to rest together
``equilibrium``  the state at rest in the disk's frame under the forces of a pose
``balance``      the state that under its own law of friction carries these forces
``handover``     the same with its rates, along the rigid motion
"""
