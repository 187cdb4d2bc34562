"""Time stepping, which knows nothing of how a stage is solved.

``methods``   the implicit Runge-Kutta methods
``step``      one step with its error, impulses and losses
``adaptive``  many of them, with stick and slip as located events
``course``    where such a march stands, to be taken up again
"""
