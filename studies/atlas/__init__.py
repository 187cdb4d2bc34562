"""A map of rigid hoops over two quantities: what the contact does in the first pulse, and what the pulse takes.

``plane``    the two quantities, and the hoops at points of their plane
``refine``   which points are run, and which lie between neighbours that agree
``study``    the map
``figures``  its picture
``summary``  what is told of it
"""
