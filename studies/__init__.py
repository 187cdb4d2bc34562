"""What is compared, swept, drawn and reported, and the command line.

``stiffness``  the flexible hoop against the rigid one as stiffness grows: ladder, rates, limit
``limits``     observed rate and Richardson limit of a sequence, with their uncertainty
``sweep``      the product of scene keys over processes or a Dask cluster
``store``      the table of a sweep on disk, safe against any interruption
``case``       one scene through one solver, made into a row
``measures``   what is measured on a pulse; a new measure is one function
``solvers``    the solvers by name; a third one is one adapter
``figures``    curves through a pulse;  ``study_figures``  those of a study;  ``style``  how they look
``report``     the page
``bench``      run time against error;  ``stress``  thousands of scenes and what must hold of them
``cli``        ``hoop ...``
"""
