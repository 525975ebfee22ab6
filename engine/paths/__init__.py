"""Line integrals of holomorphic functions from the anchor to every point (Section 7).

In: a domain's points and triangles, and integrands at the nodes of paths.
Out: antiderivatives and continuous logarithms at the points.
Imports: `engine.domain.meshing`, `engine.geometry`.
"""

from engine.paths.complex_log import continue_logarithm, root_sheets
from engine.paths.integration_paths import IntegrationPaths, lay_paths
from engine.paths.loops import Loops
from engine.paths.path_network import ON_OUTLINE, mesh_network, scattered_network, with_loops
from engine.paths.spanning_tree import (
    SpanningTree,
    breadth_first_parents,
    depth_first_numbering,
)

__all__ = [
    "ON_OUTLINE",
    "IntegrationPaths",
    "Loops",
    "SpanningTree",
    "breadth_first_parents",
    "continue_logarithm",
    "depth_first_numbering",
    "lay_paths",
    "mesh_network",
    "root_sheets",
    "scattered_network",
    "with_loops",
]
