"""Exact Reeb graphs of meshes of any size.

    graph = reeb.compute("scan.ply", memory="64M", output="scan.reeb")   # streams; Python never holds the mesh
    graph = reeb.compute(vertices, faces, f="x")                         # arrays of numpy, or lists
    graph = reeb.open("scan.reeb").level(threshold="1%")

docs/PYTHON.md has examples.
"""

from ._reeb import version as __version__
from .errors import Error
from .graph import Graph, Skeleton, open
from .online import Online
from .runs import Defects, Segmentation, compute, defects, segment

__all__ = [
    "Defects",
    "Error",
    "Graph",
    "Online",
    "Segmentation",
    "Skeleton",
    "compute",
    "defects",
    "open",
    "segment",
]
