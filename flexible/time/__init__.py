"""Time stepping, which knows nothing of how a stage is solved.

``methods``     the implicit Runge-Kutta methods
``stages``      one step with its error, impulses and losses
``rows``        what it does with the stages row by row
``control``     how long the next one is
``events``      what ends a step early, and where in it that is
``advance``     many of them: one text, for Python and compiled for a reduced hoop
``chain_step``  the same compiled for a chain
``adaptive``    the march: such stretches, and the jump between them when the law of friction changes
``course``      where a march stands, to be taken up again
"""
