"""What is compared, swept, drawn and reported, and the command line.

``stiffness``  the flexible hoop against the rigid one as stiffness grows: ladder, rates, limit, figures, page
``limit``      that limit solved, from the inner problems (``inner``) of the rigid hoop's events
``sweep``      the product of scene keys over processes or a Dask cluster
``paper``      every number and figure of the paper again
``bench``      run time against error;  ``stress``  thousands of scenes and what must hold of them
``running``    scenes through solvers, in processes, kept in a folder, whatever the study
``plots``      what all figures share
``cli``        ``hoop ...``
"""
