"""The same problems in other people's programs, written as a competent user of each would.

``scipy_ivp``, ``siconos_roll``, ``nivp_roll``, ``drake_roll``, ``mujoco_roll``, ``exudyn_roll``  the rigid hoop
``rigid_pulse``   its first pulse, as a program of rigid bodies gets and tells it
``exudyn_ring``   the elastic one
``approach``      what they make of the pulse as their own stiffness, slip velocity or step goes to its limit
"""
