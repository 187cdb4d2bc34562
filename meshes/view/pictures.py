"""Pictures, animations and a window, of the fields of a flexible run or of any motion.

::

    from meshes.view import animate, picture

    picture("out", "pulse.png", time=1.8, field="hoop_stress")
    animate(motion, "rolling.gif")

pyvista and matplotlib are loaded when something is drawn and not before.
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rigid import Motion

from ..draw.display import ViewError, require_renderer, require_screen
from ..draw.layout import Layout
from ..draw.lens import Lens, enlargement
from ..draw.renderer import ABOVE_FLOOR, Renderer
from ..draw.shots import Shot, Source
from ..series import Series
from . import film
from .setting import Setting, as_told, setting
from .timing import Timing, instants

Image = NDArray[np.uint8]
Progress = Callable[[int, int], None]

SMALLEST = 320, 240  # pixels on which there is room for a view between title and curves

__all__ = ["Timing", "ViewError", "animate", "picture", "render", "window"]


class Camera:
    """Draws the pages of one setting at one size, from views ``oversampling`` times as fine."""

    def __init__(self, chosen: Setting, size: tuple[int, int], oversampling: int = 2) -> None:
        require_renderer()
        _ensure_size(size)
        self.setting = chosen
        source = chosen.source
        patches: tuple[Shot, ...] = chosen.patches if chosen.zoom == 1 else ()
        self.layout = Layout(size, source.curves, source.span, chosen.colours, source.units, source.title, patches)
        _, _, width, height = self.layout.view_box
        self.renderer = Renderer(
            chosen.first, (width, height), chosen.zoom, chosen.colours, chosen.largest, finer=oversampling
        )
        self.height = self.renderer.height
        # where the hoop may be: left of the colour bar, right of the patch
        right, left = self.layout.covered, self.layout.aside
        self.width = self.height * (width - right - left) / height
        self.aside = self.height * (right - left) / height / 2
        self.scale = height / self.height
        self.lens = None
        if chosen.colours is not None and chosen.zoom == 1 and enlargement(chosen.first) >= 2:
            measure = self.layout.caption_size
            self.lens = Lens(chosen.first, self.scale, chosen.colours, chosen.lens_factor, measure)

    def __enter__(self) -> Camera:
        return self

    def __exit__(self, *_: object) -> None:
        self.renderer.close()
        if self.lens is not None:
            self.lens.renderer.close()

    def page(self, time: float) -> Image:
        """The page at ``time`` as (height, width, 3) bytes."""
        shot = self.setting.source.shot(time)
        middle = self._middle(shot)
        self.renderer.show(shot, self.setting.factor, middle)
        drawn, caption = self.renderer.image(), None
        if self.setting.zoom > 1:  # what is enlarged ends beside the colour bar, floor and all
            drawn[:, drawn.shape[1] - self.layout.covered :] = 255
        if self.lens is not None and self.lens.fits(shot, self.setting.factor):
            column = drawn.shape[1] / 2 + (float(shot.centre[0]) - middle) * self.scale
            caption = self.lens.draw(drawn, shot, column, ABOVE_FLOOR * drawn.shape[0])
        return self.layout.fill(drawn, shot, self.setting.factor, caption)

    def _middle(self, shot: Shot) -> float:
        """The view stands still if the whole run fits in it, or else goes with the hoop."""
        left, right = self.setting.reach
        if self.layout.aside:  # nothing of the legend is in the way
            left += 0.5 * self.setting.first.radius
        if self.setting.zoom > 1:
            return float(shot.centre[0]) + self.aside
        if right - left <= self.width:
            return (left + right) / 2 + self.aside
        half = self.width / 2
        return float(np.clip(shot.centre[0], left + half, right - half)) + self.aside


def _ensure_size(size: tuple[int, int]) -> None:
    try:
        width, height = (operator.index(each) for each in size)
    except (TypeError, ValueError):
        raise ViewError(f"size = {size!r} is not possible: it is two whole numbers of pixels.") from None
    if width < SMALLEST[0] or height < SMALLEST[1]:
        raise ViewError(f"size = {size!r} is not possible: it takes {SMALLEST[0]} x {SMALLEST[1]} pixels or more.")


def render(
    thing: Series | Motion | str | Path,
    time: float | None = None,
    field: str | None = None,
    factor: float | None = None,
    zoom: float = 1.0,
    size: tuple[int, int] = (1280, 900),
) -> Image:
    """The picture of one instant as (height, width, 3) bytes; see :func:`picture`."""
    chosen = setting(thing, field, factor, zoom)
    start, stop = chosen.source.span
    time = _liveliest(chosen.source) if time is None else as_told(time, (start, stop))
    if not start <= time <= stop:
        raise ViewError(f"time = {time!r} is not possible: the run goes from {start:g} to {stop:g}.")
    with Camera(chosen, size, oversampling=3) as camera:
        return camera.page(time)


def picture(
    thing: Series | Motion | str | Path,
    png: str | Path,
    time: float | None = None,
    field: str | None = None,
    factor: float | None = None,
    zoom: float = 1.0,
    size: tuple[int, int] = (1280, 900),
) -> None:
    """Draw one instant into a PNG file.

    Parameters
    ----------
    thing : Series or Motion or path
        Fields of a flexible run, or the folder they are in, or any motion, drawn undeformed.
    png : path
        Where to; its name ends in .png.
    time : float, optional
        In the run's unit; a series shows the nearest of its frames, from the first to the last. By
        default the instant of the largest N.
    field : str, optional
        What colours the ring: a point field of the series, "stress xx", "stress yy" or "stress xy"; by
        default the von Mises stress.
    factor : float, optional
        Exaggeration of the deformation, printed in the picture; by default the series' own
        ``display_factor``, or one that makes the largest displacement a few per cent of the radius.
    zoom : float
        1 shows the whole hoop, more enlarges what is about the contact.
    size : (width, height)
        In pixels, at least 320 x 240.

    Raises
    ------
    ViewError
        Nothing to draw with, no such field or time, no folder to draw into.
    SeriesError
        A damaged series.
    """
    if Path(png).suffix.lower() != ".png":
        raise ViewError(f"{png} cannot be a picture: its name must end in .png.")
    film.require_folder(Path(png))
    film.write_png(Path(png), render(thing, time, field, factor, zoom, size))


def animate(
    thing: Series | Motion | str | Path,
    path: str | Path,
    field: str | None = None,
    factor: float | None = None,
    zoom: float = 1.0,
    timing: Timing | None = None,
    size: tuple[int, int] | None = None,
    progress: Progress | None = None,
) -> None:
    """Draw the run into a .gif, .mp4 or .html file.

    The page (.html) is one file that needs nothing else: a slider for the time, keys to step and play.

    Parameters
    ----------
    thing, field, factor, zoom
        As for :func:`picture`.
    path : path
        The suffix chooses the kind.
    timing : Timing, optional
        Which instants become how many pictures, and how fast they follow each other.
    size : (width, height), optional
        In pixels; 800 x 600 for a gif, 960 x 720 for a page, 1280 x 900 for a film.
    progress : callable, optional
        Called with the number of pictures done and their total.

    Raises
    ------
    ViewError
        As for :func:`picture`, and for another suffix.
    """
    path = Path(path)
    kind = film.FORMATS.get(path.suffix.lower())
    if kind is None:
        raise ViewError(f"{path} cannot be an animation: its name must end in .gif, .mp4 or .html.")
    film.require_folder(path)
    timing = timing or Timing()
    chosen = setting(thing, field, factor, zoom)
    times = [chosen.source.instant(float(time)) for time in instants(chosen.source, timing, kind.frames)]

    def pages(camera: Camera) -> Iterator[Image]:
        for done, time in enumerate(times, 1):
            yield camera.page(time)
            if progress is not None:
                progress(done, len(times))

    with Camera(chosen, size or kind.size) as camera:
        camera.layout.tell_apart(times)
        kind.write(path, pages(camera), timing.fps, [camera.layout.stamp(time) for time in times])


def window(
    thing: Series | Motion | str | Path, field: str | None = None, factor: float | None = None, zoom: float = 1.0
) -> None:
    """Open a window with a time slider; space plays, [ and ] change the factor, c changes the field.

    Raises
    ------
    ViewError
        No screen, or as for :func:`picture`.
    """
    require_screen()
    from .interactive import Window

    chosen = setting(thing, field, factor, zoom)
    if chosen.source.span[0] == chosen.source.span[1]:
        raise ViewError("a window needs more than one frame: ask for a picture (--png).")
    Window(chosen).open()


def _liveliest(source: Source) -> float:
    curves = source.curves
    if not len(curves.t):
        return source.span[0]
    best: Any = curves.t[int(np.nanargmax(curves.normal_force))]
    return float(np.clip(best, *source.span))
