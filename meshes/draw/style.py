"""Colours, names and symbols of the pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from matplotlib.colors import Colormap

PAPER = "#ffffff"
INK = "#2b2f36"
FAINT = "#6f767f"
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


class Field(NamedTuple):
    """What a field is called in print, of which kind its unit is, and whether its scale diverges about zero."""

    label: str
    kind: str
    signed: bool = False


#: the fields of a flexible run, of the stress each component
FIELDS = {
    "displacement": Field("displacement", "length"),
    "velocity": Field("velocity", "velocity"),
    "von_mises": Field("von Mises stress", "stress"),
    "hoop_stress": Field("hoop stress", "stress", signed=True),
    "bending_stress": Field("bending stress", "stress", signed=True),
    "stress xx": Field("stress σxx", "stress", signed=True),
    "stress yy": Field("stress σyy", "stress", signed=True),
    "stress xy": Field("stress σxy", "stress", signed=True),
    "energy_density": Field("strain energy density", "energy_density"),
    "pressure": Field("contact pressure", "stress"),
    "traction": Field("friction traction", "stress"),
}

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
    """What to call a field in print; a field that is not ours goes by its own name."""
    return FIELDS[field].label if field in FIELDS else field.replace("_", " ")


def unit(field: str, units: dict[str, str]) -> str:
    """Unit of a field: its own if ``units`` names it, or that of its kind; a field that is not ours has none else."""
    if field in units or field not in FIELDS:
        return units.get(field, "")
    return {**UNITS, **units}[FIELDS[field].kind]


def signed(field: str) -> bool:
    """Whether the scale of a field diverges about zero."""
    return field in FIELDS and FIELDS[field].signed


def colormap(field: str) -> Colormap:
    """A sequential map from steel to ember, or a diverging one with grey at zero; both show on white."""
    from matplotlib.colors import LinearSegmentedColormap

    if signed(field):
        stops = ["#1d4e89", "#5f94c4", "#b9bec5", "#e08a5a", "#a12a1e"]
        return LinearSegmentedColormap.from_list("tension", stops)
    stops = ["#8fa3b8", "#9c9fb5", "#c99a8a", "#e8854a", "#cf3f2b", "#7a1230"]
    return LinearSegmentedColormap.from_list("ember", stops)
