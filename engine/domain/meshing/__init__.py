"""From an outline to a near-equilateral triangulation inside it, in the order of painting.

In: a simple polygon and a number of triangles.
Out: a `Mesh`; the sides of its triangles.
Imports: `engine.geometry`.
"""

from engine.domain.meshing.depth import (
    find_distances as find_distances,
    in_depth_order as in_depth_order,
    spread_depth as spread_depth,
)
from engine.domain.meshing.draw_order import (
    in_order_of as in_order_of,
    with_limbs_on_top as with_limbs_on_top,
)
from engine.domain.meshing.mesh import Mesh as Mesh, sides_of as sides_of
from engine.domain.meshing.triangulation import triangulate as triangulate
