"""Validity of a domain: always true for `build_domain`, to be checked for files."""

import numpy as np

from engine.arrays import Complexes, Integers
from engine.domain.build import MOST_TRIANGLES, MeshedDomain
from engine.domain.meshing.mesh import sides_of
from engine.domain.outline.enclosure import LARGEST_OUTLINE
from engine.errors import EngineError
from engine.geometry import (
    ON_OUTLINE,
    diameter,
    distance_to_boundary,
    require_around,
    require_cages_in_holes,
    require_simple,
    signed_area,
)

# Built meshes have the requested number of triangles up to a few percent.
MOST_MESH_TRIANGLES = 2 * MOST_TRIANGLES
# Farthest coordinate. Pictures on a canvas, with their cages, lie within it, their corners within
# half of it; squares still have digits to spare.
OUTERMOST = 2e7
# Of the diameter: least distance of a cage vertex from the outline. Samples of the outline are
# graded towards the vertex, so the distance bounds their number. A built cage keeps 300 times this
# distance.
NEAREST = 1e-6
# Of the diameter: largest distance of the painted outline from its vertices; built ones stay in
# .0022.
FARTHEST_CLOSED = 0.01
# Of the outline's area.
SAME_AREA = 1e-9
MESH_UNFILLED = "The mesh does not fill the inside of the outline exactly; give a mesh that does."
MESH_CORNERS = "The mesh has triangles that name vertices which do not exist."
MESH_FLAT = "The mesh has triangles that are flat or run clockwise."
MESH_UNUSED = "The mesh has vertices that belong to no triangle."
MESH_OVERLAPS = "The mesh has overlapping triangles."
MESH_SIZE = "The mesh must have 1 to {most:,} triangles, not {count:,}."
VERTEX_COUNT = "The {name} can have at most {most:,} vertices, not {count:,}."
TOO_FAR = "The {name} lies farther from the origin than {farthest:,.0f} pixels."


def require_domain(domain: MeshedDomain) -> None:
    """Raise `EngineError` unless outline, cage and mesh belong together.

    Notes
    -----
    The triangles all run counter-clockwise, so they cover each point as often as the mesh's own
    border winds around it. That border lies on the outline, so its winding number is equal at all
    inner points and 0 outside. The test at a hole's centre shows that it is 0 in the hole. The
    triangles' areas sum to the domain's, so the number is 1 inside. Together: the triangles tile
    the inside, without gap or overlap.

    Cost: a sort of the mesh's edges, 30 ms for 100,000 triangles.
    """
    for name, polygons in (("outline", domain.loops), ("cage", domain.cages)):
        count = sum(map(len, polygons))
        _require_near(np.concatenate(polygons), name)
        if count > LARGEST_OUTLINE:
            raise EngineError(VERTEX_COUNT, name=name, most=LARGEST_OUTLINE, count=count)
    _require_near(domain.mesh.vertices, "mesh")
    # Far from the origin small shapes would have no digits left between vertices.
    domain = domain.moved(-complex(domain.outline[0]))
    require_simple(domain.outline, "outline")
    require_cages_in_holes(domain.holes, domain.outline)
    require_around(domain.cage, domain.outline)
    room = distance_to_boundary(domain.outline, np.concatenate(domain.cages), domain.loops[1:])
    if room.min() < NEAREST * diameter(domain.outline):
        raise EngineError(
            "The cage comes too close to the outline; move the cage away from the outline."
        )
    if domain.closed is not None:
        corners = np.concatenate(domain.loops)
        away = np.inf
        if len(domain.closed) == len(corners):
            away = float(np.abs(domain.closed - corners).max())
        if not away <= FARTHEST_CLOSED * diameter(domain.outline):
            raise EngineError("The slits are not closed beside the outline's own vertices.")
    _require_tiling(domain)


def _require_near(points: Complexes, name: str) -> None:
    if not np.abs([points.real, points.imag]).max(initial=0.0) <= OUTERMOST:
        raise EngineError(TOO_FAR, name=name, farthest=OUTERMOST)


def _require_tiling(domain: MeshedDomain) -> None:
    mesh, outline, holes = domain.mesh, domain.outline, domain.loops[1:]
    vertices, triangles = mesh.vertices, mesh.triangles
    if not 1 <= len(triangles) <= MOST_MESH_TRIANGLES:
        raise EngineError(MESH_SIZE, most=MOST_MESH_TRIANGLES, count=len(triangles))
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        raise EngineError(MESH_CORNERS)
    if not np.bincount(triangles.ravel(), minlength=len(vertices)).all():
        raise EngineError(MESH_UNUSED)
    areas = mesh.areas()
    if not (areas > 0).all():
        raise EngineError(MESH_FLAT)
    first, last = (vertices[ends] for ends in _border(triangles))
    on_border = np.concatenate([first, last, (first + last) / 2])
    distances = distance_to_boundary(outline, on_border, holes)
    area = sum(map(signed_area, domain.loops))
    spokes = [(last - hole.centre) / (first - hole.centre) for hole in domain.holes]
    if (
        distances.max(initial=0.0) > ON_OUTLINE * diameter(outline)
        or abs(areas.sum() - area) > SAME_AREA * area
        or any(abs(np.angle(spoke).sum()) > 1.0 for spoke in spokes)
    ):
        raise EngineError(MESH_UNFILLED)


def _border(triangles: Integers) -> tuple[Integers, Integers]:
    """Return start and end (b,) of the directed edges without an opposite edge."""
    _, numbers, _ = sides_of(triangles)
    ends = np.roll(triangles, -1, axis=1)
    if np.bincount((2 * numbers + (triangles < ends)).ravel()).max() > 1:
        raise EngineError(MESH_OVERLAPS)
    alone = np.bincount(numbers.ravel())[numbers] == 1
    return triangles[alone], ends[alone]
