"""What pictures are made of. Nothing is loaded from pyvista or matplotlib before something is drawn.

``style``    colours, names, symbols         ``display``  is there anything to draw with?
``shots``    what is shown at an instant     ``scales``   colours and sizes taken from the whole run
``renderer`` hoop, floor and arrows (VTK)    ``lens``     the contact, enlarged
``patch``    pressure along the patch        ``layout``   type, colour bar and curves around the view
"""
