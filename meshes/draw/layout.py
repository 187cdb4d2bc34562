"""The layout of a page: the hoop, legend and colour bar above, N(t) and F(t) below with the current time marked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import style
from .logarithmic import logarithmic
from .patch import PatchPlot
from .renderer import ABOVE_FLOOR, Colours
from .shots import Curves, Shot

Image = NDArray[np.uint8]


class Layout:
    """A page that is laid out once and filled in for one shot after the other.

    Parameters
    ----------
    size : (width, height)
        In pixels, both even.
    curves : Curves
        What is drawn below; without any, the view takes the whole height.
    span : (start, stop)
        Of the time axis.
    colours : Colours or None
        Of the colour bar.
    units : mapping
        Units of fields and of "time", "force".
    title : str
        Above the picture.
    shots : sequence of Shot
        Spread over the run, if the contact patch is to be drawn beside the hoop.
    """

    def __init__(
        self,
        size: tuple[int, int],
        curves: Curves,
        span: tuple[float, float],
        colours: Colours | None,
        units: dict[str, str],
        title: str,
        shots: Sequence[Shot] = (),
    ) -> None:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure

        self.size, self.curves, self.span = size, curves, span
        self.units = {**style.UNITS, **units}
        width, height = size
        # type is set for a page 1280 wide and shrinks less than the page does, so that it stays legible
        self.type = 13.0 * max(0.74, min(width / 1280, height / 900) ** 0.75)
        self.figure = Figure(figsize=(width / 100, height / 100), dpi=100, facecolor=style.PAPER)
        self.canvas = FigureCanvasAgg(self.figure)
        duration = span[1] - span[0]
        #: of the printed time: a thousandth of the run shows
        self.decimals = _decimals(duration / 1000)
        self._moving: list[Any] = []
        self._marks: list[tuple[Any, Any, Any, Any]] = []
        em = self.type * 100 / 72
        drawn = len(curves.t) > 0
        below = round(0.31 * height) if drawn else 0
        top = round(2.6 * em)
        #: pixels at the right of the view that the colour bar covers
        self.covered = round(6.2 * em) if colours else 0
        #: left, top, width and height of the view in pixels
        self.view_box = (0, top, width // 2 * 2, (height - top - below) // 2 * 2)
        room = width - 2.4 * em
        if colours is not None:
            room -= self._colour_bar(colours, em) + em
        #: pixels between which the line of the title is free
        self._free = (self._title(title, room, em), width - (width - 2.4 * em - room) - 1.2 * em)
        if drawn:
            self._curves(below, em)
        self._over: list[tuple[tuple[slice, slice], Image, Any]] = []
        #: pixels at the left of the view that the patch covers
        self.aside = 0
        self._plot: PatchPlot | None = None
        if shots:
            self._patch(shots, em)
        left, y = 1.2 * em, top + 1.3 * em
        self._time = self._text(left, y, "", color=style.INK, moving=True)
        self._phase = self._text(left, y + 1.5 * em, "", color=style.INK, moving=True)
        self._force = self._text(left, y + 3.2 * em, "", color=style.FORCE, moving=True)
        self._slip = self._text(left, y + 4.7 * em, "", color=style.SLIP, moving=True)
        # beside the deformed hoop, low, where nothing else is
        low = top + self.view_box[3] * ABOVE_FLOOR - 0.8 * em
        self._factor = self._text(left, low, "", color=style.FAINT, moving=True)
        caption = {"color": style.FAINT, "ha": "center", "va": "center", "fontsize": 0.8 * self.type}
        self._lens, self._under = self._text(0, 0, "", moving=True, **caption), 0.9 * em
        self.canvas.draw()
        self._blank = self.canvas.copy_from_bbox(self.figure.bbox)
        self._keep_ink()

    def _keep_ink(self) -> None:
        """Keep what stands still and is drawn over the view: colour bar, axes of the patch."""
        _, top, width, height = self.view_box
        foot = top + int(height * ABOVE_FLOOR) - 4
        page = np.asarray(self.canvas.buffer_rgba())
        self._over = []
        # of what is enlarged something may lie under the bar, whose strip stays blank
        for columns, blank in ((slice(width - self.covered, width), True), (slice(0, self.aside), False)):
            box = (slice(top, foot), columns)
            drawn = np.array(page[box])
            self._over.append((box, drawn, blank | np.any(drawn[..., :3] < 255, axis=2)))

    def fill(self, view: Image, shot: Shot, factor: float, lens: tuple[float, float, str] | None = None) -> Image:
        """The page with this view of the hoop, as (height, width, 3) bytes; ``lens`` is column, row, caption."""
        self.canvas.restore_region(self._blank)
        left, top, width, height = self.view_box
        page = np.asarray(self.canvas.buffer_rgba())
        page[top : top + height, left : left + width, :3] = view
        for box, drawn, inked in self._over:
            page[box][inked] = drawn[inked]
        self._time.set_text(self.stamp(shot.time))
        kind = self.curves.phase(shot.time)
        words, band = style.PHASES.get(kind, (kind, style.PAPER)) if kind else ("", style.PAPER)
        self._phase.set_text(words)
        self._phase.set_bbox({"facecolor": band, "edgecolor": "none", "pad": 0.25 * self.type})
        how = "" if self.curves.usual is None else " (log)"
        self._force.set_text("" if not shot.normal_force else f"↑ contact force{how}")
        self._slip.set_text("" if kind == "roll" or not shot.slip_velocity else "→ slip velocity")
        rigid = "displacement" not in shot.ring.point_data
        self._factor.set_text("" if rigid else f"deformation × {factor:g}")
        self._lens.set_text("" if lens is None else lens[2])
        if lens is not None:
            x, y = lens[0] / self.size[0], 1 - (top + lens[1] + self._under) / self.size[1]
            self._lens.set_position((x, y))
        if self._plot is not None:
            self._plot.show(shot)
        for line, dot, t, values in self._marks:
            line.set_xdata([shot.time, shot.time])
            dot.set_data([shot.time], [np.interp(shot.time, t, values)])
        for artist in self._moving:
            (artist.axes or self.figure).draw_artist(artist)
        return np.array(np.asarray(self.canvas.buffer_rgba())[..., :3])

    def stamp(self, time: float) -> str:
        """A time as it is printed, with its unit."""
        return f"t = {time:.{self.decimals}f} {self.units['time']}"

    def tell_apart(self, times: Sequence[float]) -> None:
        """Print times with as many digits as these need to differ; a millionth of the run is no difference."""
        between = np.diff(np.unique(times))
        between = between[between > 1e-6 * (self.span[1] - self.span[0])]
        if len(between):
            self.decimals = max(self.decimals, _decimals(float(between.min())))

    def caption_size(self, text: str) -> tuple[float, float]:
        """Width of a caption below the lens, and how far below it that ends, in pixels."""
        self._lens.set_text(text)
        box = self._lens.get_window_extent(self.canvas.get_renderer())
        return float(box.width), self._under + float(box.height) / 2

    def note(self, text: str) -> None:
        """Print a line beside the title, or below it where it would not fit, on every page from now on."""
        em, top = self.type * 100 / 72, self.view_box[1]
        left, right = self._free
        form = {"color": style.FAINT, "va": "center", "fontsize": 0.8 * self.type}
        printed = self._text(left + 1.5 * em, top * 0.62, text, moving=True, **form)
        if printed.get_window_extent(self.canvas.get_renderer()).x1 > right - em:
            printed.set(x=0.5, y=1 - (top + 1.3 * em) / self.size[1], ha="center")
        self.canvas.draw()
        self._blank = self.canvas.copy_from_bbox(self.figure.bbox)

    def _text(self, x: float, y: float, text: str, *, moving: bool = False, **form: Any) -> Any:
        form.setdefault("fontsize", self.type)
        artist = self.figure.text(x / self.size[0], 1 - y / self.size[1], text, animated=moving, **form)
        if moving:
            self._moving.append(artist)
        return artist

    def _axes(self, left: float, top: float, width: float, height: float) -> Any:
        w, h = self.size
        return self.figure.add_axes((left / w, 1 - (top + height) / h, width / w, height / h))

    def _title(self, title: str, room: float, em: float) -> float:
        """The title, in smaller type where it would not fit; where it ends, in pixels."""
        top = self.view_box[1]
        printed = self._text(1.2 * em, top * 0.62, title, color=style.INK, weight="bold", va="center")
        end = 1.2 * em
        for _ in range(3):  # hinted letters do not shrink in proportion
            end = float(printed.get_window_extent(self.canvas.get_renderer()).x1)
            needed = end - 1.2 * em
            if needed <= room:
                break
            printed.set_fontsize(max(0.6 * self.type, 0.99 * room / needed * printed.get_fontsize()))
        return end

    def _patch(self, shots: Sequence[Shot], em: float) -> None:
        """Axes at the left, below the legend, where the hoop does not come."""
        _, top, width, height = self.view_box
        start, foot = 10.2 * em, height * ABOVE_FLOOR - 6.2 * em
        high, wide = min(foot - start, 0.34 * height), max(0.17 * width, 11.5 * em)
        if high > 4 * em:
            axes = self._axes(3.2 * em, top + foot - high, wide, high)
            self._plot = PatchPlot(axes, list(shots), self.units, self.type)
            self._moving += self._plot.moving
            self.aside = round(3.2 * em + wide + em)

    def _colour_bar(self, colours: Colours, em: float) -> float:
        """Draw it; how wide its name is, in pixels."""
        from matplotlib.cm import ScalarMappable
        from matplotlib.colors import Normalize
        from matplotlib.ticker import MaxNLocator

        _, top, width, height = self.view_box
        axes = self._axes(width - 5.2 * em, top + 0.8 * em, 0.9 * em, height * ABOVE_FLOOR - 1.8 * em)
        mapped = ScalarMappable(Normalize(colours.low, colours.high), style.colormap(colours.field))
        signed = style.signed(colours.field)
        bar = self.figure.colorbar(mapped, cax=axes, extend="both" if signed else "max", ticks=MaxNLocator(5))
        bar.outline.set_visible(False)
        axes.tick_params(labelsize=0.85 * self.type, length=3, color=style.FAINT, labelcolor=style.INK)
        largest = max(abs(colours.low), abs(colours.high))
        power = int(np.floor(np.log10(largest))) if largest > 0 else 0
        power = 0 if -2 <= power < 4 else power
        axes.yaxis.set_major_formatter(lambda value, _: f"{value / 10.0**power:g}")
        ten = f"$10^{{{power}}}$" if power else ""
        unit = " ".join(filter(None, [ten, style.unit(colours.field, self.units)]))
        name = style.label(colours.field) + (f"  [{unit}]" if unit else "")
        form: dict[str, Any] = {"color": style.INK, "ha": "right", "va": "center"}
        printed = self._text(self.size[0] - 1.2 * em, top * 0.62, name, **form)
        return float(printed.get_window_extent(self.canvas.get_renderer()).width)

    def _curves(self, below: int, em: float) -> None:
        start = self.size[1] - below + 1.2 * em
        left, right, foot, gap = 5.2 * em, 1.6 * em, 3.1 * em, 0.7 * em
        #: first and last pixel of the time axis
        self.time_axis = left, self.size[0] - right
        height = (below - 1.2 * em - foot - gap) / 2
        curves = self.curves
        for row, (values, colour, name) in enumerate(
            [
                (curves.normal_force, style.NORMAL, "N"),
                (curves.friction_force, style.FRICTION, "F"),
            ]
        ):
            axes = self._axes(left, start + row * (height + gap), self.size[0] - left - right, height)
            for kind, t0, t1 in curves.phases:
                if t1 > t0:
                    axes.axvspan(t0, t1, color=style.PHASES.get(kind, ("", "#f2f2f2"))[1], lw=0, zorder=0)
            axes.axhline(0, color=style.FAINT, lw=0.6, zorder=1)
            axes.plot(curves.t, values, color=colour, lw=0.13 * self.type, zorder=3)
            if self.span[0] < self.span[1]:  # a single frame has no span
                axes.set_xlim(*self.span)
            low, high = float(np.nanmin(values)), float(np.nanmax(values))
            room = 0.12 * ((high - low) or 1.0)
            axes.set_ylim(min(low, 0.0) - room, max(high, 0.0) + room)
            axes.locator_params(axis="y", nbins=3)
            if curves.usual is not None:
                logarithmic(axes, curves.usual, low, high, self.type)
            for side in ("top", "right"):
                axes.spines[side].set_visible(False)
            for side in ("left", "bottom"):
                axes.spines[side].set_color(style.FAINT)
            axes.tick_params(labelsize=0.85 * self.type, color=style.FAINT, labelcolor=style.INK, length=3)
            if row == 0:
                axes.tick_params(labelbottom=False)
            else:
                axes.set_xlabel(f"t  [{self.units['time']}]", fontsize=self.type, color=style.INK, labelpad=1)
            axes.set_ylabel(f"{name}  [{self.units['force']}]", fontsize=self.type, color=colour)
            axes.yaxis.set_label_coords(-3.6 * em / (self.size[0] - left - right), 0.5)
            line = axes.axvline(0, color=style.INK, lw=0.07 * self.type, zorder=4, animated=True)
            (dot,) = axes.plot([], [], "o", color=colour, zorder=5, animated=True)
            dot.set(markersize=0.42 * self.type, markeredgecolor="white", markeredgewidth=0.04 * self.type)
            self._moving += [line, dot]
            self._marks.append((line, dot, curves.t, values))


def _decimals(step: float) -> int:
    """Digits behind the point that show such a step, 4 at least."""
    return min(max(4, int(np.ceil(-np.log10(step)))), 15) if step > 0 else 4
