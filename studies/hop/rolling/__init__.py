"""Rolls from rest, what is read off them, and what the stiffness below which a hoop hops may be compared with.

``roll``       one roll, and every time that the hoop is off the floor in it
``asked``      what a study rolls, and the scene of each roll
``energies``   what ring and floor stored before a hop, and where it went
``limit``      the rigid hoop to which an elastic one tends
``rule``       which flights are hops and which are chatter
``threshold``  a roll of the map, a line of them, and the stiffness below which it hops
``scaling``    how sudden a pulse is for the ring
``drop``       how far N falls where a slip begins
"""
