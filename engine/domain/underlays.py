"""Underlays: material of one side of a slit that continues under the other side.

A drawing shows nothing of a limb or a trunk where a limb covers it. When they part, what is covered
would end at the slit. Instead it continues there, as its own mirror image across the slit. A limb
continues up to the width of the limb that covered it, and the mirror image of its outline closes
it. A trunk continues below the whole limb; below a flap, which a slit goes around, from both sides.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
import scipy.sparse
import shapely
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from engine.arrays import Booleans, Complexes, Floats, Indices, Integers
from engine.domain.covered_sides import are_tips, find_covered_side, find_room, sample_line
from engine.domain.flaps import locate_between, measure_flap
from engine.domain.meshing.mesh import Mesh, border_edges
from engine.domain.outline.slit_sides import CUT_WIDTH
from engine.geometry import (
    Domain,
    as_xy,
    barycentric_weights,
    box_diagonal,
    shapely_region,
)

HIDDEN = 0.65  # of the width of a covering limb, less that of a visible limb: width of an underlay
# What is seen is a trunk if it is this many times as wide as the covering limb: at a slit's tip,
# where a limb leaves the trunk, and elsewhere.
TRUNK = (0.5, 2.0)
BESIDE_SLIT = 1.5  # slit widths from its line: what is seen beside a flap is measured from there
PAINTED = 0.4  # of the width of a strip under a flap: what of the trunk is stretched over it
BAND = 8.0  # slit widths: largest width of a limb's outline and what is beside it
BESIDE_BAND = 0.3  # of the width of a limb's underlay: what is between the slit and that band
TAPER = 0.7  # of the distance from the ends of a slit: width of an underlay there, at most
INK = 3.0  # slit widths: width of an underlay where it begins
TIP = 3.0  # slit widths: beyond a tip a slit's line would lead this far into the domain
STEADY = 8.0  # slit widths along the slit over which widths are rounded
STRAY = 1.4  # of the usual width of a limb near a place: a ray that is longer misses its other side
CANDIDATES = 16  # triangles that may contain a point


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Underlay:
    """Further vertices beyond slits, and triangles between them and the slits.

    The places of a further vertex is that of a mesh vertex mirrored: twice the vertex on the slit
    less a place inside. It is painted as another place inside.

    Parameters
    ----------
    vertices : intp, shape (e,)
        Of the mesh, on the slit, of each further vertex.
    corners, painted_corners : int32, shape (e, 3)
        Triangles around the mirrored and the painted places.
    weights, painted_weights : float64, shape (e, 3)
        Barycentric coordinates in these triangles.
    triangles : int32, shape (k, 3)
        Indices of the mesh's vertices, followed by the further ones.
    """

    vertices: Indices
    corners: Integers
    weights: Floats
    painted_corners: Integers
    painted_weights: Floats
    triangles: Integers

    def mirror(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return values (e, …) of the further vertices from those of the mesh's vertices (v, …)."""
        mirrored = np.einsum("ec,ec...->e...", self.weights, values[self.corners])
        return np.asarray(2 * values[self.vertices] - mirrored)

    def paint(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        """Return values (e, …) at the painted places."""
        return np.asarray(
            np.einsum("ec,ec...->e...", self.painted_weights, values[self.painted_corners])
        )


def find_underlay(
    domain: Domain, mesh: Mesh, sides: Indices, lines: Sequence[Complexes]
) -> Underlay | None:
    """Return the underlay of a mesh's slits; None if no slit has a covered side.

    Parameters
    ----------
    sides : intp, shape (s,)
        The vertices on the sides of slits.
    lines : sequence of complex128, each of shape (n,)
        Lines of slits, each with its covered side on its left.
    """
    width = CUT_WIDTH * box_diagonal(domain.outline)
    region = shapely_region(domain.outline, domain.loops[1:])
    border = border_edges(mesh.triangles).astype(np.intp)
    border = border[np.isin(border, sides).all(axis=1)]
    ended = [(line, are_tips(region, line, TIP * width)) for line in lines]
    limbs = [(line, are_ends) for line, are_ends in ended if not are_ends.all()]
    flaps = [line for line, are_ends in ended if are_ends.all()]
    parts = [
        _under_limbs(mesh, region, border, limbs, width),
        *(_under_flap(mesh, region, border, line, width) for line in flaps),
    ]
    return _joined([part for part in parts if part is not None], len(mesh.vertices))


def _joined(parts: Sequence[Underlay], count: int) -> Underlay | None:
    """Return underlays of a mesh of `count` vertices as one; None without any."""
    if len(parts) < 2:
        return parts[0] if parts else None
    fields = ("vertices", "corners", "weights", "painted_corners", "painted_weights")
    triangles, further = [], 0
    for part in parts:
        triangles.append(np.where(part.triangles < count, part.triangles, part.triangles + further))
        further += len(part.vertices)
    joined = {name: np.concatenate([getattr(part, name) for part in parts]) for name in fields}
    return Underlay(**joined, triangles=np.concatenate(triangles).astype(np.int32))


def _under_flap(
    mesh: Mesh, region: shapely.Polygon, border: Indices, line: Complexes, width: float
) -> Underlay | None:
    """Return what continues under a flap: a strip on each side, stretched between both sides."""
    samples = sample_line(line, width)
    edges, chosen = find_covered_side(mesh.vertices, border, samples, width)
    if not len(edges):
        return None
    found, first, inverse = np.unique(edges, return_index=True, return_inverse=True)
    edges, chosen = inverse.reshape(-1, 2), chosen[first]
    inwards = -1j * samples.tangents
    seen = find_room(region, samples.way - BESIDE_SLIT * width * inwards, -inwards)
    # The outline of the trunk is not painted under the flap.
    seen = np.maximum(seen - BAND * width, 0.0)
    flap = measure_flap(samples.way, inwards, seen)
    # The side that shows more of the trunk covers the other.
    edges = edges[np.argsort(flap.depths[chosen][edges].sum(axis=1), kind="stable")]
    places = mesh.vertices[found]
    away = np.abs(samples.way[flap.opposite[chosen], None] - places)
    np.fill_diagonal(away, np.inf)
    across = away.argmin(axis=1)
    towards = flap.towards[chosen]
    wanted = places + flap.depths[chosen] * towards
    beside, weights = locate_between(places, across, wanted)
    # Rows: at the slit, beside the ink of the flap, and below it.
    beside_ink = BESIDE_SLIT * width
    shown = beside_ink + np.stack(
        [np.zeros(len(found)), np.minimum(PAINTED * flap.depths, seen)[chosen]]
    )
    painted, painted_weights = _locate(mesh, (places - shown * towards).ravel())
    numbers = np.arange(len(found))
    corners = found[np.column_stack([numbers, across, beside])]
    edges += len(mesh.vertices)
    return Underlay(
        vertices=np.tile(found, 2),
        corners=np.concatenate([corners, corners]).astype(np.int32),
        # A place Σ w z is the mirror image of 2 z₀ − Σ w z.
        weights=np.concatenate(
            [np.tile([1.0, 0.0, 0.0], (len(found), 1)), [2.0, 0.0, 0.0] - weights]
        ),
        painted_corners=painted,
        painted_weights=painted_weights,
        triangles=_strip(edges, edges + len(found)).astype(np.int32),
    )


def _under_limbs(
    mesh: Mesh,
    region: shapely.Polygon,
    border: Indices,
    lines: Sequence[tuple[Complexes, Booleans]],
    width: float,
) -> Underlay | None:
    """Return what continues under limbs, for lines and whether each end of them is a tip."""
    covered = [np.empty((0, 2), dtype=np.intp)]
    outwards = np.zeros(len(mesh.vertices), dtype=np.complex128)
    along = np.zeros(len(mesh.vertices))
    limits = np.zeros(len(mesh.vertices))
    wide = np.zeros(len(mesh.vertices))
    for line, is_tip in lines:
        samples = sample_line(line, width)
        on_side, chosen = find_covered_side(mesh.vertices, border, samples, width)
        covered.append(on_side)
        side, at, way = on_side.ravel(), samples.at[chosen], samples.at[-1]
        outwards[side] = -1j * samples.tangents[chosen]
        along[side] = at
        # At a tip both sides are one. Elsewhere, the outline of the covered limb goes under the
        # other limb, which covers that outline's ink first.
        first, last = np.where(is_tip, 0.0, INK * width)
        limits[side] = np.minimum(first + TAPER * at, last + TAPER * (way - at))
        wide[side] = np.interp(at / way, [0.0, 1.0], np.where(is_tip, *TRUNK))
    edges = np.concatenate(covered)
    if not len(edges):
        return None
    found, inverse = np.unique(edges, return_inverse=True)
    edges = inverse.reshape(-1, 2)
    outwards, along = outwards[found], along[found]
    places = mesh.vertices[found]
    seen = find_room(region, places - width * outwards / 2, -outwards)
    covering = find_room(region, places + 2.5 * width * outwards, outwards)
    is_trunk = seen > wide[found] * covering
    hidden = np.where(is_trunk, 0.0, np.maximum(covering - seen, 0.0))
    rounding = _rounding(edges, along, STEADY * width)
    # The trunk also fills the notch between the two.
    in_trunk = np.minimum(2.0 * rounding @ is_trunk, 1.0) * (rounding @ covering)
    # At the ends of a slit, rays may miss the limb's other side: what is beside them is shown.
    shown = _find_regular(rounding > 0, along, seen)
    across = seen[shown]
    in_trunk, in_limb = (
        np.minimum(rounding @ np.minimum(HIDDEN * depths, most), most)
        for depths, most in (
            (in_trunk, np.minimum(limits[found], seen)),
            (rounding @ hidden, np.minimum(limits[found], across)),
        )
    )
    band = np.minimum(BAND * width, (1.0 - BESIDE_BAND) * in_limb)
    # Rows of further vertices: how far they lie beyond the slit, and before it what they show.
    rows = [(in_trunk, in_trunk), (in_limb - band, across - band), (in_limb, across)]
    inner, weights = _locate(mesh, np.concatenate([places - row * outwards for row, _ in rows]))
    painted, painted_weights = _locate(
        mesh, np.concatenate([places[shown] - row * outwards[shown] for _, row in rows])
    )
    at_rows = [len(mesh.vertices) + number * len(found) for number in range(len(rows))]
    under, under_limb = (edges[(depths[edges] > 0).any(axis=1)] for depths in (in_trunk, in_limb))
    # Where a limb bends, its underlay covers itself: no outline shows within it.
    strips = [
        (under_limb + at_rows[1], under_limb + at_rows[2]),
        (found[under], under + at_rows[0]),
        (found[under_limb], under_limb + at_rows[1]),
    ]
    return Underlay(
        vertices=np.tile(found, len(rows)),
        corners=inner,
        weights=weights,
        painted_corners=painted,
        painted_weights=painted_weights,
        triangles=np.concatenate([_strip(*each) for each in strips]).astype(np.int32),
    )


def _strip(near: Indices, far: Indices) -> Indices:
    """Return triangles (2 b, 3) between two rows of edges (b, 2)."""
    (first, second), (beyond, after) = near.T, far.T
    return np.column_stack([first, second, after, first, after, beyond]).reshape(-1, 3)


def _find_regular(are_near: Booleans, along: Floats, lengths: Floats) -> Indices:
    """Return for each place the nearest whose length is not far above those around it."""
    usual = np.nanmedian(np.where(are_near, lengths, np.nan), axis=1)
    is_regular = lengths <= STRAY * usual
    away = np.where(are_near & is_regular, np.abs(along[:, None] - along), np.inf)
    return np.asarray(np.where(is_regular, np.arange(len(along)), away.argmin(axis=1)), np.intp)


def _rounding(edges: Indices, along: Floats, steady: float) -> Floats:
    """Return the matrix (n, n) that rounds values of vertices along each connected side."""
    count = len(along)
    graph = scipy.sparse.coo_array((np.ones(len(edges)), edges.T), shape=(count, count))
    _, parts = connected_components(graph, directed=False)
    away = (along[:, None] - along) / steady
    weights = np.exp(-(away**2) / 2) * (parts[:, None] == parts)
    return np.asarray(weights / weights.sum(axis=1, keepdims=True))


def _locate(mesh: Mesh, points: Complexes) -> tuple[Integers, Floats]:
    """Return a triangle (n, 3) at each point, and barycentric weights, also beside the mesh."""
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    count = min(CANDIDATES, len(middles))
    _, near = cKDTree(as_xy(middles)).query(as_xy(points), k=count)
    near = near.reshape(len(points), count)
    corners = mesh.vertices[mesh.triangles[near]]
    weights = barycentric_weights(corners.reshape(-1, 3), np.repeat(points, count))
    weights = weights.reshape(-1, count, 3)
    best = weights.min(axis=2).argmax(axis=1)
    rows = np.arange(len(points))
    return mesh.triangles[near[rows, best]], weights[rows, best]
