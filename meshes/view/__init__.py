"""Pictures, animations and a window, of the fields of a flexible run or of any motion.

``pictures``     picture, animate, window      ``setting``  what stays the same from one instant to the next
``film``         pages in time as one file     ``interactive``  the window itself
"""

from .pictures import Timing, ViewError, animate, picture, render, window
from .setting import as_told

__all__ = ["Timing", "ViewError", "animate", "as_told", "picture", "render", "window"]
