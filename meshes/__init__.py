"""The ring as a mesh, fields in time as files, and pictures of both.

``ring``    the annulus: curved quads, grading, named boundaries, quality
``fields``  a frame: ring, rim, disk and floor at one instant, as plain arrays
``vtu``     a block to a VTU file and back
``series``  frames in time to PVD + VTU and back
``view``    pictures, animations and a window (import it by name: it is not loaded here)
"""

from .fields import Block, Frame, SeriesError, disk_block, floor_block, rim_block, ring_block
from .ring import MeshError, Quality, RingMesh, ring_mesh
from .series import Series, SeriesWriter, read

__all__ = [
    "Block",
    "Frame",
    "MeshError",
    "Quality",
    "RingMesh",
    "Series",
    "SeriesError",
    "SeriesWriter",
    "disk_block",
    "floor_block",
    "read",
    "rim_block",
    "ring_block",
    "ring_mesh",
]
