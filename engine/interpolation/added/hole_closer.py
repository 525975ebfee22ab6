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
from dataclasses import dataclass
from functools import cached_property, partial
from itertools import pairwise
from typing import Self

import numpy as np
import scipy.linalg

from engine.arrays import Complexes, Floats, freeze
from engine.deform.correction.barrier import LimitBarrier, log_distortions
from engine.deform.correction.corrector import PointCorrector
from engine.deform.correction.frame import BaseFrame
from engine.deform.correction.paths import PointPaths
from engine.deform.correction.point_targets import PointTargets
from engine.deform.correction.solver import PointSolution, solve_correction
from engine.deform.correction.variables import Variables, orthonormal_functions
from engine.interpolation.added.closing import Closing, Functions, Moduli
from engine.interpolation.added.period_search import FrameParts, PeriodSearch, corrected
from engine.interpolation.series.chebyshev import separate_variables
from engine.maps import Boundary
from engine.paths import Loops

MOMENTS = 3  # powers of z − c_j on either side, −3 to 2
RIDGE = 1e-12  # of the mean: it makes the size of real parts definite
DISTINCT = 1e-7  # of the largest: smaller combinations of the few functions are rounding errors
SHORTEST = 2.0**-5  # pieces of time are not halved below this
TOLERANCE = 1e-11  # of the series in time
LEFT_OUT = 2e-11  # of the modes: accuracy of the closed periods
BEYOND = 1e-6  # of ln σ_a, −ln σ_b and k: the nearest h may exceed limits by this
FAR = 0.3  # the same: a start of the solver may exceed limits by this
# Series of the correction into the limits. It ends some thousandths inside the limits, which makes
# up for the rest.
ROUGH, ROUGHLY_LEFT_OUT, DEGREES = 2e-5, 1e-5, (16, 32)

Unclosed = Callable[[Floats], FrameParts]


@dataclass(frozen=True, kw_only=True, eq=False)
class HoleCloser:
    """The part of the corrections that all in-betweens of a domain with holes share.

    Build it with `HoleCloser.of`. No h turns the anchor.

    Attributes
    ----------
    nodes : complex128, shape (s,)
        Nodes of the paths; the first is the anchor.
    few : complex128, shape (n, c)
        The few functions that usually suffice for h.
    least, nearest : PeriodSearch
        Searches among these functions; the size is that of h, and that of its real part.
    toward : float64, shape (holes, i)
        The unknowns of `nearest` that come nearest to 1 on the boundary of one hole and to 0 on the
        others.
    """

    boundary: Boundary
    loops: Loops
    nodes: Complexes
    few: Complexes
    least: PeriodSearch
    nearest: PeriodSearch
    toward: Floats

    @classmethod
    def of(cls, boundary: Boundary, loops: Loops, nodes: Complexes) -> Self:
        """Prepare the boundary of a domain with holes, and paths through nodes (s,).

        The first node is the anchor.
        """
        span, weights = boundary.span, boundary.weights / boundary.weights.sum()
        # Of functions h whose size is the sum of squares of their real coefficients (N,).
        at_samples, own = orthonormal_functions(boundary)
        count = len(own)
        at_loops, at_anchor = (
            span.coordinates(z)[:, :count] @ own for z in (loops.nodes, nodes[:1])
        )
        upright = scipy.linalg.null_space(_with_real(at_anchor).imag)
        reals = _with_real(at_samples @ own).real @ upright
        rooted = np.sqrt(weights)[:, None] * reals
        of_reals = rooted.T @ rooted
        of_reals[np.diag_indices_from(of_reals)] += RIDGE * np.trace(of_reals) / len(of_reals)
        ends = pairwise([*boundary.starts[1:], len(boundary.points)])
        shares = np.transpose([weights[a:b] @ reals[a:b] for a, b in ends])
        constants = scipy.linalg.solve(of_reals, shares, assume_a="pos")
        away = loops.nodes - np.repeat(span.centres, loops.counts)
        powers = [away**power for power in range(-MOMENTS, MOMENTS)]
        moments = [_with_real(loops.integrals(at_loops.T * each).T) for each in powers]
        # The coefficients of i h are those of h in another order.
        turned = np.roll(upright @ constants, len(own.T), axis=0)
        turned[: len(own.T)] *= -1.0
        forms = [_with_real(at_anchor).real, *(part for m in moments for part in (m.real, m.imag))]
        columns = np.hstack([upright.T @ np.vstack([*forms, turned.T]).T, constants])
        to_few, sizes, _ = np.linalg.svd(
            columns / np.linalg.norm(columns, axis=0), full_matrices=False
        )
        to_few = to_few[:, sizes > DISTINCT * sizes[0]]
        first, second = np.split(upright @ to_few, 2)
        to_own = first + 1j * second
        few, anchored = to_own.T @ at_loops.T, (at_anchor @ to_own).real
        size = np.eye(len(to_few.T)) / boundary.weights.sum()
        nearest = PeriodSearch.among(loops, few, to_few.T @ of_reals @ to_few, anchored[:0])
        return cls(
            boundary=boundary,
            loops=loops,
            nodes=nodes,
            few=freeze(np.pad(own @ to_own, ((0, len(span) - count), (0, 0)))),
            least=PeriodSearch.among(loops, few, size, anchored),
            nearest=nearest,
            toward=freeze(shares.T @ to_few @ nearest.to_few),
        )

    @cached_property
    def functions(self) -> Functions:
        """The few functions, at the nodes of the paths."""
        return Functions.of(self.boundary, self.few, self.nodes)

    @cached_property
    def few_at_samples(self) -> Complexes:
        """The few functions at the samples of the boundary, (c, m)."""
        (values,) = self.boundary.span.evaluate(self.few, self.boundary.points, orders=(0,))
        return freeze(np.ascontiguousarray(values.T))

    @cached_property
    def corrector(self) -> PointCorrector:
        """All functions that do not turn the anchor; the periods around holes are its only rows."""
        anchor = self.nodes[:1]
        known = Variables.of(self.boundary, self.loops.nodes, anchor)
        return PointCorrector(
            boundary=self.boundary,
            points=anchor[:0],
            paths=PointPaths.around(self.loops),
            variables=known.of_h(scipy.linalg.null_space(known.at_points.h.imag.T)),
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
            return self._in_series(lambda times: self.least.closest(unclosed(times), sign))
        over = -np.inf

        def nearest(times: Floats) -> Floats:
            nonlocal over
            goals = moduli.constants.at(times) @ self.toward
            x = self.nearest.closest(unclosed(times), sign, goals)
            real = x.T @ self.few_at_samples.real
            reached = log_distortions(*corrected(moduli.at(times), sign, real))
            over = max(over, float((reached.max(axis=(1, 2)) - moduli.limits).max()))
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
        h, boundary = self.corrector.variables.h @ forms, self.boundary
        more = Functions.of(boundary, h, self.nodes).joined(closing.functions)
        (at_loops,) = boundary.span.evaluate(more.coefficients, self.loops.nodes, orders=(0,))

        def within(times: Floats) -> Floats:
            found = np.vstack([series.at(times), closing.series.at(times)])
            beside = corrected(unclosed(times), sign, found.T @ at_loops.T)
            return np.vstack([self.least.closest(beside, sign), found])

        return self._in_series(within, breaks, functions=self.functions.joined(more))

    def to_conformal(self, unclosed: Unclosed, sign: int) -> Closing:
        """Return d: the correction that changes f_z alone, less the one by `close`."""

        def further(times: Floats) -> Floats:
            fz, g = unclosed(times)
            alone, both = (self.least.closest((fz, each), sign) for each in (0.0 * g, g))
            return alone - both

        return self._in_series(further, vanishing=False)

    def _into_limits(
        self, unclosed: Unclosed, sign: int, moduli: Moduli, closing: Closing
    ) -> Callable[[Floats], Floats]:
        """Return the unknowns (N, t) of the smallest addition to h that keeps the limits."""
        corrector, span = self.corrector, self.boundary.span
        nothing, free = corrector.variables.nothing, np.zeros(0)
        targets = PointTargets(np.zeros(0, np.complex128), free, is_anchored=True)
        at_nodes, at_samples = (
            span.evaluate(closing.functions.coefficients, z, orders=(0,))[0]
            for z in (self.loops.nodes, self.boundary.points)
        )
        # Divided by 4 t (1 − t): beside a key on its limits, h grows linearly in time.
        solved = {0.0: nothing, 1.0: nothing}

        def at(time: float) -> Floats:
            times, scale = np.array([time]), 4.0 * time * (1.0 - time)
            if time in solved:
                return scale * solved[time]
            h = closing.series.at(times).T
            nodes, samples = (
                _base(corrected(parts, sign, h @ modes.T), sign)
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
        (modes,) = self.boundary.span.evaluate(
            found.coefficients, self.boundary.points, orders=(0,)
        )
        largest = np.abs(modes @ series.at(np.linspace(0.0, 1.0, 33))).max()
        return Closing(series=series, functions=found, largest=float(largest))


def _base(parts: FrameParts, sign: int) -> BaseFrame:
    """Return the only frame."""
    (fz,), (g,) = parts
    return BaseFrame(fz, g, 0.0 * fz, sign)


def _with_real(rows: Complexes) -> Complexes:
    """Return complex linear forms (p, n), of the real parts and the imaginary parts, (p, 2n)."""
    return np.hstack([rows, 1j * rows])
