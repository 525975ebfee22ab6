"""In-betweens around holes: the smallest holomorphic correction that closes their periods.

In a domain with holes the blends F^t of f_z and G^t of conj(f_z̄) are single-valued, but their
integral f^t is not: around hole j it gains p_j = ∮ F^t dz + conj(∮ G^t dz). With a holomorphic,
single-valued h,

    F^t e^h, G^t e^h    keep ν = G/F (ν variant: Property 5 holds on),
    F^t e^h, G^t e^−h   keep η = conj(F G) (η and metric variants),

and among all h with p_j = 0 for every j, and h = 0 at the anchor, the one with the least ∫ |h|² ds
over the boundary is taken. p is real-linear in small changes of h, so that this is a Gauss-Newton
iteration with 2 m + 2 real constraints for m holes; it depends analytically on t, and comes as a
few functions of the place times series in time.

The metric variant wants ln |f_z^t| on the boundary, Equation (13), and gets it but for a constant
around each hole (`engine.dirichlet`). There h has the least ∫ (Re h − what is lacking)² ds under
closed periods, and turns nothing at the anchor.

Not in the paper, whose domains are simply connected.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt
import scipy.linalg

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.interpolation.chebyshev import PiecewiseSeries, separate
from engine.maps import Boundary
from engine.paths import Loops

# Directions of the span that are smaller than this, over the largest, are rounding: the coordinates
# of cages near the boundary are nearly dependent.
RANK = 1e-6
RIDGE = 1e-12  # of the mean: what makes the real parts' least squares definite
CLOSED = 1e-14  # of the diagonal: where the iteration may end
MOST_STEPS = 15
HALVINGS = 8
ROUNDING = 1e-13  # of the diagonal: periods below are rounding
SHORTEST = 2.0**-5  # pieces of time are not halved below this
TOLERANCE = 1e-11  # of the series in time
LEFT_OUT = 2e-11  # of the modes: the periods are closed as far


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Residual:
    """Σ c_j(t) H_j; what is added to a blend vanishes at both keyframes.

    Parameters
    ----------
    series : PiecewiseSeries
        c_j.
    modes : complex128, shape (j, s)
        H_j at the nodes of the paths.
    modes_z : complex64, shape (j, s)
        H_j' there: the square of a step multiplies it, and single precision is plenty.
    """

    series: PiecewiseSeries
    modes: Complexes
    modes_z: npt.NDArray[np.complex64]

    @classmethod
    def of(cls, series: PiecewiseSeries, values: Complexes, slopes: Complexes) -> Self:
        """Pack functions given with their derivatives, each (s, j)."""
        return cls(
            series=series,
            modes=freeze(np.ascontiguousarray(values.T)),
            modes_z=freeze(slopes.T.astype(np.complex64, order="C")),
        )

    def at(self, which: Indices) -> "Residual":
        """Return the same at some of the nodes (c,)."""
        return Residual(
            series=self.series,
            modes=freeze(np.ascontiguousarray(self.modes[:, which])),
            modes_z=freeze(np.ascontiguousarray(self.modes_z[:, which])),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        return self.modes.nbytes + self.modes_z.nbytes + self.series.coefficients.nbytes

    def add_to(self, logarithm: Complexes, logarithm_z: Complexes, time: float) -> None:
        """Add it to log f_z and its derivative, each (s,), in place."""
        coefficients = self.series(time)
        # As reals: a complex product with real coefficients would do half its work on zeros.
        logarithm.view(np.float64)[:] += coefficients @ self.modes.view(np.float64)
        single = coefficients.astype(np.float32)
        logarithm_z.view(np.float64)[:] += single @ self.modes_z.view(np.float32)


class Open(NamedTuple):
    """An in-between before its correction, at the nodes of the loops around the holes.

    Parameters
    ----------
    fz, g : complex128, shape (c,)
        f_z and conj(f_z̄).
    lacking : float64, shape (holes,), or None
        Constants that the real part of h is to make good on the boundary of each hole; None for
        the smallest h.
    """

    fz: Complexes
    g: Complexes
    lacking: Floats | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Closing:
    """The correction of the in-betweens of two keyframes.

    Parameters
    ----------
    series : PiecewiseSeries
        Of the coefficients of few functions.
    functions : complex128, shape (n, j)
        These in the span: h is their sum.
    residual : Residual
        h at the nodes of the paths.
    largest : float
        The largest |h| on the boundary at the times that were looked at.
    """

    series: PiecewiseSeries
    functions: Complexes
    residual: Residual
    largest: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PeriodClosing:
    """What the corrections of all in-betweens of a domain share.

    Build it with `PeriodClosing.of`.

    Parameters
    ----------
    boundary : Boundary
    loops : Loops
    basis : complex128, shape (c, b)
        Functions of the span at the nodes of the loops, orthonormal on the boundary.
    on_boundary : complex128, shape (m, b)
        The same at the samples of the boundary.
    at_anchor : complex128, shape (b,)
        The same at the anchor.
    coefficients : complex128, shape (n, b)
        The same in the span.
    inverse : float64, shape (2b, 2b)
        Of the Gram matrix of the real parts on the boundary, and the imaginary one at the anchor.
    shares : float64, shape (holes, 2b)
        Integral of the real part over the boundary of a hole, over the length of the whole.
    """

    boundary: Boundary
    loops: Loops
    basis: Complexes
    on_boundary: Complexes
    at_anchor: Complexes
    coefficients: Complexes
    inverse: Floats
    shares: Floats

    @classmethod
    def of(cls, boundary: Boundary, loops: Loops, anchor: complex) -> Self:
        """Prepare the boundary of a domain with holes."""
        span = boundary.span
        count = len(span.vertices)  # logarithms are not single-valued functions
        samples = span.coordinates(boundary.points)[:, :count]
        root = np.sqrt(boundary.weights)[:, None]
        _, lengths, directions = scipy.linalg.svd(root * samples, full_matrices=False)
        kept = lengths > RANK * lengths[0]
        own = directions[kept].conj().T / lengths[kept]
        on_boundary = samples @ own
        reals = root * np.hstack([on_boundary.real, -on_boundary.imag])
        at_anchor = (span.coordinates(np.array([anchor]))[:, :count] @ own)[0]
        turn = np.concatenate([at_anchor.imag, at_anchor.real])
        # Im h is 0 at the anchor; without that an imaginary constant would be free.
        gram = reals.T @ reals + np.outer(turn, turn)
        gram[np.diag_indices_from(gram)] += RIDGE * np.trace(gram) / len(gram)
        ends = pairwise([*boundary.starts[1:], len(boundary.points)])
        logs = np.zeros((len(span) - count, own.shape[1]))
        return cls(
            boundary=boundary,
            loops=loops,
            basis=freeze(span.coordinates(loops.nodes)[:, :count] @ own),
            on_boundary=freeze(on_boundary),
            at_anchor=freeze(at_anchor),
            coefficients=freeze(np.vstack([own, logs])),
            inverse=freeze(scipy.linalg.inv(gram)),
            shares=freeze(np.array([(root * reals)[a:b].sum(axis=0) for a, b in ends])),
        )

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        arrays = (self.basis, self.on_boundary, self.coefficients, self.inverse)
        return sum(array.nbytes for array in arrays)

    def close(
        self,
        opened: Callable[[float], Open],
        points: Complexes,
        *,
        sign: int,
        breaks: Sequence[float] = (0.0, 1.0),
        to_conformal: bool = False,
    ) -> Closing:
        """Close the periods of in-betweens at all times.

        Parameters
        ----------
        opened : callable
            Returns the in-between at a time in [0, 1] before its correction.
        points : complex128, shape (s,)
            Where the correction is wanted; the first is the anchor.
        sign : {1, -1}
            1 keeps ν, −1 keeps η.
        breaks : sequence of float
            From 0 to 1: where the in-betweens may have kinks in time.
        to_conformal : bool
            Whether not h is wanted, but what leads on from there to the correction of f_z alone,
            without f_z̄.
        """
        largest = 0.0

        def solved(here: Open) -> Floats:
            parts, _ = self.correction(here, sign)
            if to_conformal:
                parts = self.correction(here._replace(g=0.0 * here.g), sign)[0] - parts
            return parts

        def corrections(times: Floats) -> Floats:
            nonlocal largest
            found = np.array([solved(opened(float(time))) for time in times]).T
            h = self.on_boundary @ as_complex(found)
            largest = max(largest, float(np.abs(h).max()))
            return found

        forms, series = separate(
            corrections,
            tolerance=TOLERANCE,
            left_out=LEFT_OUT,
            shortest=SHORTEST,
            breaks=breaks,
            vanishing=not to_conformal,
        )
        functions = self.coefficients @ as_complex(forms)
        values, slopes = self.boundary.span.evaluate(functions, points, orders=(0, 1))
        return Closing(
            series=series,
            functions=freeze(functions),
            residual=Residual.of(series, values, slopes),
            largest=largest,
        )

    def correction(self, opened: Open, sign: int) -> tuple[Floats, float]:
        """Return h by its parts (2b,) in the basis, and the largest period left over the diagonal.

        Parameters
        ----------
        opened : Open
        sign : {1, -1}
            1 keeps ν, −1 keeps η.
        """
        fz, g, lacking = opened
        goal = np.zeros(len(self.inverse))
        if lacking is not None:
            goal = self.inverse @ (lacking @ self.shares)
        parts, size = goal, self.boundary.size
        periods, rows = self._linearised(fz, g, parts, sign)
        anchor = np.concatenate([self.at_anchor, 1j * self.at_anchor])
        # With something lacking h may stretch the anchor, but not turn it.
        fixed = [anchor.imag] if lacking is not None else [anchor.imag, anchor.real]
        for _ in range(MOST_STEPS):
            gap = float(np.abs(periods).max())
            constraints = np.vstack([rows.real, rows.imag, *fixed])
            wanted = np.zeros(len(constraints))
            linear = rows @ parts - periods
            wanted[: 2 * len(periods)] = np.concatenate([linear.real, linear.imag])
            if np.abs(constraints @ parts - wanted).max() <= CLOSED * size:
                break
            spread = constraints if lacking is None else constraints @ self.inverse
            multipliers, *_ = np.linalg.lstsq(
                spread @ constraints.T, wanted - constraints @ goal, rcond=None
            )
            step = goal + spread.T @ multipliers - parts
            for _ in range(HALVINGS):
                tried = self._linearised(fz, g, parts + step, sign)
                if not np.abs(tried[0]).max() > max(gap, ROUNDING * size):
                    break
                step = step / 2
            else:
                break
            parts, (periods, rows) = parts + step, tried
            if np.abs(step).max() <= CLOSED:
                break
        return parts, float(np.abs(periods).max()) / size

    def _linearised(
        self, fz: Complexes, g: Complexes, parts: Floats, sign: int
    ) -> tuple[Complexes, Complexes]:
        """Return the periods (holes,) with h, and what its parts change of them, (holes, 2b)."""
        h = self.basis @ as_complex(parts)
        growth = np.exp(h)
        f_now = fz * growth
        g_now = g * growth if sign > 0 else g / growth
        both = np.column_stack([f_now, g_now])
        of_f, of_g = self.loops.integrals(both).T
        by_f = self._moments(f_now)
        by_g = sign * self._moments(g_now).conj()
        return of_f + of_g.conj(), np.hstack([by_f + by_g, 1j * (by_f - by_g)])

    def _moments(self, values: Complexes) -> Complexes:
        """Integrate values (c,) times each function of the basis over each loop, (holes, b)."""
        each = values * self.loops.differentials
        ends = [*self.loops.starts[1:], len(each)]
        return np.array(
            [
                each[start:end] @ self.basis[start:end]
                for start, end in zip(self.loops.starts, ends, strict=True)
            ]
        )


def as_complex(parts: Floats) -> Complexes:
    """Return complex numbers (b, ...) from their real parts and, below, the imaginary ones."""
    real, imaginary = np.split(parts, 2)
    return np.asarray(real + 1j * imaginary)
