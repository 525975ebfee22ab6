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

The smallest change of h is a combination of the functions that stand for the constraints: δh ↦
∮ F e^h δh dz is the product with one of them. F e^h and G e^±h being smooth around a hole, all of
these are nearly sums of the few that stand for ∮ (z − c_j)^k δh dz with |k| small, whatever the
keyframes are. h is sought among those, which are worked out once: it closes the periods to rounding
all the same, and is as small as can be to some 1e-4 of itself.

The metric variant wants ln |f_z^t| on the boundary, Equation (13), and gets it but for a constant
around each hole (`engine.dirichlet`). There h has the least ∫ (Re h − what is lost)² ds under
closed periods, and turns nothing at the anchor.

Not in the paper, whose domains are simply connected.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, TypeVar

import numpy as np

from engine.arrays import Complexes, Floats, freeze
from engine.interpolation.added.periods.basis import PeriodBasis, as_complex
from engine.interpolation.series import PiecewiseSeries, Residual, separate

CLOSED = 1e-14  # of the diagonal: where the iteration may end
MOST_STEPS = 15
HALVINGS = 8
ROUNDING = 1e-13  # of the diagonal: periods below are rounding
INDEPENDENT = 1e-13  # of the largest: constraints below depend on the others
SHORTEST = 2.0**-5  # pieces of time are not halved below this
TOLERANCE = 1e-11  # of the series in time
LEFT_OUT = 2e-11  # of the modes: the periods are closed as far

Numbers = TypeVar("Numbers", Floats, Complexes)


class Unclosed(NamedTuple):
    """In-betweens before their correction, at times (t,) and the nodes of the loops around holes.

    Parameters
    ----------
    fz, g : complex128, shape (t, c)
        f_z and conj(f_z̄).
    constants : float64, shape (t, holes), or None
        Constants that the real part of h is to make good on the boundary of each hole; None for
        the smallest h.
    """

    fz: Complexes
    g: Complexes
    constants: Floats | None = None


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

    def leading(self, left_out: float) -> tuple[Complexes, PiecewiseSeries]:
        """Return the functions (n, i), and their series, that make h but for a small rest.

        Parameters
        ----------
        left_out : float
            Of the rest, on the boundary.
        """
        coefficients = self.series.coefficients
        sizes = np.sqrt((coefficients**2).sum(axis=(0, 1)))
        kept = sizes > min(left_out, sizes.max())
        series = replace(self.series, coefficients=freeze(coefficients[:, :, kept]))
        return self.functions[:, kept], series


def close(
    basis: PeriodBasis,
    unclosed: Callable[[Floats], Unclosed],
    *,
    sign: int,
    breaks: Sequence[float] = (0.0, 1.0),
) -> Closing:
    """Close the periods of in-betweens at all times.

    Parameters
    ----------
    unclosed : callable
        Returns the in-betweens at times (t,) in [0, 1] before their correction.
    sign : {1, -1}
        1 keeps ν, −1 keeps η.
    breaks : sequence of float
        From 0 to 1: where the in-betweens may have kinks in time.
    """
    return _in_series(
        basis,
        lambda times: correction(basis, unclosed(times), sign)[0],
        breaks=breaks,
        vanishing=True,
    )


def to_conformal(
    basis: PeriodBasis,
    unclosed: Callable[[Floats], Unclosed],
    *,
    sign: int,
    breaks: Sequence[float] = (0.0, 1.0),
) -> Closing:
    """Return what leads on from there to the correction of f_z alone, without f_z̄."""

    def further(times: Floats) -> Floats:
        here = unclosed(times)
        alone = here._replace(g=np.zeros_like(here.g))
        return correction(basis, alone, sign)[0] - correction(basis, here, sign)[0]

    return _in_series(basis, further, breaks=breaks, vanishing=False)


def _in_series(
    basis: PeriodBasis,
    corrections: Callable[[Floats], Floats],
    *,
    breaks: Sequence[float],
    vanishing: bool,
) -> Closing:
    """Write corrections (t, 2b) in few functions."""
    largest = 0.0

    def found(times: Floats) -> Floats:
        nonlocal largest
        parts = corrections(times).T
        largest = max(largest, float(np.abs(basis.on_boundary @ as_complex(parts)).max()))
        return parts

    forms, series = separate(
        found,
        tolerance=TOLERANCE,
        left_out=LEFT_OUT,
        shortest=SHORTEST,
        breaks=breaks,
        vanishing=vanishing,
    )
    parts = as_complex(forms)
    return Closing(
        series=series,
        functions=freeze(basis.coefficients @ parts),
        residual=Residual(
            series=series,
            modes=freeze(parts.T @ basis.at_nodes),
            modes_z=freeze(parts.T.astype(np.complex64) @ basis.slopes),
        ),
        largest=largest,
    )


def correction(basis: PeriodBasis, unclosed: Unclosed, sign: int) -> tuple[Floats, Floats]:
    """Return h by its parts (t, 2b) in the basis, and the largest period left at each time.

    The latter, (t,), is over the diagonal.

    Parameters
    ----------
    unclosed : Unclosed
    sign : {1, -1}
        1 keeps ν, −1 keeps η.
    """
    fz, g, constants = unclosed
    goal = np.zeros((len(fz), len(basis.inverse)))
    if constants is not None:
        goal = constants @ basis.shares @ basis.inverse
    parts, size = goal, basis.size
    periods, rows = _linearised(basis, fz, g, parts, sign)
    anchor = np.concatenate([basis.at_anchor, 1j * basis.at_anchor])
    # With constants to make good h may stretch the anchor, but not turn it.
    fixed = np.array([anchor.imag] if constants is not None else [anchor.imag, anchor.real])
    fixed = np.broadcast_to(fixed, (len(fz), *fixed.shape))
    moving = np.ones(len(fz), np.bool_)
    for _ in range(MOST_STEPS):
        gap = np.abs(periods).max(axis=1)
        constraints = np.concatenate([rows.real, rows.imag, fixed], axis=1)
        linear = _applied(rows, parts) - periods
        wanted = np.zeros(constraints.shape[:2])
        wanted[:, : 2 * periods.shape[1]] = np.hstack([linear.real, linear.imag])
        moving &= np.abs(_applied(constraints, parts) - wanted).max(axis=1) > CLOSED * size
        if not moving.any():
            break
        spread = constraints if constants is None else constraints @ basis.inverse
        across = np.linalg.pinv(
            spread @ constraints.swapaxes(1, 2), rcond=INDEPENDENT, hermitian=True
        )
        multipliers = _applied(across, wanted - _applied(constraints, goal))
        step = goal + _applied(spread.swapaxes(1, 2), multipliers) - parts
        step[~moving] = 0.0
        for _ in range(HALVINGS):
            tried = _linearised(basis, fz, g, parts + step, sign)
            is_nearer = np.abs(tried[0]).max(axis=1) <= np.maximum(gap, ROUNDING * size)
            if is_nearer.all():
                break
            step[~is_nearer] /= 2
        else:
            moving &= is_nearer
            step[~is_nearer] = 0.0
            tried = _linearised(basis, fz, g, parts + step, sign)
        parts, (periods, rows) = parts + step, tried
        moving &= np.abs(step).max(axis=1) > CLOSED
    return parts, np.abs(periods).max(axis=1) / size


def _linearised(
    basis: PeriodBasis, fz: Complexes, g: Complexes, parts: Floats, sign: int
) -> tuple[Complexes, Complexes]:
    """Return the periods (t, holes) with h, and what its parts change of them.

    The latter is (t, holes, 2b).
    """
    growth = np.exp(as_complex(parts.T).T @ basis.basis.T)
    f_now = fz * growth
    g_now = g * growth if sign > 0 else g / growth
    of_f, of_g = basis.loops.integrals(f_now), basis.loops.integrals(g_now)
    by_f = basis.loops.products(f_now, basis.basis)
    by_g = sign * basis.loops.products(g_now, basis.basis).conj()
    return of_f + of_g.conj(), np.concatenate([by_f + by_g, 1j * (by_f - by_g)], axis=2)


def _applied(matrices: Numbers, vectors: Floats) -> Numbers:
    """Return the product of each matrix (t, r, n) with its vector (t, n), (t, r)."""
    product: Numbers = (matrices @ vectors[:, :, None])[:, :, 0]
    return product
