"""Pictures, animations and a window, of the fields of a flexible run or of any motion.

``pictures``     picture, animate, window      ``setting``  what stays the same from one instant to the next
``film``         pages in time as one file     ``timing``   which instants of a run they show
``interactive``  the window itself
"""

from .film import require_folder
from .pictures import ViewError, animate, picture, render, window
from .setting import as_told
from .timing import Timing

__all__ = ["Timing", "ViewError", "animate", "as_told", "picture", "render", "require_folder", "window"]
