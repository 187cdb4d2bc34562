"""The ring as a mesh, fields in time as files, and pictures of both.

``ring``     the annulus: curved quads, grading, named boundaries, quality
``corner``   its columns about an end of the weld, cut finer
``gradient`` gradients of nodal fields at the nodes and the Gauss points
``placing``  from the disk's frame to the world; von Mises, hoop and bending stress
``times``    which instants become frames
``fields``   a frame: ring, rim, disk and floor at one instant, as plain arrays
``vtu``      a block to a VTU file and back
``series``   frames in time to PVD + VTU and back
``exchange`` the mesh to other programs, by meshio
``view``     pictures, animations and a window: ``picture``, ``animate``, ``window`` (not loaded here)
``draw``     what these are made of
"""

from typing import TYPE_CHECKING

from .exchange import save_mesh
from .fields import Block, Frame, SeriesError, disk_block, floor_block, rim_block, ring_block
from .gradient import gauss_gradient, nodal_gradient
from .placing import Placement, bending_stress, hoop_stress, von_mises
from .ring import MeshError, Quality, RingMesh, ring_mesh
from .series import Series, SeriesWriter, read
from .times import frame_times

if TYPE_CHECKING:
    __version__: str


def __getattr__(name: str) -> object:
    if name == "__version__":
        import rigid

        return rigid.__version__
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)


__all__ = [
    "Block",
    "Frame",
    "MeshError",
    "Placement",
    "Quality",
    "RingMesh",
    "Series",
    "SeriesError",
    "SeriesWriter",
    "__version__",
    "bending_stress",
    "disk_block",
    "floor_block",
    "frame_times",
    "gauss_gradient",
    "hoop_stress",
    "nodal_gradient",
    "read",
    "rim_block",
    "ring_block",
    "ring_mesh",
    "save_mesh",
    "von_mises",
]
