"""From an outline to a near-equilateral triangulation inside it, in the order of painting.

In: a simple polygon and a number of triangles.
Out: a `Mesh`; the sides of its triangles.
Imports: `engine.geometry`.
"""

from engine.domain.meshing.depth import (
    find_distances as find_distances,
    sort_by_depth as sort_by_depth,
    spread_depth as spread_depth,
)
from engine.domain.meshing.draw_order import (
    copy_draw_order as copy_draw_order,
    order_branches_on_top as order_branches_on_top,
)
from engine.domain.meshing.mesh import Mesh as Mesh, sides_of as sides_of
from engine.domain.meshing.triangulation import triangulate as triangulate
