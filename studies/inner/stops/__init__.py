"""Stops of a slip: whether a patch keeps the stick that begins there, and what becomes of the limit where it does not.

``critical``  the damping below which the sequence of phases changes
``hanging``   the stops where that makes another limit
"""
