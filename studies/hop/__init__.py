"""The footnote answered: does an elastic hoop hop?

``roll``     one roll from rest, and every time that the hoop is off the floor in it
``energies`` what ring and floor stored before a hop, and where it went
``rule``     which flights are hops and which are chatter
``threshold``  the stiffness below which the hoop hops, by bisection
``study``    the map over two keys         ``summary``  what is told of it, in rows and sentences
``figures``, ``film``, ``report``  the same drawn, moving, and as a page
"""
