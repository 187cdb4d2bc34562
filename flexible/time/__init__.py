"""Time stepping, which knows nothing of how a stage is solved.

``methods``     the implicit Runge-Kutta methods
``stages``      one step with its error, impulses and losses: one text, for Python and compiled for a reduced hoop
``chain_step``  the same compiled for a chain
``rows``        what it does with the stages row by row
``step``        that step from state to state, and the jump when the law of friction changes
``adaptive``    many of them, with stick and slip as located events
``course``      where such a march stands, to be taken up again
"""
