"""The window: a renderer on the screen with a time slider and keys."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..draw import style
from ..draw.layout import Image, Layout
from ..draw.lens import Lens, enlargement
from ..draw.renderer import ABOVE_FLOOR, Colours, Renderer
from ..draw.scales import field_names, limits, sampled
from ..draw.shots import Shot
from .setting import Setting

HELP = "space plays, left and right step, [ and ] change the deformation, c the colours, q quits"
"""What the keys do; + and - do as [ and ]."""
_STEPS = 200


class Window:
    """What the slider and the keys act on; the view follows the hoop.

    The text, the colour bar and the curves are the same layout as in a picture, laid over the view.

    Parameters
    ----------
    chosen : Setting
        As :func:`meshes.view.setting.setting` makes it.
    off_screen : bool
        True to try it out where there is no screen.
    size : (width, height)
        In pixels.
    """

    def __init__(self, chosen: Setting, off_screen: bool = False, size: tuple[int, int] = (1280, 900)) -> None:
        self.setting, self.size = chosen, size
        self.factor, self.colours, self.span = chosen.factor, chosen.colours, chosen.source.span
        self.time, self.playing = self.span[0], False
        self.fields = field_names(chosen.first.ring)
        self._lay_out()
        zoom = chosen.zoom * self.layout.view_box[3] / size[1]
        self.renderer = Renderer(chosen.first, size, zoom, chosen.colours, chosen.largest, finer=1 if off_screen else 0)
        self.plotter: Any = self.renderer.plotter
        self.plotter.title = "hoop-pulse"
        self._overlay = Overlay(self.plotter, size, self.layout.view_box)
        self.lens: Lens | None = None
        self._look_closer()
        left, right = (x / size[0] for x in self.layout.time_axis)
        _, top, _, height = self.layout.view_box
        y = 1 - (top + (1 + 2 * ABOVE_FLOOR) / 3 * height) / size[1]  # on the floor
        self.slider = self.plotter.add_slider_widget(
            self.go, list(self.span), value=self.time, pointa=(left, y), pointb=(right, y),
            color=style.NORMAL, slider_width=0.014, tube_width=0.002, interaction_event="always",
        )  # fmt: skip
        knob = self.slider.GetRepresentation()
        knob.SetSliderLength(0.008)
        knob.SetEndCapLength(0.0)
        knob.ShowSliderLabelOff()
        for key, action in (
            ("space", self.play),
            ("Right", lambda: self.step(1)),
            ("Left", lambda: self.step(-1)),
            *((key, lambda: self.exaggerate(2.0)) for key in ("bracketright", "plus")),
            *((key, lambda: self.exaggerate(0.5)) for key in ("bracketleft", "minus")),
            ("c", self.next_field),
        ):
            self.plotter.clear_events_for_key(key, raise_on_missing=False)
            self.plotter.add_key_event(key, action)
        self.go(self.time)

    def open(self) -> None:
        """Show the window until it is closed."""
        self.plotter.add_timer_event(max_steps=2**31 - 1, duration=40, callback=self._tick)
        self.plotter.show()

    def go(self, time: float) -> None:
        """Show the instant ``time``."""
        self.time = float(np.clip(time, *self.span))
        shot = self.setting.source.shot(self.time)
        self.renderer.show(shot, self.factor, float(shot.centre[0]))
        # from the renderer's own framing to that of the upper part of the window
        camera, (_, top, _, height) = self.plotter.camera, self.layout.view_box
        floor = (top + ABOVE_FLOOR * height) / self.size[1]
        y = self.renderer.height * (floor - 0.5)
        camera.position = (camera.position[0], y, camera.position[2])
        camera.focal_point = (camera.focal_point[0], y, 0.0)
        self._overlay.show(self.page(shot))
        self.plotter.render()

    def page(self, shot: Shot) -> Image:
        """What lies over the view: text, curves, patch and lens on white paper, (height, width, 3) bytes."""
        view, caption = self._paper, None
        if self.lens is not None and self.lens.fits(shot, self.factor):
            view = self._paper.copy()
            caption = self.lens.draw(view, shot, view.shape[1] / 2, ABOVE_FLOOR * view.shape[0])
        return self.layout.fill(view, shot, self.factor, caption)

    def close(self) -> None:
        """Free what draws."""
        self.renderer.close()
        if self.lens is not None:
            self.lens.renderer.close()

    def play(self) -> None:
        """Start or stop."""
        self.playing = not self.playing

    def step(self, steps: int) -> None:
        """Go on by so many two-hundredths of the run, round at the end."""
        start, stop = self.span
        time = start + (self.time - start + steps * (stop - start) / _STEPS) % (stop - start)
        self.slider.GetRepresentation().SetValue(time)
        self.go(time)

    def exaggerate(self, ratio: float) -> None:
        """Change the display factor."""
        self.factor *= ratio
        self.go(self.time)

    def next_field(self) -> None:
        """Colour by the next field of the series."""
        if self.colours is None:
            return
        field = self.fields[(self.fields.index(self.colours.field) + 1) % len(self.fields)]
        shots = sampled(self.setting.source, 12)
        self.colours = Colours(field, *limits(shots, field, style.signed(field)))
        self.renderer.paint(self.colours)
        self._lay_out()
        self._look_closer()
        self.go(self.time)

    def _tick(self, _: int) -> None:
        if self.playing:
            self.step(1)

    def _lay_out(self) -> None:
        source = self.setting.source
        patches = self.setting.patches if self.setting.zoom == 1 else ()
        self.layout = Layout(self.size, source.curves, self.span, self.colours, source.units, source.title, patches)
        self.layout.note(HELP)
        self._paper = np.full((*self.layout.view_box[3:1:-1], 3), 255, dtype=np.uint8)

    def _look_closer(self) -> None:
        """A lens in the colours of the ring, where a picture has one."""
        if self.lens is not None:
            self.lens.renderer.close()
        chosen, self.lens = self.setting, None
        if self.colours is not None and chosen.zoom == 1 and enlargement(chosen.first) >= 2:
            scale = self.size[1] / self.renderer.height
            measure = self.layout.caption_size
            self.lens = Lens(chosen.first, scale, self.colours, chosen.lens_factor, measure)


class Overlay:
    """A page laid over the whole window, transparent where it is white and the view lies under it."""

    def __init__(self, plotter: Any, size: tuple[int, int], box: tuple[int, int, int, int]) -> None:
        import pyvista
        from vtkmodules.vtkRenderingCore import (
            vtkCoordinate,
            vtkPolyDataMapper2D,
            vtkTexture,
            vtkTexturedActor2D,
        )

        width, height = size
        left, top, across, down = box
        self._view = np.zeros((height, width, 1), dtype=bool)
        self._view[top : top + down, left : left + across] = True
        self._image = pyvista.ImageData(dimensions=(width, height, 1))
        self._image.point_data["page"] = np.zeros((width * height, 4), dtype=np.uint8)
        corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], dtype=float)
        square = pyvista.PolyData.from_regular_faces(corners, np.array([[0, 1, 2, 3]]))
        square.active_texture_coordinates = corners[:, :2]
        place = vtkCoordinate()
        place.SetCoordinateSystemToNormalizedViewport()
        mapper = vtkPolyDataMapper2D()
        mapper.SetInputData(square)
        mapper.SetTransformCoordinate(place)
        self._texture = vtkTexture()
        self._texture.SetInputDataObject(self._image)
        self._texture.InterpolateOn()
        actor = vtkTexturedActor2D()
        actor.SetMapper(mapper)
        actor.SetTexture(self._texture)
        plotter.add_actor(actor, name="overlay", reset_camera=False, pickable=False)

    def show(self, page: Any) -> None:
        """Lay ``page`` (height, width, 3) over the window."""
        clear = (page == 255).all(axis=2, keepdims=True) & self._view
        coloured = np.concatenate([page, np.where(clear, 0, 255).astype(np.uint8)], axis=2)
        self._image.point_data["page"] = coloured[::-1].reshape(-1, 4)
        self._image.point_data.active_scalars_name = "page"
        self._texture.Modified()
