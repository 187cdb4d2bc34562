"""Colours, names and symbols of the pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from matplotlib.colors import Colormap

PAPER = "#ffffff"
INK = "#2b2f36"
FAINT = "#8d939c"
RING = "#5b6b7d"  # a ring without a field
EDGE = "#2f3945"
GHOST = "#c9ced5"
DISK = ("#4a5563", "#6b7785")  # its two halves
FLOOR = "#e9e6e1"
FLOOR_EDGE = "#77726a"
NORMAL = "#1f5a94"
FRICTION = "#c8641b"
FORCE = "#222222"
SLIP = "#2a8c7f"

#: kind of a phase -> words, colour of its band
PHASES = {
    "roll": ("stick (rolling)", "#e3efe4"),
    "skid": ("slip (skidding forward)", "#f8e6dc"),
    "spin": ("slip (spinning backward)", "#fbf0d5"),
    "flight": ("off the floor", "#dfeaf6"),
    "skim": ("skimming, no force", "#eeeeee"),
    "impact": ("impact", "#f3d3d3"),
}

#: field -> what it is; the ones in SIGNED get a diverging scale about zero
LABELS = {
    "displacement": "displacement",
    "velocity": "velocity",
    "von_mises": "von Mises stress",
    "hoop_stress": "hoop stress",
    "bending_stress": "bending stress",
    "stress xx": "stress σxx",
    "stress yy": "stress σyy",
    "stress xy": "stress σxy",
    "energy_density": "strain energy density",
    "pressure": "contact pressure",
    "traction": "friction traction",
}
SIGNED = ("hoop_stress", "bending_stress", "stress xx", "stress yy", "stress xy")

#: units of the paper's scaling
UNITS = {
    "length": "R",
    "time": "√(R/g)",
    "force": "m g",
    "velocity": "√(g R)",
    "stress": "m g/R²",
    "energy_density": "m g/R²",
}
SI_UNITS = {
    "length": "m",
    "time": "s",
    "force": "N",
    "velocity": "m/s",
    "stress": "Pa",
    "energy_density": "J/m³",
}


def label(field: str) -> str:
    """What to call a field in print."""
    return LABELS.get(field, field.replace("_", " "))


def unit(field: str, units: dict[str, str]) -> str:
    """Unit of a field: its own if ``units`` names it, or that of its kind."""
    if field in units:
        return units[field]
    kind = {"displacement": "length", "velocity": "velocity", "energy_density": "energy_density"}.get(field)
    if kind is None and (field in ("von_mises", "pressure", "traction") or "stress" in field):
        kind = "stress"
    return {**UNITS, **units}.get(kind or "", "")


def colormap(field: str) -> Colormap:
    """A sequential map from steel to ember, or a diverging one with grey at zero; both show on white."""
    from matplotlib.colors import LinearSegmentedColormap

    if field in SIGNED:
        stops = ["#1d4e89", "#5f94c4", "#b9bec5", "#e08a5a", "#a12a1e"]
        return LinearSegmentedColormap.from_list("tension", stops)
    stops = ["#8fa3b8", "#9c9fb5", "#c99a8a", "#e8854a", "#cf3f2b", "#7a1230"]
    return LinearSegmentedColormap.from_list("ember", stops)
