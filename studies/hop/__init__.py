"""The footnote answered: does an elastic hoop hop?

``rolling``  rolls, their flights and energies, the rule, thresholds
``study``    the map over two keys         ``summary``  what is told of it, in rows and sentences
``maps``, ``figures``, ``film``, ``report``  the same drawn, moving, and as a page
``peers``    hops beside another code's
"""
