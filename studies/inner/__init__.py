"""The inner problem at infinite stiffness: what happens within a patch's own time around an event of the rigid motion.

``scales``    what a scene's compliance becomes when lengths, times and velocities are scaled with it
``march``     their equations in time: hoop and patch   ``creep``     what a patch in steady rolling must slip
``events``    the instants to look at                   ``layers``    their inner problems solved
``cut``       their part in a pulse that begins or ends there    ``stops``  which sticks break, and what follows then
``separate``  the foundation from which on one layer is over before the next event comes, and the ring is the stiffer
"""
