"""Cauchy integrals of densities on panels, evaluated at many points up to the outline itself.

Points are sorted into squares. What panels far from a square contribute is one Taylor polynomial
for all its points; panels that are far from a quarter of the square but not from the whole are
added to the quarter's polynomial, and so on; the few panels near a point are integrated exactly.
Time and memory grow with the sum of points and nodes, not with their product.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from scipy.special import comb

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.dirichlet.panels import Panels
from engine.dirichlet.product_integration import near_distance, panel_weights
from engine.geometry import distance_to_segments

TERMS = 24
# Distance of far panels over the radius of a square: Taylor polynomials err by FAR^-TERMS = 3e-10.
FAR = 2.5
# Pairs of points and near panels up to which a square is not divided: cheaper than dividing it.
FEW_PAIRS = 256
BLOCK = 4096  # points that are integrated exactly at a time


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Square:
    """Some of the points, with what is known of the integral there.

    Parameters
    ----------
    points : intp, shape (t,)
        Numbers of the points.
    centre, radius : complex, float
        Of a disc that holds them.
    panels : intp, shape (p,)
        Numbers of the panels that `taylor` lacks.
    taylor : complex128, shape (TERMS, j)
        Coefficients of ((z − centre) / radius)^k.
    """

    points: Indices
    centre: complex
    radius: float
    panels: Indices
    taylor: Complexes


def cauchy_integrals(
    panels: Panels, densities: Floats, points: Complexes
) -> tuple[Complexes, Complexes]:
    """Return g(z) = 1/(2πi) ∮ μ dζ / (ζ − z) and g'(z) of some densities at points.

    Parameters
    ----------
    panels : Panels
    densities : float64, shape (N, j)
        At the nodes of the panels.
    points : complex128, shape (t,)
        Strictly inside the outline, by some 1e-14 of its size at least.

    Returns
    -------
    values, derivatives : complex128, shape (t, j)

    Notes
    -----
    g' is the Cauchy integral of dμ/dζ. By differentiating under the integral instead, the small
    jumps of a discrete μ between panels would become poles on the outline.
    """
    count, columns = len(panels), densities.shape[1]
    by_panel = np.asarray(densities.reshape(count, -1, columns) / (2j * np.pi), np.complex128)
    masses = np.concatenate(
        [by_panel * panels.differentials()[:, :, None], panels.increments(by_panel)], axis=2
    )
    results = np.empty((len(points), 2 * columns), dtype=np.complex128)
    near: list[list[Indices]] = [[] for _ in range(count)]
    for leaf in _leaves(panels, masses, points):
        offsets = (points[leaf.points] - leaf.centre) / leaf.radius
        results[leaf.points] = np.vander(offsets, TERMS, increasing=True) @ leaf.taylor
        for panel in leaf.panels:
            near[panel].append(leaf.points)
    values, derivatives = results[:, :columns], results[:, columns:]
    for panel, groups in enumerate(near):
        for points_near in _blocks(groups):
            w = (points[points_near] - panels.origin[panel]) / panels.span[panel]
            weights, derivative_weights = panel_weights(w, int(panels.power[panel]))
            own = by_panel[panel] * (1.0 if panels.forward[panel] else -1.0)
            values[points_near] += weights @ own
            derivatives[points_near] += derivative_weights @ own / panels.span[panel]
    return values, derivatives


def _leaves(panels: Panels, masses: Complexes, points: Complexes) -> Iterator[Square]:
    """Divide the points until each square has few panels near it."""
    lengths = np.abs(panels.span)
    near = near_distance(panels.power) * lengths
    everything = np.zeros((TERMS, masses.shape[2]), dtype=np.complex128)
    nodes = panels.nodes
    stack = [_square(np.arange(len(points)), points, np.arange(len(panels)), everything)]
    while stack:
        square = _absorb(panels, nodes, near, masses, stack.pop())
        left = square.panels
        if len(left) * len(square.points) <= FEW_PAIRS or square.radius <= lengths[left].min() / 4:
            yield square
        else:
            stack.extend(_quarters(square, points))


def _square(points: Indices, z: Complexes, panels: Indices, taylor: Complexes) -> Square:
    box = z[points]
    low = complex(box.real.min(), box.imag.min())
    high = complex(box.real.max(), box.imag.max())
    # A single point has no extent, but the polynomial wants a radius.
    radius = max(abs(high - low) / 2, 1e-12 * abs(high), 1e-100)
    return Square(
        points=points, centre=(low + high) / 2, radius=radius, panels=panels, taylor=taylor
    )


def _absorb(
    panels: Panels, nodes: Complexes, near: Floats, masses: Complexes, square: Square
) -> Square:
    """Move the panels that are far from a square into its polynomial."""
    own = square.panels
    starts = panels.origin[own]
    centre = np.array([square.centre])
    distance = distance_to_segments(centre, starts, starts + panels.span[own])[0]
    far = distance >= np.maximum(FAR * square.radius, square.radius + near[own])
    inverse = square.radius / (nodes[own[far]].ravel() - square.centre)
    powers = np.empty((TERMS, len(inverse)), dtype=np.complex128)
    np.divide(inverse, square.radius, out=powers[0])
    for term in range(1, TERMS):
        np.multiply(powers[term - 1], inverse, out=powers[term])
    added = powers @ masses[own[far]].reshape(len(inverse), masses.shape[2])
    return replace(square, panels=own[~far], taylor=square.taylor + added)


def _quarters(square: Square, z: Complexes) -> Iterator[Square]:
    offset = z[square.points] - square.centre
    quadrant = (offset.real > 0) + 2 * (offset.imag > 0)
    for k in range(4):
        points = square.points[quadrant == k]
        if len(points):
            quarter = _square(points, z, square.panels, square.taylor)
            yield replace(quarter, taylor=_translated(square, quarter))


def _translated(square: Square, quarter: Square) -> Complexes:
    """Expand the polynomial of a square about the centre of one of its quarters."""
    shift = (quarter.centre - square.centre) / square.radius
    shrink = quarter.radius / square.radius
    ranks = np.arange(TERMS)
    powers, shrunk = shift**ranks, shrink**ranks
    matrix = _binomials() * powers[np.maximum(ranks - ranks[:, None], 0)] * shrunk[:, None]
    return np.asarray(matrix @ square.taylor)


def _blocks(groups: list[Indices]) -> Iterator[Indices]:
    points = np.concatenate(groups) if groups else np.empty(0, dtype=np.intp)
    for start in range(0, len(points), BLOCK):
        yield points[start : start + BLOCK]


@cache
def _binomials() -> Floats:
    """Return [j, k]: what ((z − c) + d)^k gives to (z − c)^j."""
    ranks = np.arange(TERMS)
    return freeze(comb(ranks, ranks[:, None]).astype(np.float64))
