"""The lens: what is about the contact, enlarged, in the empty middle of the hoop."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from . import style
from .renderer import VIEW_HEIGHT, Colours, Renderer, deformed
from .shots import Shot

Image = NDArray[np.uint8]

_RADIUS = 0.45  # of the lens, in radii of the hoop
_HEIGHT = 1.32  # of its centre over the floor
_ABOVE_FLOOR = 0.7
_CLEAR = 0.05  # between disk and lens or what is printed below it, in radii


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
    measure : callable
        Width and height, in pixels, that a caption takes below the lens.
    """

    def __init__(
        self,
        first: Shot,
        scale: float,
        colours: Colours,
        factor: float,
        measure: Callable[[str], tuple[float, float]],
    ) -> None:
        self.times, self.factor, self.scale = enlargement(first), factor, scale
        self.caption = f"{self.times} times closer, deformation × {factor:g}"
        self._wide, self._deep = measure(self.caption)
        self.size = round(2 * _RADIUS * first.radius * scale)
        zoom = VIEW_HEIGHT / (2 * _RADIUS) * self.times
        self.renderer = Renderer(first, (self.size, self.size), zoom, colours, {}, finer=2, above=_ABOVE_FLOOR)
        x = np.arange(self.size) - (self.size - 1) / 2
        outside = np.hypot(x[:, None], x[None, :]) - self.size / 2
        self._inside = np.clip(-1.5 - outside, 0, 1)[..., None]
        self._border = np.clip(-outside, 0, 1)[..., None] - self._inside

    def fits(self, shot: Shot, factor: float = 1.0) -> bool:
        """Whether there is some of the rim to enlarge, and the disk leaves the middle of the hoop free.

        ``factor`` is the exaggeration outside the lens, which moves the disk up or down.
        """
        return self._holds_rim(shot) and (shot.disk is None or self._is_clear_of(shot, factor))

    def _holds_rim(self, shot: Shot) -> bool:
        height = self.renderer.height
        middle = np.array([shot.contact(self.factor), height * (_ABOVE_FLOOR - 0.5)])
        away = deformed(shot, self.factor)[0][:, :2] - middle
        return bool((np.hypot(*away.T) < height / 2).any())

    def _is_clear_of(self, shot: Shot, factor: float) -> bool:
        """Whether the disk, a circle, is off the lens and off the rectangle of its caption."""
        assert shot.disk is not None
        points = np.asarray(shot.disk.points, dtype=float)[:, :2]
        low, high = points.min(axis=0), points.max(axis=0)
        radius = float((high - low).max() / 2)
        middle = (low + high) / 2 + deformed(shot, factor)[1][:2]
        across, up = abs(middle[0] - shot.centre[0]), middle[1]
        lens = np.hypot(across, up - _HEIGHT * shot.radius) - _RADIUS * shot.radius
        top = _HEIGHT * shot.radius - self.size / 2 / self.scale
        aside = max(across - self._wide / 2 / self.scale, 0.0)
        caption = np.hypot(aside, up - np.clip(up, top - self._deep / self.scale, top))
        return bool(min(lens, caption) > radius + _CLEAR * shot.radius)

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
        return column, middle + self.size / 2, self.caption
