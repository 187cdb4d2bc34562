"""Many scenes at once, on all cores, in memory that grows with their number and not with their histories.

``table``   scenes, or arrays of their quantities, as one table; what is refused, with its number
``run``     the loop over them
``result``  what became of them
``cores``   how many things may be done at once
"""

from .result import Batch
from .run import simulate_batch

__all__ = ["Batch", "simulate_batch"]
