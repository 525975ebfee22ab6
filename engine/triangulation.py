"""Near-equilateral triangulation of a simple polygon (Section 7: the domain of the maps).

Almost all of the inside is covered by the lattice of equilateral triangles, which needs no search.
Only the band between lattice and outline is triangulated (constrained Delaunay), refined where the
outline asks for smaller triangles, and smoothed.
"""

import numpy as np
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.half_edges import OUTLINE, SEAM, HalfEdgeMesh
from engine.lattice import lattice_inside, lattice_triangles
from engine.mesh import Mesh
from engine.polygon import as_xy, box_diagonal, edges, require_simple, signed_area
from engine.refinement import refine
from engine.smoothing import smooth
from engine.strip import cut_edges, triangulate_strip

CLEARANCE = 0.65
"""Least distance of a lattice site from the outline, in spacings.

It must exceed the lattice's circumradius, 0.577, so that no part of the outline comes between the
corners of a unit triangle, and every edge of the lattice is Delaunay.
"""
BAND = 3.5
"""Depth in spacings down to which the lattice may give way to smoothing and refinement."""

SMALLEST_ANGLE = 26.0
"""Degrees that refinement asks for."""

SWEEPS = 4
"""Sweeps of smoothing."""

SHARP = np.radians(60.0)
"""Interior angles of the outline below this are sharp: its two edges are split alike."""

CLOSE_ENOUGH = 0.02
"""Relative error of the number of triangles that is accepted."""

MOST_TRIALS = 8
"""Spacings that are tried for the right number of triangles."""


def triangulate(outline: Complexes, count: int) -> Mesh:
    """Triangulate the inside of a polygon with triangles as equilateral as its shape allows.

    Parameters
    ----------
    outline : complex128, shape (p,)
        Simple, counter-clockwise. Its vertices are the first p vertices of the mesh.
    count : int
        How many triangles to aim at. They are met within a few percent unless the outline's own
        detail enforces more.

    Returns
    -------
    Mesh
        A conforming triangulation; no angle is below 20° but next to a corner of the outline that
        is sharper itself.

    Raises
    ------
    EngineError
        If the outline is not simple or runs clockwise.

    Notes
    -----
    Deterministic. Time and memory are proportional to `count`.
    """
    require_simple(outline, "outline")
    centre = outline[0]
    # A power of two, so that scaling rounds nothing.
    scale = float(np.exp2(np.ceil(np.log2(box_diagonal(outline)))))
    vertices, triangles = _closest_in_count((outline - centre) / scale, count)
    vertices = vertices * scale + centre
    vertices[: len(outline)] = outline
    return Mesh(vertices=vertices, triangles=triangles.astype(np.int32))


def _closest_in_count(outline: Complexes, count: int) -> tuple[Complexes, Indices]:
    """Search the lattice spacing that makes the number of triangles right (secant steps).

    The number is nearly linear in x = 1/spacing²: the area over that of a unit triangle, plus what
    the outline's detail costs.
    """
    slope = signed_area(outline) * 4 / np.sqrt(3)
    x = count / slope
    best = _fill(outline, float(x**-0.5))
    got = len(best[1])
    for _ in range(MOST_TRIALS - 1):
        if abs(len(best[1]) - count) <= CLOSE_ENOUGH * count:
            break
        # Where detail dominates, a step may ask for less than nothing.
        next_x = float(np.clip(x + (count - got) / slope, x / 4, 4 * x))
        mesh = _fill(outline, float(next_x**-0.5))
        if abs(len(mesh[1]) - count) < abs(len(best[1]) - count):
            best = mesh
        # Detail only ever makes the number grow more slowly than the area.
        slope = float(np.clip((len(mesh[1]) - got) / (next_x - x), slope / 4, slope))
        x, got = next_x, len(mesh[1])
    return best


def _fill(outline: Complexes, spacing: float) -> tuple[Complexes, Indices]:
    """Triangulate the inside of a polygon of size 1 with edges about as long as the spacing."""
    ring = cut_edges(outline, spacing)
    lattice = lattice_inside(outline, spacing)
    depth = _depth(outline, lattice.points, spacing)
    lattice, depth = lattice.select(depth > CLEARANCE), depth[depth > CLEARANCE]

    # Vertices are numbered: ring, lattice, points inserted later.
    points = np.concatenate([ring.points, lattice.points])
    deep = np.concatenate([np.zeros(len(ring.points), dtype=np.bool_), depth > BAND])
    units = lattice_triangles(lattice) + len(ring.points)
    loose = np.ones(len(points), dtype=np.bool_)
    loose[: len(ring.points)] = False
    loose[units] = False

    core = deep[units].all(axis=1)
    shallow = HalfEdgeMesh(points, units[~core])
    _mark_seam(shallow, deep)
    strip = triangulate_strip(outline, ring, shallow, np.flatnonzero(loose))
    band = HalfEdgeMesh(points, np.concatenate([strip, units[~core]]))
    _mark_seam(band, deep)
    refine(band, _sharp_corners(outline), SMALLEST_ANGLE)
    smooth(band, SWEEPS)
    return _compact(band.points, np.concatenate([band.triangles, units[core]]))


def _depth(outline: Complexes, points: Complexes, spacing: float) -> Floats:
    """Return the distance of points from the outline in spacings, infinite below the band."""
    samples = cut_edges(outline, spacing / 4).points
    tree = cKDTree(as_xy(samples))
    distance, _ = tree.query(as_xy(points), distance_upper_bound=(BAND + 0.1) * spacing)
    return np.asarray(distance / spacing)


def _mark_seam(mesh: HalfEdgeMesh, deep: Booleans) -> None:
    """Mark the border of a mesh between deep vertices, where the core adjoins."""
    border = np.flatnonzero(mesh.twins == OUTLINE)
    start, end = mesh.ends(border)
    mesh.twins[border[deep[start] & deep[end]]] = SEAM


def _sharp_corners(outline: Complexes) -> Booleans:
    """Tell which corners have an interior angle below `SHARP`."""
    along = edges(outline)
    return np.asarray(np.angle(-np.roll(along, 1) / along) % (2 * np.pi) < SHARP)


def _compact(points: Complexes, triangles: Indices) -> tuple[Complexes, Indices]:
    """Leave out the points that no triangle uses."""
    used: Booleans = np.zeros(len(points), dtype=np.bool_)
    used[triangles] = True
    number = np.cumsum(used) - 1
    return points[used], number[triangles]
