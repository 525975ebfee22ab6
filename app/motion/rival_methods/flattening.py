"""Plane metrics of a mesh that are discretely conformal to given ones.

Two metrics of a mesh are discretely conformal if their edges' lengths differ by a factor for each
end, e^{(u_i + u_j)/2} (Luo 2004; Springborn, Schröder and Pinkall 2008). The angles around each
inner vertex sum to 2π at the minimum of a convex function of u; its gradient is the angle defect,
its Hessian half the cotangent Laplacian.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np
from scipy.sparse import csc_array

from app.motion.rival_methods.triangulated_domain import TriangulatedDomain, factorise_symmetric
from engine.arrays import Booleans, Complexes, Floats, Indices, freeze
from engine.errors import EngineError

MOST_STEPS = 40
SMALLEST_PART = 2.0**-20  # smallest tried part of a Newton step
LARGEST_CHANGE = 2.0  # of a logarithm, in one step
FLOOR = 1e-9  # of the Hessian's diagonal, for vertices with only degenerate triangles
ENOUGH = 1e-10  # angle defect, in radians, at which the iteration ends


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Flattening:
    """Makes metrics of a simply connected mesh flat, with unchanged lengths on the border.

    Half-edge k of a triangle leads from its corner k to the next one.

    Parameters
    ----------
    inner : intp, shape (i,)
        Vertices that are not on the border.
    place : intp, shape (n,)
        Index of each vertex among the inner ones; −1 on the border.
    hinges : intp, shape (m, 2)
        The half-edge that joins each triangle to its parent in the tree of triangles, and its
        counterpart.
    reached : intp, shape (n,)
        A half-edge between each vertex and its parent in the tree of vertices.
    forward : bool, shape (n,)
        Whether this half-edge leads to the vertex.
    """

    domain: TriangulatedDomain
    inner: Indices
    place: Indices
    hinges: Indices
    reached: Indices
    forward: Booleans

    @classmethod
    def on(cls, domain: TriangulatedDomain) -> Self:
        """Prepare a mesh, once for all frames.

        Raises
        ------
        EngineError
            If the mesh has holes: around them a flat metric need not close.
        """
        if domain.loops > 1:
            raise EngineError(
                "This mesh has holes: {count}. The method of Chen et al. (2013) is for meshes "
                "without holes; choose another method.",
                count=domain.loops - 1,
            )
        inner = np.flatnonzero(~domain.border)
        place = np.full(len(domain.points), -1)
        place[inner] = np.arange(len(inner))
        reached, forward = _reached(domain)
        return cls(
            domain=domain,
            inner=freeze(inner),
            place=freeze(place),
            hinges=freeze(_hinges(domain)),
            reached=freeze(reached),
            forward=freeze(forward),
        )

    def flatten(self, lengths: Floats) -> tuple[Complexes, float]:
        """Lay a metric out in the plane, given by the lengths (m, 3) of half-edges.

        The lengths of counterparts are equal.

        Returns
        -------
        positions : complex128, shape (n,)
            Of the vertices, the anchor at 0, in any rotation.
        defect : float
            The largest remaining angle defect inside, in radians.

        Notes
        -----
        Newton's method on a convex function, some 5 steps. Where one length exceeds the sum of the
        other two the function continues convexly, with the angles 0, 0 and π (Springborn et al.
        2008), so an intermediate metric need not obey the triangle inequality.
        """
        corners, inner = self.domain.corners, self.inner
        logarithms = np.zeros(len(self.place))
        angles, cotangents = _angles(lengths)
        defect = self._defects(angles)
        for _ in range(MOST_STEPS):
            if np.abs(defect).max(initial=0.0) <= ENOUGH:
                break
            direction = factorise_symmetric(self._hessian(cotangents)).solve(-defect)
            slope = float(direction @ defect)
            part = min(1.0, LARGEST_CHANGE / np.abs(direction).max())
            while part > SMALLEST_PART:
                tried = logarithms.copy()
                tried[inner] += part * direction
                angles, cotangents = _angles(_scaled(lengths, tried, corners))
                after = self._defects(angles)
                # For a convex function: it has fallen if its slope has not risen far above 0.
                if float(direction @ after) <= -0.5 * slope:
                    break
                part /= 2
            if part <= SMALLEST_PART:
                break
            logarithms, defect = tried, after
        scaled = _scaled(lengths, logarithms, corners)
        angles, _ = _angles(scaled)
        worst = float(np.abs(self._defects(angles)).max(initial=0.0))
        return self._laid_out(scaled, angles), worst

    def _defects(self, angles: Floats) -> Floats:
        """Return 2π less the sum of the angles (m, 3) around each inner vertex, (i,)."""
        sums = np.bincount(self.domain.corners.ravel(), angles.ravel())
        return np.asarray(2 * np.pi - sums[self.inner])

    def _hessian(self, cotangents: Floats) -> csc_array:
        """Return half the cotangent Laplacian at the inner vertices, from corners' cotangents."""
        start = self.place[self.domain.corners]
        end = np.roll(start, -1, axis=1)
        weights = 0.5 * np.roll(cotangents, 1, axis=1)  # opposite to half-edge k is corner k + 2
        count = len(self.inner)
        diagonal = sum(
            np.bincount(ends[ends >= 0], weights[ends >= 0], minlength=count)
            for ends in (start, end)
        )
        both = (start >= 0) & (end >= 0)
        rows, columns, every = start[both], end[both], np.arange(count)
        values = [np.maximum(diagonal, FLOOR), -weights[both], -weights[both]]
        places = np.hstack([[every, every], [rows, columns], [columns, rows]])
        return csc_array((np.concatenate(values), places), shape=(count, count))

    def _laid_out(self, lengths: Floats, angles: Floats) -> Complexes:
        """Return the positions (n,) of a flat metric, the anchor at 0."""
        # Directions of the half-edges relative to the first of their triangle.
        turned = np.pi - angles
        turned[:, 0] = 0.0
        own = np.cumsum(turned, axis=1).ravel()
        hinge, counterpart = self.hinges.T
        # Counterparts lead in opposite directions.
        steps = np.where(hinge == counterpart, 0.0, own[counterpart] + np.pi - own[hinge])
        direction = self.domain.crossings.sums(steps)
        edges = lengths.ravel() * np.exp(1j * (np.repeat(direction, 3) + own))
        ways = np.where(self.forward, edges[self.reached], -edges[self.reached])
        ways[self.domain.anchor] = 0.0
        return self.domain.tree.sums(ways)


def edge_lengths(domain: TriangulatedDomain, positions: Complexes) -> Floats:
    """Return the length (m, 3) of each half-edge, from corner k to the next."""
    at = positions[domain.corners]
    return np.abs(np.roll(at, -1, axis=1) - at)


def _scaled(lengths: Floats, logarithms: Floats, corners: Indices) -> Floats:
    factors = np.exp(logarithms / 2)[corners]
    return lengths * factors * np.roll(factors, -1, axis=1)


def _angles(lengths: Floats) -> tuple[Floats, Floats]:
    """Return the angles (m, 3) at the corners of triangles, and their cotangents.

    By the half-angle formula, with violations of the triangle inequality clipped to 0.
    """
    half = lengths.sum(axis=1, keepdims=True) / 2
    left = np.maximum(half - lengths, 0.0)  # without half-edge k
    # Opposite to corner k is half-edge k + 1; half-edges k and k + 2 meet at it.
    opposite, after, before = (np.roll(left, shift, axis=1) for shift in (-1, 0, 1))
    sine, cosine = np.sqrt(after * before), np.sqrt(half * opposite)
    angles = 2.0 * np.arctan2(sine, cosine)
    product = 2.0 * sine * cosine
    cotangents = np.zeros_like(angles)
    np.divide(cosine**2 - sine**2, product, out=cotangents, where=product > 0)
    return angles, cotangents


def _hinges(domain: TriangulatedDomain) -> Indices:
    """Return the half-edges that join triangles to their parents; for the root twice its first."""
    counterparts = np.concatenate([domain.counterparts, domain.counterparts[:, ::-1]])
    child, parent = (counterparts // 3).T
    root = domain.crossings.order[0]
    hinges = np.full((len(domain.areas), 2), 3 * root)
    used = (domain.crossings.parent[child] == parent) & (child != root)
    hinges[child[used]] = counterparts[used]
    return hinges


def _reached(domain: TriangulatedDomain) -> tuple[Indices, Booleans]:
    """Return a half-edge between each vertex and its parent, and whether it leads to the vertex."""
    corners, parent = domain.corners, domain.tree.parent
    start, end = corners.ravel(), np.roll(corners, -1, axis=1).ravel()
    reached = np.zeros(len(parent), dtype=np.intp)
    forward = np.ones(len(parent), dtype=np.bool_)
    for vertex, other, leads in ((start, end, False), (end, start, True)):
        used = np.flatnonzero(parent[vertex] == other)
        reached[vertex[used]] = used
        forward[vertex[used]] = leads
    return reached, forward
