"""A run: a scene through the flexible hoop to a motion.

``solve``       simulate(scene)
``between``     the rigid hoop between pulses, the flexible one inside them
``throughout``  the flexible hoop from the release on
``pulses``      which pulses a motion has
``ahead``       how far there is still to go, and the rigid hoop from there
``told``        how far a run is, and in words why it ends
"""
