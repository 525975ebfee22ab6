"""The functions whose combinations are the maps of a domain, with holes or without.

Φ and Ψ are combinations of the Cauchy coordinates of all cages: the one around the domain, and one
in each hole, which runs clockwise. In the domain the coordinates of a hole's cage give 0 for
constants and decay towards infinity; together they span the single-valued holomorphic functions of
the domain. Each hole adds one function, the logarithm of log-harmonic terms,

    f = Φ + conj(Ψ) + Σ_j 2 a_j ln|z − c_j|,    c_j in hole j,

with a_j / (z − c_j) in f_z and conj(a_j) / (z − c_j) in conj(f_z̄). So Φ and Ψ get the columns ln|z
− c_j| for values and 1 / (z − c_j) for derivatives, with the coefficients a_j and conj(a_j).
"""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, Floats
from engine.geometry import Hole, distance_to_segments
from engine.maps.cauchy import cauchy_coordinates, cauchy_derivatives, difference_jumps, evaluate

# Combinations whose mean square derivative is less than this part of the mean of all are left out.
# Steps along them hardly change the samples, and bend most between them. Cages whose vertices are
# nearer to each other than to the outline have many such combinations.
DEGENERATE = 1e-5


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Span:
    """The n functions of maps: coordinates of all N cage vertices, then logarithms."""

    cage: Complexes
    holes: tuple[Hole, ...] = ()

    @property
    def cages(self) -> tuple[Complexes, ...]:
        """The cage around the domain, then those in its holes."""
        return (self.cage, *(hole.cage for hole in self.holes))

    @property
    def vertices(self) -> Complexes:
        """The vertices of all cages, one cage after the other, complex128 (N,)."""
        return np.concatenate(self.cages)

    @property
    def centres(self) -> Complexes:
        """c_j of each hole, complex128 (holes,)."""
        return np.array([hole.centre for hole in self.holes], dtype=np.complex128)

    @property
    def slices(self) -> tuple[slice, ...]:
        """The slice of the coefficients of each cage."""
        ends = np.cumsum([len(cage) for cage in self.cages]).tolist()
        return tuple(map(slice, [0, *ends[:-1]], ends))

    def __len__(self) -> int:
        return sum(map(len, self.cages)) + len(self.holes)

    def equals(self, other: "Span") -> bool:
        """Whether equal coefficients in both spans mean equal maps."""
        return (
            len(self.holes) == len(other.holes)
            and all(map(np.array_equal, self.cages, other.cages))
            and np.array_equal(self.centres, other.centres)
        )

    def identity(self) -> Complexes:
        """Return the coefficients (n,) of z."""
        return np.concatenate([self.cage, np.zeros(len(self) - len(self.cage))])

    def without_constant(self, coefficients: Complexes) -> Complexes:
        """Return the coefficients (n, ...) of the same function less a constant.

        The derivatives stay the same, and for a shape far from the origin they lose no digits.
        """
        if not self.holes:
            return np.asarray(coefficients - coefficients[0])
        changed = coefficients.copy()
        changed[: len(self.cage)] -= coefficients[0]
        return changed

    def coordinates(self, points: Complexes) -> Complexes:
        columns = [cauchy_coordinates(cage, points) for cage in self.cages]
        return _joined([*columns, self._logarithms(points).astype(np.complex128)])

    def derivatives(self, points: Complexes) -> Complexes:
        columns = [cauchy_derivatives(cage, points) for cage in self.cages]
        return _joined([*columns, 1.0 / (points[:, None] - self.centres)])

    def evaluate(
        self, coefficients: Complexes, points: Complexes, *, orders: tuple[int, ...]
    ) -> list[Complexes]:
        """Evaluate combinations (n, q) of the functions, without forming the coordinates.

        Returns an array (p, q) for each entry of `orders`, as `engine.maps.cauchy.evaluate` does.
        """
        by_cage = [
            evaluate(cage, coefficients[part], points, orders=orders)
            for cage, part in zip(self.cages, self.slices, strict=True)
        ]
        if not self.holes:
            return by_cage[0]
        logs = coefficients[-len(self.holes) :]
        inverse = 1.0 / (points[:, None] - self.centres)
        of_logs = (self._logarithms(points), inverse, -(inverse**2))
        return [
            sum((parts[place] for parts in by_cage), start=of_logs[order] @ logs)
            for place, order in enumerate(orders)
        ]

    def orthonormal_basis(self, derivatives: Complexes, weights: Floats, size: float) -> Complexes:
        """Return combinations of the functions whose derivatives are orthonormal at samples.

        Logarithms are only scaled. First come the constants, one of each cage; around holes the
        other combinations contain no constants. Last come the logarithms.

        Parameters
        ----------
        derivatives, weights : complex128, shape (m, n), and float64, shape (m,)
            Of the functions at the samples, and of the samples.
        size : float
            Value of the constants.

        Returns
        -------
        complex128, shape (n, r)
            One combination a column, without combinations whose derivatives almost vanish.
        """
        starts = [part.start for part in self.slices]
        logs = np.arange(len(self) - len(self.holes), len(self))
        others = np.setdiff1d(np.arange(len(self) - len(logs)), starts)
        rows = np.sqrt(weights)[:, None] * derivatives
        squares, vectors = np.linalg.eigh(rows[:, others].conj().T @ rows[:, others])
        kept = squares > DEGENERATE * squares.mean()
        middle = slice(len(starts), len(starts) + np.count_nonzero(kept))
        basis = np.zeros((len(self), middle.stop + len(logs)), dtype=np.complex128)
        basis[others, middle] = vectors[:, kept] / np.sqrt(squares[kept])
        for part in self.slices[1:]:
            basis[part] -= basis[part].mean(axis=0)
        for column, part in enumerate(self.slices):
            basis[part, column] = size
        basis[logs, np.arange(middle.stop, basis.shape[1])] = 1.0 / np.linalg.norm(
            rows[:, logs], axis=0
        )
        return basis

    def singularity_strengths(self, coefficients: Complexes) -> Floats:
        """Return the strength of each singularity in combinations (n, q) of the functions, (n, q).

        It is the jump of Δφ/Δz at a cage vertex, and the coefficient of a logarithm.
        """
        jumps = [
            np.abs(difference_jumps(cage, coefficients[part]))
            for cage, part in zip(self.cages, self.slices, strict=True)
        ]
        return np.concatenate([*jumps, np.abs(coefficients[len(self) - len(self.holes) :])])

    def third_derivative_kernel(self, starts: Complexes, ends: Complexes) -> Floats:
        """Return the matrix (s, n) that bounds |Φ'''| on segments (s,) from singularity strengths.

        Its entries are 1 / (2π d²) for a cage vertex at the distance d from the segment, 2 / d³ for
        a logarithm.
        """
        to_vertices = distance_to_segments(self.vertices, starts, ends).T
        kernel: Floats = 1.0 / (2 * np.pi * to_vertices**2)
        if not self.holes:
            return kernel
        return np.hstack([kernel, 2.0 / distance_to_segments(self.centres, starts, ends).T ** 3])

    def _logarithms(self, points: Complexes) -> Floats:
        return np.asarray(np.log(np.abs(points[:, None] - self.centres)))


def _joined(columns: list[Complexes]) -> Complexes:
    filled = [column for column in columns if column.shape[1]]
    return filled[0] if len(filled) == 1 else np.hstack(filled)
