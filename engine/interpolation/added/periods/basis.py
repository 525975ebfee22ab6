"""The functions that close periods around holes (`engine.interpolation.added.periods`)."""

from dataclasses import dataclass
from itertools import pairwise
from typing import Self

import numpy as np
import numpy.typing as npt
import scipy.linalg

from engine.arrays import Complexes, Floats, freeze
from engine.maps import Boundary
from engine.paths import Loops

# Directions of the span that are smaller than this, over the largest, are rounding: the coordinates
# of cages near the boundary are nearly dependent.
RANK = 1e-6
RIDGE = 1e-12  # of the mean: what makes the real parts' least squares definite
MOMENTS = 3  # powers of z − c_j on either side, −3 to 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PeriodBasis:
    """What the corrections of all in-betweens of a domain share: functions of which they are sums.

    Build it with `PeriodBasis.of`.

    Parameters
    ----------
    loops : Loops
    size : float
        Diagonal of the domain.
    basis : complex128, shape (c, b)
        Functions of the span at the nodes of the loops, orthonormal on the boundary.
    on_boundary : complex128, shape (m, b)
        The same at the samples of the boundary.
    at_anchor : complex128, shape (b,)
        The same at the anchor.
    coefficients : complex128, shape (n, b)
        The same in the span.
    at_nodes : complex128, shape (b, s)
        The same at the nodes of the paths.
    slopes : complex64, shape (b, s)
        Their derivatives there.
    inverse : float64, shape (2b, 2b)
        Of the Gram matrix of the real parts on the boundary, and the imaginary one at the anchor.
    shares : float64, shape (holes, 2b)
        Integral of the real part over the boundary of a hole, over the length of the whole.
    """

    loops: Loops
    size: float
    basis: Complexes
    on_boundary: Complexes
    at_anchor: Complexes
    coefficients: Complexes
    at_nodes: Complexes
    slopes: npt.NDArray[np.complex64]
    inverse: Floats
    shares: Floats

    @classmethod
    def of(cls, boundary: Boundary, loops: Loops, nodes: Complexes) -> Self:
        """Prepare the boundary of a domain with holes, and paths through nodes (s,).

        The first node is the anchor.
        """
        span = boundary.span
        count = len(span.vertices)  # logarithms are not single-valued functions
        samples = span.coordinates(boundary.points)[:, :count]
        root = np.sqrt(boundary.weights)[:, None]
        _, lengths, directions = scipy.linalg.svd(root * samples, full_matrices=False)
        kept = lengths > RANK * lengths[0]
        own = directions[kept].conj().T / lengths[kept]
        on_boundary, at_anchor = samples @ own, (span.coordinates(nodes[:1])[:, :count] @ own)[0]
        at_loops = span.coordinates(loops.nodes)[:, :count] @ own
        gram, shares = _real_parts(on_boundary, at_anchor, boundary)
        constants = as_complex(scipy.linalg.solve(gram, shares.T, assume_a="pos"))
        moments = np.vstack([_moments(at_loops, loops, span.centres), at_anchor])
        few, _ = np.linalg.qr(_unit(np.hstack([moments.conj().T, constants])))
        on_boundary, at_anchor = on_boundary @ few, at_anchor @ few
        gram, shares = _real_parts(on_boundary, at_anchor, boundary)
        logs = np.zeros((len(span) - count, few.shape[1]))
        coefficients = np.vstack([own @ few, logs])
        values, slopes = span.evaluate(coefficients, nodes, orders=(0, 1))
        return cls(
            loops=loops,
            size=boundary.size,
            basis=freeze(at_loops @ few),
            on_boundary=freeze(on_boundary),
            at_anchor=freeze(at_anchor),
            coefficients=freeze(coefficients),
            at_nodes=freeze(np.ascontiguousarray(values.T)),
            slopes=freeze(slopes.T.astype(np.complex64, order="C")),
            inverse=freeze(scipy.linalg.inv(gram)),
            shares=freeze(shares),
        )


def _moments(values: Complexes, loops: Loops, centres: Complexes) -> Complexes:
    """Integrate functions (c, b) times low powers of z − c_j over each loop, (moments, b)."""
    away = loops.nodes - np.repeat(centres, loops.counts)
    powers = np.array([away**power for power in range(-MOMENTS, MOMENTS)])
    return loops.products(powers, values).reshape(-1, values.shape[1])


def _unit(columns: Complexes) -> Complexes:
    scaled: Complexes = columns / np.linalg.norm(columns, axis=0)
    return scaled


def _real_parts(
    on_boundary: Complexes, at_anchor: Complexes, boundary: Boundary
) -> tuple[Floats, Floats]:
    """Return the Gram matrix (2b, 2b) of the functions' real parts, and `PeriodBasis.shares`."""
    root = np.sqrt(boundary.weights)[:, None]
    reals = root * np.hstack([on_boundary.real, -on_boundary.imag])
    turn = np.concatenate([at_anchor.imag, at_anchor.real])
    # Im h is 0 at the anchor; without that an imaginary constant would be free.
    gram = reals.T @ reals + np.outer(turn, turn)
    gram[np.diag_indices_from(gram)] += RIDGE * np.trace(gram) / len(gram)
    ends = pairwise([*boundary.starts[1:], len(boundary.points)])
    return gram, np.array([(root * reals)[a:b].sum(axis=0) for a, b in ends])


def as_complex(parts: Floats) -> Complexes:
    """Return complex numbers (b, ...) from their real parts and, below, the imaginary ones."""
    real, imaginary = np.split(parts, 2)
    return np.asarray(real + 1j * imaginary)
