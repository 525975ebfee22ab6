"""Line integrals of holomorphic functions from the anchor to every point (Section 7).

In: a domain's points and triangles, and integrands at the nodes of paths.
Out: antiderivatives and continuous logarithms at the points.
Imports: `engine.domain.meshing`, `engine.geometry`.
"""

from engine.paths.complex_log import (
    continue_logarithm as continue_logarithm,
    root_sheets as root_sheets,
    shorter_turns as shorter_turns,
)
from engine.paths.integration_paths import (
    IntegrationPaths as IntegrationPaths,
    lay_paths as lay_paths,
)
from engine.paths.loops import Loops as Loops
from engine.paths.path_network import (
    MESH_POINTS as MESH_POINTS,
    chain_starts as chain_starts,
    mesh_network as mesh_network,
    scattered_network as scattered_network,
    with_chains as with_chains,
    with_loops as with_loops,
)
from engine.paths.region import leave_region as leave_region
from engine.paths.spanning_tree import (
    SpanningTree as SpanningTree,
    breadth_first_parents as breadth_first_parents,
    depth_first_numbering as depth_first_numbering,
)
