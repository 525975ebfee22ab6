"""Keyframes from positions of the boundary: harmonic maps, in closed form or on a mesh.

Figure 7 of the paper takes its keyframes from harmonic coordinates. These are the harmonic
functions that are linear on each edge of the outline and 1 at one of its vertices (Weber and
Gotsman 2010, Section 10). Their map to given positions of the vertices is harmonic, and linear on
each edge.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from app.motion.rival_methods.triangulated_domain import (
    TriangulatedDomain,
    factorise_symmetric,
    solve_complex,
)
from engine.arrays import Complexes, as_points
from engine.errors import EngineError
from engine.geometry import SIZES, diameter, edge_vectors, require_around, require_simple
from engine.maps import HarmonicMap, cauchy_coordinates

# Samples of each edge of the outline: for a fit, over its unknowns, and for the check of its error.
LEAST_PER_EDGE = 16
SAMPLES_PER_UNKNOWN = 3
CHECKED_PER_EDGE = 61
GOOD = 1e-4  # error of a fit, over the size, at which the cage is cut no finer
MOST_CAGE_VERTICES = 200
NEGLIGIBLE = 1e-11  # singular values of the coordinates, over the largest, that are dropped


def harmonic_coordinate_maps(
    outline: npt.ArrayLike, cage: npt.ArrayLike, targets: Sequence[npt.ArrayLike]
) -> tuple[tuple[HarmonicMap, ...], float]:
    """Return the harmonic maps that take an outline's vertices to targets, its edges linearly.

    Parameters
    ----------
    outline : complex, shape (p,)
        Simple, counter-clockwise, inside the cage.
    targets : sequence of complex, shape (p,)
        Of the outline's vertices, in each keyframe.

    Returns
    -------
    maps : tuple of HarmonicMap
        Over one cage: the given one, its edges cut up.
    error : float
        Largest distance from the targets on the outline, over the diameter of the targets: the maps
        are fitted in the span of the Cauchy coordinates, by least squares.

    Raises
    ------
    EngineError
        If a polygon is invalid, or there are not as many targets as vertices.

    Notes
    -----
    Harmonic coordinates do not exclude folds; interpolation reports a map that folds.
    """
    outline = as_points(outline, "outline", at_least=3)
    cage = as_points(cage, "cage", at_least=3)
    require_simple(outline, "outline")
    require_around(cage, outline)
    wanted = np.array([_checked_targets(each, i, outline) for i, each in enumerate(targets)])
    if not wanted.size or np.abs(wanted).max() > SIZES[1]:
        raise EngineError("Give at least one keyframe, with finite positions only.")
    size = max(map(diameter, wanted))
    if size < SIZES[0]:
        raise EngineError("In every keyframe the boundary must map to more than one point.")
    best: tuple[float, Complexes, Complexes] | None = None
    pieces = 1
    while best is None or (best[0] > GOOD * size and pieces * len(cage) <= MOST_CAGE_VERTICES):
        fine = _cut(cage, pieces)
        found = _fitted(outline, fine, wanted)
        error = _largest_error(outline, fine, wanted, found)
        if best is None or error < best[0]:
            best = error, fine, found
        pieces *= 2
    error, fine, found = best
    phi, psi = found[: len(fine)].T, found[len(fine) :].conj().T
    return (
        tuple(HarmonicMap(cage=fine, phi=a, psi=b) for a, b in zip(phi, psi, strict=True)),
        error / size,
    )


def discrete_harmonic(domain: TriangulatedDomain, positions: npt.ArrayLike) -> Complexes:
    """Return the discrete harmonic map with given positions of the vertices on the border.

    Parameters
    ----------
    positions : complex, shape (n,)
        Of all vertices; those of inner ones are ignored.

    Returns
    -------
    complex128, shape (n,)
        Inside, the means of the neighbours with cotangent weights: of all maps that are linear in
        each triangle, the one of least Dirichlet energy (Pinkall and Polthier 1993).
    """
    found = as_points(positions, "positions").copy()
    if len(found) != len(domain.points):
        raise EngineError(
            "{count} vertices need {count} positions, not {given}.",
            count=len(domain.points),
            given=len(found),
        )
    inner, outer = np.flatnonzero(~domain.border), np.flatnonzero(domain.border)
    if len(inner):
        rows = domain.laplacian()[inner]
        right = np.asarray(rows[:, outer] @ found[outer])
        found[inner] = solve_complex(factorise_symmetric(rows[:, inner]), -right)
    return found


def _checked_targets(values: npt.ArrayLike, number: int, outline: Complexes) -> Complexes:
    targets = as_points(values, f"The boundary of keyframe {number}")
    if len(targets) != len(outline):
        raise EngineError(
            "The boundary of keyframe {number} has {count} positions, but the outline has "
            "{vertices} vertices.",
            number=number,
            count=len(targets),
            vertices=len(outline),
        )
    return targets


def _fitted(outline: Complexes, cage: Complexes, wanted: Complexes) -> Complexes:
    """Return φ and conj(ψ), one under the other, of each keyframe (q, p): (2 N, q)."""
    count = max(LEAST_PER_EDGE, -(-SAMPLES_PER_UNKNOWN * 2 * len(cage) // len(outline)))
    samples, right = _along(outline, wanted, count, 0.0)
    spacing = np.abs(np.roll(samples, -1) - np.roll(samples, 1))
    weights = np.sqrt(spacing)[:, None]
    matrix = weights * _both(cage, samples)
    found, *_ = np.linalg.lstsq(matrix, weights * right, rcond=NEGLIGIBLE)
    return np.asarray(found, dtype=np.complex128)


def _largest_error(
    outline: Complexes, cage: Complexes, wanted: Complexes, found: Complexes
) -> float:
    """Return the distance of fitted maps from the wanted positions, also between the samples."""
    samples, right = _along(outline, wanted, CHECKED_PER_EDGE, 0.5)
    return float(np.abs(_both(cage, samples) @ found - right).max())


def _both(cage: Complexes, points: Complexes) -> Complexes:
    """Return the matrix of Φ + conj(Ψ), which is linear in φ and conj(ψ)."""
    coordinates = cauchy_coordinates(cage, points)
    return np.hstack([coordinates, coordinates.conj()])


def _along(
    outline: Complexes, wanted: Complexes, count: int, shift: float
) -> tuple[Complexes, Complexes]:
    """Return samples of an outline (s,), denser beside its vertices, and targets (s, q) there."""
    place = (1.0 - np.cos(np.pi * (np.arange(count) + shift) / count)) / 2.0
    samples = (outline[:, None] + edge_vectors(outline)[:, None] * place).ravel()
    after = np.roll(wanted, -1, axis=1)
    at_samples = wanted[:, :, None] * (1.0 - place) + after[:, :, None] * place
    return samples, at_samples.reshape(len(wanted), -1).T


def _cut(cage: Complexes, pieces: int) -> Complexes:
    """Return a cage with each edge cut into equal parts."""
    place = np.arange(pieces) / pieces
    return (cage[:, None] + edge_vectors(cage)[:, None] * place).ravel()
