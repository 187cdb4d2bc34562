"""The mechanics of each kind of phase, and which one is next.

``rolling``, ``slipping``                 the motion in a phase, equations (4) to (19)
``rolling_phase``, ``slipping_phase``     such a phase run to its end, cut at every event
``flight``, ``impact``, ``pointmass``     off the floor; landings and jams; k = 0 without a hoop's mass
``choice``                                the phase machine: which phase comes next
``instant``                               any instant of a phase, from its start
"""
