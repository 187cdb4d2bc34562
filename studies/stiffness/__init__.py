"""Does the compliant hoop become the paper's hoop as its stiffness grows, and how fast?

``ladder``   which stiffnesses are run          ``limits``   the limit of a sequence, with its uncertainty
``study``    the study                          ``found``    what it found, as a table and a picture
``series``   the limit where rates are known    ``coefficient``  how fast it is reached, beside what is predicted
``summary``  what is told of it                 ``figures``, ``report``  the same drawn, and as a page
"""
