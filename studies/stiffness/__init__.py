"""Does the compliant hoop become the paper's hoop as its stiffness grows, and how fast?

``ladder``       which stiffnesses are run           ``extrapolation``  the limit of a sequence, with its uncertainty
``study``        the study                           ``found``          what it found, as a table and a picture
``coefficient``  how fast it comes there, beside     ``told``           the same in words, rows, figures and as a page
                 what is predicted of that           ``errors``         the rungs' own, as a limit is inferred with
"""
