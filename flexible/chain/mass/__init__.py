"""Inertia of the chain.

``inertia``  of disk and sections, in the frame that floats on the disk
``ends``     the wall beside the weld moves with the first and the last section: its masses, from the mesh
``beside``   and its inertia
"""
