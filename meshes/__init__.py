"""The ring as a mesh, fields in time as files, and pictures of both.

``ring``    the annulus: curved quads, grading, named boundaries, quality
"""

from .ring import MeshError, Quality, RingMesh, ring_mesh

__all__ = ["MeshError", "Quality", "RingMesh", "ring_mesh"]
