"""The renderer: hoop, disk, floor and arrows as pyvista actors that follow one shot after the other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..fields import BIQUADRATIC_QUAD
from . import style
from .display import choose_window
from .scales import scalar
from .shots import Shot

Array = NDArray[np.float64]
# a nine-node quad as four straight ones, whose corners are all nodes: nothing of the curve is lost
_SPLIT = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])
#: height of a view that shows the whole hoop, in radii
VIEW_HEIGHT = 2.45

#: share of the height of a view that lies above the floor
ABOVE_FLOOR = 0.93

# what lies over what
_LAYERS = {
    "floor": -0.04,
    "ghost": -0.02,
    "ring": 0.0,
    "edge": 0.01,
    "disk": 0.02,
    "halo": 0.03,
    "arrow": 0.04,
}


@dataclass(frozen=True)
class Colours:
    """What the ring is coloured by and over which range."""

    field: str
    low: float
    high: float


class Renderer:
    """A pyvista plotter that shows shots.

    Parameters
    ----------
    first : Shot
        Sets the connectivities, which all shots share.
    size : (width, height)
        In pixels.
    zoom : float
        1 shows the whole hoop, more a part of it about the contact.
    colours : Colours or None
        None for a ring of one colour.
    largest : mapping
        Largest "force" and "slip" of the run: they are drawn 0.7 and 0.5 radii long. With a "usual" force,
        lengths of forces go by the logarithm beyond it.
    finer : int
        Pictures are drawn so many times as fine and averaged; 0 for a window on the screen.
    above : float
        Share of the height of the view that lies above the floor.
    """

    def __init__(
        self,
        first: Shot,
        size: tuple[int, int],
        zoom: float,
        colours: Colours | None,
        largest: Mapping[str, float],
        finer: int = 1,
        above: float = ABOVE_FLOOR,
    ) -> None:
        choose_window(off_screen := finer > 0)
        import pyvista

        self.size, self.zoom, self.colours, self.largest = size, zoom, colours, largest
        self.R, self.above, self.finer = first.radius, above, finer
        #: of the view, in the world's unit of length
        self.height = VIEW_HEIGHT * self.R / zoom
        options: dict[str, Any] = {"window_size": list(size), "lighting": "none", "border": False}
        plotter: Any = pyvista.Plotter(off_screen=off_screen, **options)
        plotter.set_background(style.PAPER)
        plotter.enable_parallel_projection()
        if off_screen:
            plotter.disable_anti_aliasing()  # pictures are drawn finer and averaged, which is faster
        self.plotter = plotter
        width = max(1.0, max(finer, 1) * size[1] / 500)

        faces = first.ring.cells
        if first.ring.cell_type == BIQUADRATIC_QUAD:
            faces = faces[:, _SPLIT].reshape(-1, 4)
        edges = _boundary(faces)
        self._ring = _polygons(first.ring.points, faces)
        self._edge, self._ghost = _lines(first.ring.points, edges), _lines(first.ring.points, edges)
        flat: dict[str, Any] = {"lighting": False, "show_scalar_bar": False}
        self.plotter.add_mesh(self._ghost, name="undeformed", color=style.GHOST, line_width=width, **flat)
        self.paint(colours)
        self.plotter.add_mesh(self._edge, name="rim", color=style.EDGE, line_width=0.8 * width, **flat)
        self._disk = None
        if first.disk is not None:
            self._disk = _polygons(first.disk.points, first.disk.cells)
            halves = first.disk.cell_data.get("half", np.zeros(len(first.disk.cells)))
            self._disk.cell_data["half"] = halves
            self.plotter.add_mesh(self._disk, name="disk", scalars="half", cmap=list(style.DISK), clim=[0, 1], **flat)
        self._floor, self._ticks = _polygons(np.zeros((4, 3)), np.array([[0, 1, 2, 3]])), pyvista.PolyData()
        self.plotter.add_mesh(self._floor, name="floor", color=style.FLOOR, **flat)
        self._floor_line = _lines(np.zeros((2, 3)), np.array([[0, 1]]))
        self.plotter.add_mesh(self._floor_line, color=style.FLOOR_EDGE, line_width=1.5 * width, **flat)
        self._ticks = _lines(np.zeros((80, 3)), np.arange(80).reshape(-1, 2))
        self.plotter.add_mesh(self._ticks, color=style.FLOOR_EDGE, line_width=0.8 * width, **flat)
        self._arrows = {}
        for name, colour in (("force", style.FORCE), ("slip", style.SLIP)):
            inked, halo = (_polygons(np.zeros((7, 3)), _ARROW) for _ in range(2))
            self.plotter.add_mesh(inked, color=colour, **flat)
            # paper round it, so that it shows on the disk too
            self.plotter.add_mesh(halo, color=style.PAPER, style="wireframe", line_width=4 * width, **flat)
            self._arrows[name] = inked, halo

    def paint(self, colours: Colours | None) -> None:
        """Colour the ring by another field."""
        self.colours = colours
        options: dict[str, Any] = {"color": style.RING}
        if colours is not None:
            self._ring.point_data["colour"] = np.zeros(self._ring.n_points)
            options = {
                "scalars": "colour",
                "cmap": style.colormap(colours.field),
                "clim": [colours.low, colours.high],
            }
        self.plotter.add_mesh(
            self._ring, name="ring", lighting=False, show_scalar_bar=False, reset_camera=False, **options
        )

    def show(self, shot: Shot, factor: float, middle: float) -> None:
        """Put everything where ``shot`` has it, deformed ``factor`` times, x = ``middle`` in the centre."""
        moved, shift = deformed(shot, factor)
        self._ring.points = _at(moved, "ring")
        self._edge.points = _at(moved, "edge")
        self._ghost.points = _at(np.asarray(shot.ring.points, dtype=float) + shift, "ghost")
        if self.colours is not None:
            self._ring.point_data["colour"] = scalar(shot.ring, self.colours.field)
        if self._disk is not None and shot.disk is not None:
            self._disk.points = _at(np.asarray(shot.disk.points, dtype=float) + shift, "disk")
        self._lay_floor(middle)
        self._point_arrows(shot, factor)
        y = self.height * (self.above - 0.5)
        self.plotter.camera_position = [(middle, y, 10 * self.R), (middle, y, 0.0), (0.0, 1.0, 0.0)]
        self.plotter.camera.parallel_scale = self.height / 2
        self.plotter.camera.clipping_range = (self.R, 20 * self.R)

    def image(self) -> NDArray[np.uint8]:
        """The picture as (height, width, 3) bytes."""
        self.plotter.render()
        # in tiles of the window's size: drawn at once it would take a dozen buffers of its own size
        fine = np.asarray(self.plotter.screenshot(None, return_img=True, scale=self.finer))
        total = np.zeros((self.size[1], self.size[0], 3), dtype=np.uint16)
        for i in range(self.finer):
            for j in range(self.finer):
                total += fine[i :: self.finer, j :: self.finer, :3]
        return (total // self.finer**2).astype(np.uint8)

    def close(self) -> None:
        """Free the renderer."""
        self.plotter.close()

    def _lay_floor(self, middle: float) -> None:
        R, reach = self.R / self.zoom, self.height * self.size[0] / self.size[1]
        left, right = middle - reach, middle + reach
        corners = np.array([[left, -R, 0], [right, -R, 0], [right, 0, 0], [left, 0, 0]], dtype=float)
        self._floor.points = _at(corners, "floor")
        self._floor_line.points = _at(corners[[3, 2]], "edge")
        # marks every half radius (enlarged: less) stay where they are while the view moves on
        x = (np.round(middle / (R / 2)) + np.arange(-20, 20)) * (R / 2)
        ends = np.zeros((40, 2, 3))
        ends[:, :, 0] = x[:, None]
        ends[:, 1, 1] = -0.05 * R
        self._ticks.points = _at(ends.reshape(-1, 3), "edge")

    def _point_arrows(self, shot: Shot, factor: float) -> None:
        R, foot = self.R / self.zoom, np.array([shot.contact(factor), 0.0])
        force = np.array([shot.friction_force or 0.0, shot.normal_force or 0.0])
        slip = np.array([shot.slip_velocity or 0.0, 0.0])
        for name, vector, reach, tail in (
            ("force", force, 0.7 * R, foot),
            ("slip", slip, 0.5 * R, foot - [0.0, 0.1 * R]),
        ):
            largest = self.largest.get(name, 0.0)
            scaled = vector * (reach / largest) if largest > 0 else 0.0 * vector
            usual, length = self.largest.get("usual", 0.0), float(np.hypot(*vector))
            if name == "force" and usual > 0 and length > 0:
                scaled = vector * (reach / length * np.arcsinh(length / usual) / np.arcsinh(largest / usual))
            points = _arrow(tail, scaled, 0.014 * R)
            inked, halo = self._arrows[name]
            inked.points, halo.points = _at(points, "arrow"), _at(points, "halo")


def deformed(shot: Shot, factor: float) -> tuple[Array, Array]:
    """Points displaced ``factor`` times, and the shift that keeps their height over the floor true.

    Exaggeration would lift the hoop off the floor or sink it; hoop and disk are moved up or down as a whole
    so that the lowest point stays where it really is.
    """
    u, points = shot.displacement, np.asarray(shot.ring.points, dtype=float)
    true, shown = points + u, points + factor * u
    shift = np.array([0.0, true[:, 1].min() - shown[:, 1].min(), 0.0])
    return shown + shift, shift


# corners of a flat arrow of length 1 along x: shaft, then head
_ARROW = np.array([[0, 1, 2, 2], [0, 2, 6, 6], [3, 4, 5, 5]])


def _arrow(tail: Array, vector: Array, width: float) -> Array:
    length = float(np.hypot(*vector))
    points = np.zeros((7, 3))
    points[:, :2] = tail
    if length < width:  # shorter than it is wide: no arrow
        return points
    along = vector / length
    aside = np.array([-along[1], along[0]])
    head = min(7 * width, 0.6 * length)
    half = head * 0.32
    neck, tip = tail + along * (length - head), tail + vector
    shaft = min(width, half / 2)
    points[:, :2] = [
        tail + shaft / 2 * aside,
        tail - shaft / 2 * aside,
        neck - shaft / 2 * aside,
        neck - half * aside,
        tip,
        neck + half * aside,
        neck + shaft / 2 * aside,
    ]
    return points


def _at(points: Array, layer: str) -> Array:
    placed = np.array(points, dtype=float)
    placed[:, 2] = _LAYERS[layer]
    return placed


def _polygons(points: Any, faces: Any) -> Any:
    import pyvista

    return pyvista.PolyData.from_regular_faces(np.array(points, dtype=float), np.asarray(faces))


def _lines(points: Any, ends: Any) -> Any:
    import pyvista

    cells = np.column_stack([np.full(len(ends), 2), ends]).ravel()
    return pyvista.PolyData(np.array(points, dtype=float), lines=cells)


def _boundary(faces: Any) -> Any:
    """Edges that belong to one face only."""
    edges = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
    unique, count = np.unique(edges, axis=0, return_counts=True)
    return unique[count == 1]
