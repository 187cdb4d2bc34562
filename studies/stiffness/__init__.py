"""Does the compliant hoop become the paper's hoop as its stiffness grows, and how fast?

``ladder``   which stiffnesses are run          ``limits``   the limit of a sequence, with its uncertainty
``study``    the study                          ``summary``  what is told of it, in rows and sentences
``figures``, ``report``, ``page``  the same drawn, and as a page
"""
