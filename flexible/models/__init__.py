"""A hoop that the march in time can move, at four levels of fidelity behind one interface.

``state``        an instant of the hoop, and what a model must be able to do
``rim_contact``  what all levels share: the law of the contact, its damper, the window of rim near the floor
``stage``        one implicit stage of the reduced hoop
``reduced``, ``full``, ``exact``  the models: modes, all nodes, all nodes geometrically exact
``chain``        and the geometrically exact chain of parts
``equilibrium``  the hoop at rest under given forces of the floor
``select``       which model a scene gets, and whether the linear ring stayed within its range
"""
