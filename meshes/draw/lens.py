"""The lens: what is about the contact, enlarged, in the empty middle of the hoop."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import style
from .renderer import VIEW_HEIGHT, Colours, Renderer
from .shots import Shot

Image = NDArray[np.uint8]

_RADIUS = 0.45  # of the lens, in radii of the hoop
_HEIGHT = 1.32  # of its centre over the floor
_ABOVE_FLOOR = 0.7


def enlargement(shot: Shot) -> int:
    """How many times the lens enlarges: so that the wall fills an eighth of it; below 2 there is no lens."""
    inner = np.linalg.norm(np.asarray(shot.ring.points, dtype=float)[:, :2] - shot.centre, axis=1).min()
    wall = max(1 - float(inner) / shot.radius, 0.012)
    return max(1, int(2 * _RADIUS / (7.5 * wall)))


class Lens:
    """Draws the round enlargement into views of the hoop.

    Parameters
    ----------
    first : Shot
    scale : float
        Pixels per unit of length in the picture that it is put in.
    colours : Colours
    factor : float
        Exaggeration of the deformation inside the lens.
    """

    def __init__(self, first: Shot, scale: float, colours: Colours, factor: float) -> None:
        self.times, self.factor, self.scale = enlargement(first), factor, scale
        self.size = round(2 * _RADIUS * first.radius * scale)
        zoom = VIEW_HEIGHT / (2 * _RADIUS) * self.times
        self.renderer = Renderer(first, (self.size, self.size), zoom, colours, {}, finer=2, above=_ABOVE_FLOOR)
        x = np.arange(self.size) - (self.size - 1) / 2
        outside = np.hypot(x[:, None], x[None, :]) - self.size / 2
        self._inside = np.clip(-1.5 - outside, 0, 1)[..., None]
        self._border = np.clip(-outside, 0, 1)[..., None] - self._inside

    def fits(self, shot: Shot) -> bool:
        """Whether the disk leaves the middle of the hoop free."""
        if shot.disk is None:
            return True
        points = np.asarray(shot.disk.points, dtype=float)[:, :2]
        centre = np.array([shot.centre[0], _HEIGHT * shot.radius])
        return bool(np.linalg.norm(points - centre, axis=1).min() > (_RADIUS + 0.05) * shot.radius)

    def draw(self, picture: Image, shot: Shot, column: float, floor: float) -> tuple[float, float, str]:
        """Put the lens into ``picture``, which has the hoop's centre at ``column`` and the floor at row ``floor``.

        Returns
        -------
        column, row, caption
            What to print below the lens and where.
        """
        self.renderer.show(shot, self.factor, shot.contact(self.factor))
        enlarged = self.renderer.image()
        middle = floor - _HEIGHT * shot.radius * self.scale
        top, left = round(middle - self.size / 2), round(column - self.size / 2)
        rows = slice(max(top, 0), min(top + self.size, picture.shape[0]))
        columns = slice(max(left, 0), min(left + self.size, picture.shape[1]))
        part = (slice(rows.start - top, rows.stop - top), slice(columns.start - left, columns.stop - left))
        inside, border = self._inside[part], self._border[part]
        rim = np.array([int(style.FAINT[i : i + 2], 16) for i in (1, 3, 5)])
        under = picture[rows, columns]
        mixed = inside * enlarged[part] + border * rim + (1 - inside - border) * under
        picture[rows, columns] = mixed.round().astype(np.uint8)
        caption = f"{self.times} times closer, deformation × {self.factor:g}"
        return column, middle + self.size / 2, caption
