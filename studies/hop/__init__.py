"""The footnote answered: does an elastic hoop hop?

``roll``     one roll from rest, and every time that the hoop is off the floor in it
``energies`` what ring and floor stored before a hop, and where it went
``rule``     which flights are hops and which are chatter
``threshold``  a roll of the map, a line of them, and the stiffness below which it hops
``study``    the map over two keys         ``summary``  what is told of it, in rows and sentences
``figures``, ``film``, ``report``  the same drawn, moving, and as a page
"""
