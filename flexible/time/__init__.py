"""Time stepping, which knows nothing of how a stage is solved.

``tr_bdf2``   one step with its error, impulses and losses
``adaptive``  many of them, with stick and slip as located events
"""
