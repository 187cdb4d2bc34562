"""The mechanics of each kind of phase, and which one is next.

``rolling``                               forces and times in closed form, (4) to (8) and (17) to (19); a pass over the
                                          bottom; the phase run to its end
``slipping``                              quadrature over phi, (10) to (16), and series where phi is no measure; the
                                          phase run to its end, cut at events
``flight``, ``impact``, ``pointmass``     off the floor; landings and jams; k = 0 without a hoop's mass
``skimming``                              k = 0 under a hoop without a force on it
``contact``                               what the contact does from a state on: rolls, slips, leaves the floor, jams
``choice``                                the phase machine: which phase comes next
``instant``                               any instant of a phase, from its start
``reasons``                               why a motion ends, in words
"""
