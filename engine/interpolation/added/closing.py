"""In-betweens around holes: the smallest holomorphic correction that closes their periods.

In a domain with holes the blends F of f_z and G of conj(f_z̄) are single-valued, but their integral
f is not: around hole j it gains ∮ F dz + conj(∮ G dz). As in `engine.deform.correction`, a
holomorphic, single-valued h changes them to F e^h and G e^{σh}. Of all h that close the periods and
are 0 at the anchor, h has the least mean of |h|² on the boundary. It keeps ν (σ = 1, so Property 5
still holds) or η (σ = −1), and depends analytically on t. It is given as few functions times series
in time.

The smallest change of h is a combination of the functions that represent the constraints: δh ↦
∮ F e^h δh dz is the product with such a function. F e^h and G e^{±h} are smooth around a hole.
These functions are therefore nearly sums of the few that represent ∮ (z − c_j)^k δh dz with small
|k|, for any keyframes. h is a sum of these few functions, and still closes the periods to rounding.

The metric variant prescribes ln |f_z| on the boundary, Equation (13), and attains it up to a
constant around each hole (`engine.dirichlet`). There h is chosen so that its real part is nearest
to the missing constants, without a turn at the anchor. Where this h exceeds the limits of the
keyframes, the smallest correction within the limits is added.

Not in the paper, whose domains are simply connected.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt
import scipy.linalg

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction.barrier import LimitBarrier, extremes
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame, CorrectedFrame
from engine.deform.correction.paths import PointPaths
from engine.deform.correction.solver import PointSolution, PointTargets, solve_correction
from engine.deform.correction.variables import Variables
from engine.interpolation.series.chebyshev import PiecewiseSeries, separate_variables
from engine.interpolation.series.residual import HoleConstants, Residual
from engine.maps import Boundary
from engine.paths import Loops

MOMENTS = 3  # powers of z − c_j on either side, −3 to 2
CLOSED = 1e-14  # the iteration ends after a step in the unknowns of at most this
MOST_STEPS = 15
RIDGE = 1e-12  # of the mean: it makes the size of real parts definite
INDEPENDENT = 1e-13  # of the largest: smaller constraints depend on the others
SHORTEST = 2.0**-5  # pieces of time are not halved below this
TOLERANCE = 1e-11  # of the series in time
LEFT_OUT = 2e-11  # of the modes: accuracy of the closed periods
BEYOND = 1e-6  # of ln σ_a, −ln σ_b and k: the nearest h may exceed limits by this
FAR = 0.3  # the same: a start of the solver may exceed limits by this
# Series of the correction into the limits. It ends some thousandths inside the limits, which makes
# up for the rest.
ROUGH, ROUGHLY_LEFT_OUT, DEGREES = 2e-5, 1e-5, (16, 32)

Unclosed = Callable[[Floats], tuple[Complexes, Complexes]]


class Moduli(NamedTuple):
    """Moduli of a variant at the boundary samples before its periods are closed.

    Attributes
    ----------
    at : callable
        Returns |f_z| and |f_z̄| at times (t,), (t, p) each.
    limits : float64, shape (3,)
        Limits of ln σ_a, −ln σ_b and k.
    constants : HoleConstants
        Constants missing in ln |f_z|, which h approximates.
    """

    at: Callable[[Floats], tuple[Floats, Floats]]
    limits: Floats
    constants: HoleConstants


class Functions(NamedTuple):
    """Functions in the span (n, N), with values and derivatives at the nodes of paths (N, s)."""

    coefficients: Complexes
    values: Complexes
    slopes: npt.NDArray[np.complex64]

    @classmethod
    def of(cls, boundary: Boundary, coefficients: Complexes, nodes: Complexes) -> Self:
        """Evaluate the functions at nodes (s,)."""
        values, slopes = boundary.span.evaluate(coefficients, nodes, orders=(0, 1))
        return cls(coefficients, np.ascontiguousarray(values.T), slopes.T.astype(np.complex64))

    def combined(self, forms: Floats) -> "Functions":
        """Return combinations by forms (N, j)."""
        single = forms.T.astype(np.float32)
        return Functions(
            freeze(self.coefficients @ forms),
            freeze(forms.T @ self.values),
            freeze(single @ self.slopes),
        )

    def joined(self, more: "Functions") -> "Functions":
        return Functions(
            np.hstack([self.coefficients, more.coefficients]),
            np.vstack([self.values, more.values]),
            np.vstack([self.slopes, more.slopes]),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Closing:
    """The correction of the in-betweens of two keyframes: functions times series in time.

    `largest` is the largest |h| on the boundary at 33 times.
    """

    series: PiecewiseSeries
    functions: Functions
    largest: float

    @property
    def residual(self) -> Residual:
        """H at the nodes of the paths."""
        _, values, slopes = self.functions
        return Residual(series=self.series, modes=values, modes_z=slopes)


class PeriodSearch(NamedTuple):
    """Search for h among few functions (c,), in unknowns (i,); the sum of squares is its size."""

    corrector: PointCorrector
    to_few: Floats

    @classmethod
    def among(cls, few: PointCorrector, size: Floats, fixed: Floats) -> Self:
        """Use a form (c, c) as the size, and keep the values of forms (f, c) at 0."""
        free = scipy.linalg.null_space(fixed)
        root = np.linalg.cholesky(free.T @ size @ free)
        to_few = np.asarray(scipy.linalg.solve_triangular(root, free.T, lower=True).T)
        return cls(replace(few, variables=few.variables.of_h(to_few)), freeze(to_few))

    def nearest(self, bases: Sequence[BaseFrame], goals: Floats | None = None) -> Floats:
        """Close the periods of bases (t,) as near to goals (t, i), or to 0, as possible; (c, t)."""
        goals = np.zeros((len(bases), self.corrector.variables.count)) if goals is None else goals
        both = zip(bases, goals, strict=True)
        found = np.transpose([_closed(self.corrector, *each) for each in both])
        return np.asarray(self.to_few @ found)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class HoleCloser:
    """The part of the corrections that all in-betweens of a domain with holes share.

    Build it with `HoleCloser.of`.

    Attributes
    ----------
    corrector : PointCorrector
        Without points: the periods around holes are its only rows. No h turns the anchor.
    few : PointCorrector
        The same, restricted to the few functions that usually suffice for h.
    least, nearest : PeriodSearch
        Searches among these functions; the size is that of h, and that of its real part.
    toward : float64, shape (holes, i)
        The unknowns of `nearest` that come nearest to 1 on the boundary of one hole and to 0 on the
        others.
    functions : Functions
        The few functions.
    nodes : complex128, shape (s,)
        Nodes of the paths.
    """

    corrector: PointCorrector
    few: PointCorrector
    least: PeriodSearch
    nearest: PeriodSearch
    toward: Floats
    functions: Functions
    nodes: Complexes

    @classmethod
    def of(cls, boundary: Boundary, loops: Loops, nodes: Complexes) -> Self:
        """Prepare the boundary of a domain with holes, and paths through nodes (s,).

        The first node is the anchor.
        """
        paths = PointPaths.around(loops)
        known = Variables.of(boundary, loops.nodes, nodes[:1])
        known = known.of_h(scipy.linalg.null_space(known.at_points.h.imag.T))
        corrector = PointCorrector(
            boundary=boundary, points=nodes[:0], paths=paths, variables=known
        )
        values, weights = known.at_samples.h, boundary.weights / boundary.weights.sum()
        size = ((values * weights) @ values.conj().T).real
        of_reals = (values.real * weights) @ values.real.T
        of_reals[np.diag_indices_from(of_reals)] += RIDGE * np.trace(of_reals) / len(of_reals)
        away = loops.nodes - np.repeat(boundary.span.centres, loops.counts)
        powers = [away**power for power in range(-MOMENTS, MOMENTS)]
        moments = [paths.integrals(known.at_nodes.h * each).view(np.float64) for each in powers]
        ends = pairwise([*boundary.starts[1:], len(boundary.points)])
        shares = np.transpose([values.real[:, a:b] @ weights[a:b] for a, b in ends])
        constants = scipy.linalg.solve(of_reals, shares)
        turned = ((values * weights) @ (1j * values.T @ constants).conj()).real
        forms = np.hstack([known.at_points.h.real, *moments, turned])
        columns = np.hstack([scipy.linalg.solve(size, forms), constants])
        to_few, _ = np.linalg.qr(columns / np.linalg.norm(columns, axis=0))
        few = replace(corrector, variables=known.of_h(to_few))
        anchored = few.variables.at_points.h.real.T
        nearest = PeriodSearch.among(few, to_few.T @ of_reals @ to_few, anchored[:0])
        return cls(
            corrector=corrector,
            few=few,
            least=PeriodSearch.among(few, to_few.T @ size @ to_few, anchored),
            nearest=nearest,
            toward=freeze(shares.T @ to_few @ nearest.to_few),
            functions=Functions.of(boundary, few.variables.h, nodes),
            nodes=nodes,
        )

    def close(self, unclosed: Unclosed, sign: int, moduli: Moduli | None = None) -> Closing:
        """Close the periods of in-betweens at all times.

        Parameters
        ----------
        unclosed : callable
            Returns f_z and conj(f_z̄) before the correction, at times (t,) and the nodes of the
            loops, (t, c) each.
        sign : {1, -1}
            1 keeps ν, −1 keeps η.
        moduli : Moduli, optional
            Limits to keep, and constants to make up for.
        """
        if moduli is None:
            return self._in_series(lambda times: self.least.nearest(_bases(unclosed(times), sign)))
        over = -np.inf

        def nearest(times: Floats) -> Floats:
            nonlocal over
            goals = moduli.constants.at(times) @ self.toward
            x = self.nearest.nearest(_bases(unclosed(times), sign), goals)
            for each, base in zip(x.T, _bases(moduli.at(times), sign), strict=True):
                reached = extremes(self.few, base, each)
                over = max(over, float((reached - moduli.limits).max()))
            return x

        # The constants may have kinks in time at these breaks.
        breaks = moduli.constants.series.breaks.tolist()
        closing = self._in_series(nearest, breaks)
        if over <= BEYOND:
            return closing
        forms, series = separate_variables(
            self._into_limits(unclosed, sign, moduli, closing),
            tolerance=ROUGH,
            left_out=ROUGHLY_LEFT_OUT,
            shortest=1.0,
            degrees=DEGREES,
        )
        variables, boundary = self.corrector.variables, self.corrector.boundary
        more = Functions.of(boundary, variables.h @ forms, self.nodes).joined(closing.functions)
        (at_loops,) = boundary.span.evaluate(
            more.coefficients, self.corrector.paths.nodes, orders=(0,)
        )

        def within(times: Floats) -> Floats:
            found = np.vstack([series.at(times), closing.series.at(times)])
            beside = _bases(unclosed(times), sign, found.T @ at_loops.T)
            return np.vstack([self.least.nearest(beside), found])

        return self._in_series(within, breaks, functions=self.functions.joined(more))

    def to_conformal(self, unclosed: Unclosed, sign: int) -> Closing:
        """Return d: the correction that changes f_z alone, less the one by `close`."""

        def further(times: Floats) -> Floats:
            fz, g = unclosed(times)
            alone, both = (_bases((fz, each), sign) for each in (0.0 * g, g))
            return self.least.nearest(alone) - self.least.nearest(both)

        return self._in_series(further, vanishing=False)

    def _into_limits(
        self, unclosed: Unclosed, sign: int, moduli: Moduli, closing: Closing
    ) -> Callable[[Floats], Floats]:
        """Return the unknowns (N, t) of the smallest addition to h that keeps the limits."""
        corrector, span = self.corrector, self.corrector.boundary.span
        nothing, free = corrector.variables.nothing, np.zeros(0)
        targets = PointTargets(np.zeros(0, np.complex128), free, is_anchored=True)
        at_nodes, at_samples = (
            span.evaluate(closing.functions.coefficients, z, orders=(0,))[0]
            for z in (corrector.paths.nodes, corrector.boundary.points)
        )
        # Divided by 4 t (1 − t): beside a key on its limits, h grows linearly in time.
        solved = {0.0: nothing, 1.0: nothing}

        def at(time: float) -> Floats:
            times, scale = np.array([time]), 4.0 * time * (1.0 - time)
            if time in solved:
                return scale * solved[time]
            h = closing.series.at(times).T
            nodes, samples = (
                _bases(parts, sign, h @ modes.T)[0]
                for parts, modes in ((unclosed(times), at_nodes), (moduli.at(times), at_samples))
            )
            walls = partial(LimitBarrier.around, corrector, samples, moduli.limits, scale)
            if walls(nothing).beyond.any():
                near = min(solved, key=lambda other: abs(other - time))
                start = PointSolution(x=scale * solved[near], shift=0j, target_errors=free, steps=0)
                around = walls(start.x)
                if around.beyond.max() > FAR:
                    at((near + time) / 2)
                    return at(time)
                found = solve_correction(corrector, nodes, targets, start, around, throw=False)
                solved[time] = found.x / scale
            else:
                solved[time] = nothing
            return scale * solved[time]

        return lambda times: np.array([at(time) for time in times.tolist()]).T

    def _in_series(
        self,
        unknowns: Callable[[Floats], Floats],
        breaks: Sequence[float] = (0.0, 1.0),
        *,
        functions: Functions | None = None,
        vanishing: bool = True,
    ) -> Closing:
        """Write unknowns (c, t) in few functions."""
        functions = self.functions if functions is None else functions
        forms, series = separate_variables(
            unknowns,
            tolerance=TOLERANCE,
            left_out=LEFT_OUT,
            shortest=SHORTEST,
            breaks=breaks,
            vanishing=vanishing,
        )
        found = functions.combined(forms)
        (modes,) = self.corrector.boundary.span.evaluate(
            found.coefficients, self.corrector.boundary.points, orders=(0,)
        )
        largest = np.abs(modes @ series.at(np.linspace(0.0, 1.0, 33))).max()
        return Closing(series=series, functions=found, largest=float(largest))


def _bases(
    parts: tuple[Complexes | Floats, Complexes | Floats], sign: int, h: Complexes | complex = 0j
) -> list[BaseFrame]:
    """Return frames of f_z and conj(f_z̄), each (t, p), changed by h."""
    grown = np.exp(h)
    fz, g = parts[0] * grown, parts[1] * (grown if sign > 0 else 1.0 / grown)
    return [BaseFrame(*each, 0.0 * each[0], sign) for each in zip(fz, g, strict=True)]


def _closed(corrector: PointCorrector, base: BaseFrame, goal: Floats) -> Floats:
    """Return the unknowns of h that close the periods, nearest to a goal (N,)."""
    x = goal
    for _ in range(MOST_STEPS):
        frame = CorrectedFrame.of(corrector, base, x)
        gap, rows = frame.places(), frame.constraint_rows()
        right = rows @ (x - goal) - np.concatenate([gap.real, gap.imag])
        step = goal - x + np.linalg.lstsq(rows, right, rcond=INDEPENDENT)[0]
        x = x + step
        if np.abs(step).max() < CLOSED:
            break
    return x
