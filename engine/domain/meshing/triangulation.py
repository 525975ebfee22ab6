"""Near-equilateral triangulation of a polygon with holes (Section 7: the domain of the maps).

The lattice of equilateral triangles covers almost all of the inside, without any search. Only the
band between lattice and outline is triangulated (constrained Delaunay), refined where the outline
needs smaller triangles, and smoothed.
"""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Indices, as_number
from engine.domain.meshing.half_edges import OUTLINE, SEAM, HalfEdgeMesh
from engine.domain.meshing.lattice import lattice_inside, lattice_triangles
from engine.domain.meshing.mesh import Mesh
from engine.domain.meshing.refinement import SHORTEST_EDGE, refine_mesh
from engine.domain.meshing.smoothing import smooth_mesh
from engine.domain.meshing.strip import split_edges, triangulate_strip
from engine.errors import EngineError
from engine.geometry import (
    as_xy,
    diameter,
    edge_vectors,
    require_holes,
    require_simple,
    signed_area,
)

# Least distance of a lattice point from the outline, in spacings. It must exceed the lattice's
# circumradius, 0.577, so that no part of the outline comes between the corners of a unit triangle,
# and every edge of the lattice is Delaunay.
CLEARANCE = 0.6
BAND = 3.5  # spacings: depth down to which smoothing and refinement may replace the lattice
# Smallest angles in degrees of the refinement, and if they would take too many triangles.
SMALLEST_ANGLE, RELAXED_ANGLE = 28.0, 20.0
SWEEPS = 4  # of smoothing
CLOSE_ENOUGH = 0.03  # accepted relative error of the number of triangles
MOST_TRIALS = 10  # spacings tried for the right number of triangles


def triangulate(outline: Complexes, count: int, *, holes: Sequence[Complexes] = ()) -> Mesh:
    """Triangulate the inside of a polygon with triangles as equilateral as its shape allows.

    Parameters
    ----------
    outline : complex128, shape (p,)
        Simple, counter-clockwise. Its vertices are the first p vertices of the mesh.
    count : int
        Wanted number of triangles, met within a few percent unless the outline's detail needs more.
    holes : sequence of complex128
        Simple polygons inside the outline, clockwise and apart. Their vertices follow the
        outline's.

    Returns
    -------
    Mesh
        A conforming triangulation with angles of 28° and more (20° where that takes too many
        triangles), except in sharper corners of the outline.

    Raises
    ------
    EngineError
        If the outline is not simple, runs clockwise, or has an edge below 1e-6 of its size; if a
        hole is invalid.

    Notes
    -----
    Deterministic. Time and memory are proportional to `count`: a million triangles take about a
    second, 100,000 about 0.1 s. The mean of the smallest angles is above 59° for 100,000 triangles
    in an ordinary drawing's outline, 52° to 57° for 1,000.
    """
    as_number(count, "The number of triangles", least=1, is_whole=True)
    require_simple(outline, "outline")
    require_holes(holes, outline)
    loops = (outline, *holes)
    shortest = min(float(np.abs(edge_vectors(loop)).min()) for loop in loops)
    if shortest < SHORTEST_EDGE * diameter(outline):
        raise EngineError(
            "The outline of size {size:.3g} has an edge of length {shortest:.3g}, which is too "
            "short. Leave out one end of the edge.",
            shortest=shortest,
            size=diameter(outline),
        )
    centre = outline[0]
    # A power of two, so that scaling rounds nothing.
    scale = float(np.exp2(np.ceil(np.log2(diameter(outline)))))
    mesh = _fill_to_count([(loop - centre) / scale for loop in loops], count)
    vertices = mesh.vertices * scale + centre
    corners = np.concatenate(loops)
    vertices[: len(corners)] = corners
    return Mesh(vertices=vertices, triangles=mesh.triangles)


def _fill_to_count(loops: Sequence[Complexes], count: int) -> Mesh:
    """Triangulate with about this many triangles, if need be with somewhat smaller angles."""
    best = _search_spacing(loops, count, SMALLEST_ANGLE)
    if not _is_close(best, count):
        relaxed = _search_spacing(loops, count, RELAXED_ANGLE)
        if _is_close(relaxed, count):
            return relaxed
    return best


def _is_close(mesh: Mesh, count: int) -> bool:
    """Whether a mesh has nearly the right number of triangles."""
    return abs(len(mesh.triangles) - count) <= CLOSE_ENOUGH * count


def _search_spacing(loops: Sequence[Complexes], count: int, smallest: float) -> Mesh:
    """Triangulate with the spacing whose number of triangles is nearest to `count`.

    The number is about linear in x = 1/spacing²: the area over that of a unit triangle, plus the
    triangles for the outline's detail. It jumps where a limb gets room for another row, so steps
    stay between the x that gave too few and those that gave too many.
    """
    slope = sum(map(signed_area, loops)) * 4 / np.sqrt(3)
    x = count / slope
    too_small, too_large = 0.0, np.inf
    best = mesh = _fill(loops, x**-0.5, smallest)
    for _ in range(MOST_TRIALS - 1):
        if _is_close(best, count):
            break
        excess = len(mesh.triangles) - count
        too_small, too_large = (too_small, x) if excess > 0 else (x, too_large)
        x -= excess / slope
        if not too_small < x < too_large:
            x = too_large / 3 if too_small == 0 else float(np.sqrt(too_small * too_large))
        mesh = _fill(loops, x**-0.5, smallest)
        if abs(len(mesh.triangles) - count) < abs(len(best.triangles) - count):
            best = mesh
    return best


def _fill(loops: Sequence[Complexes], spacing: float, smallest: float) -> Mesh:
    """Triangulate a region of size 1 with edges about as long as the spacing."""
    rings = split_edges(loops, spacing)
    lattice = lattice_inside(loops, spacing)
    depth = _depth(loops, lattice.points, spacing)
    lattice, depth = lattice.select(depth > CLEARANCE), depth[depth > CLEARANCE]

    # Vertices are numbered: rings, lattice, points inserted later.
    points = np.concatenate([rings.points, lattice.points])
    deep = np.concatenate([np.zeros(len(rings.points), dtype=np.bool_), depth > BAND])
    units = lattice_triangles(lattice) + len(rings.points)
    core = deep[units].all(axis=1)
    loose = np.ones(len(points), dtype=np.bool_)
    loose[: len(rings.points)] = False
    loose[units] = False

    shallow = HalfEdgeMesh(points, units[~core])
    _mark_seam(shallow, deep)
    strip = triangulate_strip(loops, rings, shallow, np.flatnonzero(loose))
    band = HalfEdgeMesh(points, np.concatenate([strip, units[~core]]))
    _mark_seam(band, deep)
    refine_mesh(band, smallest)
    smooth_mesh(band, sum(map(len, loops)), SWEEPS)
    return _compact(band.points, np.concatenate([band.triangles, units[core]]))


def _depth(loops: Sequence[Complexes], points: Complexes, spacing: float) -> Floats:
    """Return the distance of points from the loops in spacings, infinite below the band."""
    # Dense enough that the distance from the samples is at most 2 % too large at the clearance.
    tree = cKDTree(as_xy(split_edges(loops, spacing / 6).points))
    distance, _ = tree.query(as_xy(points), distance_upper_bound=(BAND + 0.1) * spacing)
    return np.asarray(distance / spacing)


def _mark_seam(mesh: HalfEdgeMesh, deep: Booleans) -> None:
    """Mark the border of a mesh between deep vertices, where the core adjoins."""
    border = np.flatnonzero(mesh.counterparts == OUTLINE)
    start, end = mesh.ends(border)
    mesh.counterparts[border[deep[start] & deep[end]]] = SEAM


def _compact(points: Complexes, triangles: Indices) -> Mesh:
    """Return the mesh without unused points."""
    used: Booleans = np.zeros(len(points), dtype=np.bool_)
    used[triangles] = True
    number = np.cumsum(used) - 1
    return Mesh(vertices=points[used], triangles=number[triangles].astype(np.int32))
