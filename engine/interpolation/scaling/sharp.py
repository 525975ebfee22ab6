"""The largest ρ that brings η back within the keyframes' bounds (Section 7.3, Appendix A).

Around holes the period of f_z and that of ρ f_z̄ close together, so that the correction depends on
ρ. Both are closed for ρ = 1 (F e^h, G e^−h) and for ρ = 0 (F e^(h + d), 0), and what is between is
the mean of both maps with the weights ρ and 1 − ρ: closed for every ρ, and

    F_ρ = F e^h (ρ + (1 − ρ) e^d),    G_ρ = ρ G e^−h.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self, TypeVar

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, freeze
from engine.geometry import box_diagonal, next_on_loop, sample_graded
from engine.interpolation.chebyshev import PiecewiseSeries
from engine.interpolation.passing import Course
from engine.interpolation.periods import Closing
from engine.maps import Bounds, HarmonicMap

# Segments between the samples of the outline, over the distance to the nearest cage vertex and over
# the box diagonal. Interpolation between them is then right to 1e-7.
SEGMENT_PER_DISTANCE = 0.2
SEGMENT_PER_SIZE = 1 / 400
NEGLIGIBLE = 1e-9  # f_z̄ / f_z below which no scaling is needed, whatever the bounds
# To which the worst bounds are known, or a scaling by them could have no room.
EXACT = NEGLIGIBLE / 10
CEILING = 2.0  # ratios are cut off there: only those below 1 matter
PARTS = (
    8  # into which a stretch around a minimum is cut; each round makes it PARTS / 2 times shorter
)
ROUNDS = 8
TOO_HIGH = 2e-7  # by which a minimum that is found may be too high; taken off
FAINT = 1e-8  # modes of h and d below this are left out
GAIN = 1e-7  # by which a stretch must promise to lower ρ to be looked at
MANY = 4096  # stretches that are refined at a time
RUN = 16  # times at whose ends all samples are looked at
BESIDE = 2  # samples on either side of a low one
MARGIN = 0.05  # by which a sample may be lower in between than both ends of a run tell
# Part of the interval beside each key in which the bounds tighten, from the worst of the outline to
# each point's own.
BESIDE_KEY = 0.24

type_ = TypeVar("type_", Floats, Complexes)
Rows = TypeVar("Rows", Floats, Booleans)


@dataclass(frozen=True, slots=True, kw_only=True)
class Worst:
    """The largest k and sigma_a and the smallest sigma_b of the keyframes on the whole outline."""

    k: float
    sigma_a: float
    sigma_b: float

    def widened(self, bounds: Bounds) -> "Worst":
        """Return the looser of some bounds and these, with room for what `TOO_HIGH` takes off."""
        room = 5 * TOO_HIGH
        return Worst(
            k=max(self.k * (1 + room), bounds.k),
            sigma_a=max(self.sigma_a * (1 + room), bounds.sigma_a),
            sigma_b=min(self.sigma_b * (1 - room), bounds.sigma_b),
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class PointSamples:
    """What ρ depends on at some points, for q keyframes; `...` is any shape.

    Parameters
    ----------
    log_modulus : float64, shape (q + j, ...)
        ln |f_z|, and the real parts of the modes of h.
    conj_eta : complex128, shape (q, ...)
    k, sigma_a, sigma_b : float64, shape (...)
        The larger k and sigma_a and the smaller sigma_b of the keyframes: Properties 5 to 7.
    opening : complex128, shape (i, ...)
        The modes of d; none without holes.
    widest : Worst or None
        Around holes h takes more of a point's own bounds than is left; they are wider by as much
        as h and d change the map, but not wider than this. None leaves them as they are.
    """

    log_modulus: Floats
    conj_eta: Complexes
    k: Floats
    sigma_a: Floats
    sigma_b: Floats
    opening: Complexes
    widest: Worst | None = None

    @classmethod
    def of(cls, fz: Complexes, g: Complexes, h: Complexes, d: Complexes) -> Self:
        """Build the samples from f_z and conj(f_z̄), each (q, ...), and modes (j, ...), (i, ...)."""
        a, b = np.abs(fz), np.abs(g)
        return cls(
            log_modulus=freeze(np.concatenate([np.log(a), h.real])),
            conj_eta=freeze(fz * g),
            k=freeze((b / a).max(axis=0)),
            sigma_a=freeze((a + b).max(axis=0)),
            sigma_b=freeze((a - b).min(axis=0)),
            opening=freeze(np.array(d)),
        )

    def at(self, chosen: Indices) -> Self:
        """Return some of the points (p,)."""
        return type(self)(
            log_modulus=self.log_modulus.take(chosen, axis=1),
            conj_eta=self.conj_eta.take(chosen, axis=1),
            k=self.k[chosen],
            sigma_a=self.sigma_a[chosen],
            sigma_b=self.sigma_b[chosen],
            opening=self.opening.take(chosen, axis=1),
        )

    def bounded(self, worst: Worst | None) -> Self:
        """Return the same points with the worst bounds of the outline, or with their own."""
        if worst is None:
            return self
        k, sigma_a, sigma_b = (np.array([x]) for x in (worst.k, worst.sigma_a, worst.sigma_b))
        return replace(self, k=k, sigma_a=sigma_a, sigma_b=sigma_b)

    def ratios(self, weights: Floats) -> Floats:
        """Return the largest scaling that each point allows at a time, Equations (16) to (18).

        Departs from the paper: in these equations and in the denominators of Section 7.3 the bars
        were lost; the factor of ρ is |f_z̄|.

        Parameters
        ----------
        weights : float64, shape (q + j + i, ...)
            Of the keyframes and of the modes, each to be broadcast with the points' shape.

        Returns
        -------
        float64
            Of the common shape, at most `CEILING`.
        """
        count = len(self.log_modulus)
        a = np.exp(_total(weights[:count], self.log_modulus))
        b = np.abs(_total(weights[: len(self.conj_eta)], self.conj_eta)) / a
        k, sigma_a, sigma_b = self.k, self.sigma_a, self.sigma_b
        d = _total(weights[count:], self.opening) if len(self.opening) else None
        if d is not None and self.widest is not None:
            keys = len(self.conj_eta)
            h = _total(weights[keys:count], self.log_modulus[keys:])
            change = np.exp(np.abs(h) + np.abs(d.real))
            k = np.minimum(self.widest.k, k * change * change)
            sigma_a = np.minimum(self.widest.sigma_a, sigma_a * change)
            sigma_b = np.maximum(self.widest.sigma_b, sigma_b / change)
        return allowed(a, b, d, (k, sigma_a, sigma_b))


def allowed(
    a: Floats, b: Floats, d: Complexes | None, limits: tuple[Floats | float, ...]
) -> Floats:
    """Return the largest ρ within limits of k, σ_a and σ_b for |F_1| = a, |G_1| = b, F_0 = F_1 e^d.

    Without d it scales G alone.
    """
    k, sigma_a, sigma_b = limits
    # ρ_k, ρ_a and ρ_b of Section 7.3 have the denominator |f_z̄| in common.
    room = np.minimum(k * a, np.minimum(sigma_a - a, a - sigma_b))
    ratios = np.full(room.shape, CEILING)
    np.divide(room, b, out=ratios, where=b > np.maximum(NEGLIGIBLE * a, room / CEILING))
    if d is not None:
        bounds = np.array([np.broadcast_to(each, a.shape) for each in limits])
        tight = _tight(ratios, a, d, bounds)
        ratios[tight] = _opened(a[tight], b[tight], d[tight], bounds[:, tight])
    return ratios


def _tight(ratios: Floats, a: Floats, d: Complexes, bounds: Floats) -> Booleans:
    """Tell where another |F_0| than |F_1| = a may change ratios, like all of the shape of `a`.

    With ε ≥ |e^d − 1|, |F_ρ| differs from |F_1| by at most ε |F_1|. Where the bounds have that room
    no ρ leaves them, and the ratio stays what it is, above 1.
    """
    most = np.expm1(np.abs(d).max(initial=0.0))
    _, sigma_a, sigma_b = bounds
    tight: Booleans = ratios * (1 - most) < 1.0
    tight |= (a * (1 + most) > sigma_a) | (a * (1 - most) < sigma_b)
    return tight


def _opened(a: Floats, b: Floats, d: Complexes, bounds: Floats) -> Floats:
    """Return the largest ρ at points (n,) with |F_1| = a, |G_1| = b and F_0 = F_1 e^d.

    The bounds (3, n) are those of k, sigma_a and sigma_b. |F_ρ|² is a quadratic in ρ, and so is
    each of them. Where the map for ρ = 0 is beyond a bound there is no telling: the bound is left
    to the others.
    """
    # a² |e^d|², and the products of a e^d and a − a e^d.
    k, sigma_a, sigma_b = bounds
    squared, grown = a * a, np.exp(d.real)
    f0 = squared * grown * grown
    f1 = squared * grown * np.cos(d.imag) - f0
    f2 = squared - f0 - 2.0 * f1
    quadratics = (
        (-k * k * f0, -k * k * f1, b * b - k * k * f2),
        (f0 - sigma_a**2, f1 + sigma_a * b, f2 - b * b),
        (sigma_b**2 - f0, sigma_b * b - f1, b * b - f2),
    )
    inverse = np.full(a.shape, 1.0 / CEILING)
    with np.errstate(invalid="ignore"):
        for c0, c1, c2 in quadratics:
            # The first ρ at which c0 + 2 c1 ρ + c2 ρ² > 0; where there is none the root is no
            # number, which `fmax` passes over.
            root = c1 + np.sqrt(c1 * c1 - c2 * c0)
            root = np.divide(root, -c0, out=np.zeros_like(root), where=c0 < 0)
            np.fmax(inverse, root, out=inverse)
    return 1.0 / inverse


def _total(weights: Floats, values: type_) -> type_:
    """Return the weighted sum of values (n, c) at times (n, s, 1), or (n, c, p) at (n, c, 1)."""
    if values.ndim == 2:
        flat: Floats = weights[..., 0].T @ values.view(np.float64)
        return flat.view(values.dtype)
    total: type_ = sum(w * value for w, value in zip(weights, values, strict=True))
    return total


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SharpScaling:
    """The largest ρ at each time: the minimum of the pointwise ratios over the outline.

    Being a minimum, it has a kink in time wherever another point or another bound takes over;
    in-betweens use `engine.interpolation.scaling.Scaling`.

    Departs from the paper: next to a keyframe a point's own bounds leave no room where f_z̄ nearly
    vanishes. ρ would fall within a moment, and the shape jump. Beside a key (`BESIDE_KEY`) this ρ
    therefore comes by and by from the one for which the bounds are the worst of the outline. On the
    outline Properties 5 to 7 hold point by point away from the keys; Properties 5' to 7' always do.
    Along a course that is not straight the given bounds take their place everywhere.

    Parameters
    ----------
    course : Course
    curves : OutlineCurves
        f_z and conj(f_z̄) of the keyframes.
    samples : PointSamples
        At the outline's samples (p,), in order along it, its vertices among them.
    worst : Worst
        Of the keyframes; with the given bounds, where the course is not straight.
    closings : tuple of PiecewiseSeries
        Around holes those of h and of d.
    """

    course: Course
    curves: "OutlineCurves"
    samples: PointSamples
    worst: Worst
    closings: tuple[PiecewiseSeries, ...] = ()

    @classmethod
    def of(
        cls,
        maps: Sequence[HarmonicMap],
        outline: Complexes,
        course: Course,
        bounds: Bounds,
        closings: tuple[Closing, ...] = (),
    ) -> Self:
        """Sample the keyframes of a course along the outline (p,), and along their holes."""
        span = maps[0].span
        longest = SEGMENT_PER_SIZE * box_diagonal(outline)
        sampled = [
            sample_graded(loop, span.vertices, ratio=SEGMENT_PER_DISTANCE, longest=longest)
            for loop in (outline, *(hole.outline for hole in span.holes))
        ]
        points = np.concatenate(sampled)
        starts = np.cumsum([0, *map(len, sampled[:-1])])
        columns = np.array([f.columns for f in maps]).swapaxes(0, 1)  # Φ of all, and then Ψ of all
        columns = columns.reshape(-1, len(span)).T
        leading = [each.leading(FAINT) for each in closings]
        modes = [functions for functions, _ in leading]
        derivatives = span.evaluate(np.hstack([columns, *modes]), points, orders=(0, 1, 2))
        values, first, second = (each.T for each in derivatives)
        keys = columns.shape[1]
        curves = OutlineCurves.through(
            points,
            np.vstack([first[:keys], values[keys:]]),
            np.vstack([second[:keys], first[keys:]]),
            starts=starts,
            counts=(len(maps), modes[0].shape[1] if modes else 0),
        )
        samples = curves.samples_of(curves.coefficients[0])
        worst = _worst(curves)
        if not course.is_straight:
            worst = worst.widened(bounds)
        return cls(
            course=course,
            curves=curves,
            samples=samples,
            worst=worst,
            closings=tuple(series for _, series in leading),
        )

    def __call__(self, times: Floats) -> Floats:
        """Return ρ in (0, 1] at times (s,) in (0, 1), in ascending order.

        Times are taken in runs: of the samples, only those that are low at the ends of a run, or
        on the way to become so, are looked at in between.
        """
        if not self.course.is_straight:
            return self._minima(times, is_own=False)
        rho, share = np.ones(len(times)), looseness(times)
        tight, loose = share < 1, share > 0
        rho[tight] = self._minima(times[tight], is_own=True) ** (1.0 - share[tight])
        rho[loose] *= self._minima(times[loose], is_own=False) ** share[loose]
        return rho

    def _minima(self, times: Floats, *, is_own: bool) -> Floats:
        """Return the minima of the ratios within the given bounds."""
        if not len(times):
            return np.ones(0)
        samples = self._bounded(self.samples, is_own=is_own)
        starts = np.arange(0, len(times), RUN)
        at_ends = samples.ratios(self._weights(times[np.append(starts, len(times) - 1)]))
        lowest = np.full(len(times), CEILING)
        found = []
        for start, low in zip(starts, _low_samples(at_ends), strict=True):
            chosen = np.flatnonzero(low)
            if len(chosen):
                block = slice(start, start + RUN)
                weights = self._weights(times[block])
                within = self._bounded(self.samples.at(chosen), is_own=is_own)
                ratios = within.ratios(weights)
                lowest[block] = ratios.min(axis=1)
                when, which = np.nonzero(self._promising(chosen, ratios))
                found.append((start + when, chosen[which]))
        if found:
            when, segment = (np.concatenate(each) for each in zip(*found, strict=True))
            for part in np.array_split(np.arange(len(when)), 1 + len(when) // MANY):
                self._refine(times, lowest, when[part], segment[part], is_own=is_own)
        return np.minimum((1.0 - TOO_HIGH) * lowest, 1.0)

    def _bounded(self, samples: PointSamples, *, is_own: bool) -> PointSamples:
        """Return samples with their own bounds, wider around holes, or with the worst ones."""
        return replace(samples, widest=self.worst) if is_own else samples.bounded(self.worst)

    def _weights(self, times: Floats) -> Floats:
        """Return the weights of keyframes and modes at times (s,), for any points: (…, s, 1)."""
        keys = self.course.at(times[:, None])
        series = [each.at(times)[..., None] for each in self.closings]
        return np.concatenate([keys, *series])

    def _promising(self, chosen: Indices, ratios: Floats) -> Booleans:
        """Tell from which of some samples (c,) segments start that may hold a minimum, (s, c)."""
        around = _wrapped(ratios, 1, 2)
        drops = np.abs(np.diff(around, axis=1))
        drop = np.maximum(drops[:, 1:-1], np.maximum(drops[:, :-2], drops[:, 2:]))
        goal = np.minimum(ratios.min(axis=1), 1.0) - GAIN
        low: Booleans = np.minimum(ratios, around[:, 2:-1]) - drop < goal[:, None]
        low &= np.roll(chosen, -1) == self.curves.following[chosen]
        return low

    def _refine(
        self, times: Floats, lowest: Floats, when: Indices, segment: Indices, *, is_own: bool
    ) -> None:
        """Lower the minima by what is found on segments (c,) at times `when` (c,).

        The ratios have kinks where the worse keyframe changes, so that the stretches around low
        places are only cut finer, round after round: no parabola is fitted.
        """
        place, width = np.full(len(when), 0.5), 0.5
        weights, keys = self._weights(times), self.course.count
        summed = np.concatenate([weights[:keys], np.ones((len(self.closings), len(times), 1))])
        for _ in range(ROUNDS):
            if not len(when):
                break
            places = _around(place, width)
            samples = self.curves.at(segment, places, weights[keys:, when, 0])
            found = self._bounded(samples, is_own=is_own).ratios(summed[:, when])
            best, rows = found.argmin(axis=1), np.arange(len(when))
            variation = np.abs(np.diff(found, axis=1)).max(axis=1, initial=0.0)
            np.minimum.at(lowest, when, found[rows, best])
            kept = found[rows, best] - variation < np.minimum(lowest[when], 1.0) - GAIN
            when, segment, place = when[kept], segment[kept], places[rows, best][kept]
            width *= 2.0 / PARTS


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineCurves:
    """Holomorphic functions between the samples of an outline, by Hermite interpolation.

    Each segment has its own polynomial of degree 7 in w = (z − start) / span, in Newton's form: the
    functions and their derivatives agree at four samples around it.

    Parameters
    ----------
    places : complex128, shape (8, p)
        w of the four samples of each segment, each twice.
    coefficients : complex128, shape (8, 2 q + j + i, p)
        f_z of the keyframes, conj(f_z̄) of them, and the modes of h and d.
    counts : (int, int)
        q and j.
    following : intp, shape (p,)
        The sample at which each segment ends.
    """

    places: Complexes
    coefficients: Complexes
    counts: tuple[int, int]
    following: Indices

    @classmethod
    def through(
        cls,
        points: Complexes,
        values: Complexes,
        derivatives: Complexes,
        *,
        starts: Indices,
        counts: tuple[int, int],
    ) -> Self:
        """Interpolate functions (2 q + j + i, p) with their derivatives at points (p,).

        `starts` are the first points of the loops.
        """
        here, after = np.arange(len(points)), next_on_loop(starts, len(points))
        stencil = [here, after, np.argsort(after), after[after]]
        span = points[stencil[1]] - points
        places = np.repeat([(points[at] - points) / span for at in stencil], 2, axis=0)
        column = np.repeat([values[:, at] for at in stencil], 2, axis=0)
        coefficients = [column[0]]
        for order in range(1, len(places)):
            rise = column[1:] - column[:-1]
            gap = (places[order:] - places[:-order])[:, None]
            if order == 1:
                # Between a sample and itself the divided difference is the derivative.
                gap[::2] = 1.0
                rise[::2] = [derivatives[:, at] * span for at in stencil]
            column = rise / gap
            coefficients.append(column[0])
        return cls(
            places=freeze(places),
            coefficients=freeze(np.array(coefficients)),
            counts=counts,
            following=freeze(after),
        )

    def samples_of(self, values: Complexes) -> PointSamples:
        """Return the samples with these values (2 q + j + i, ...) of the functions."""
        count, modes = self.counts
        fz, g, h, d = np.split(values, [count, 2 * count, 2 * count + modes])
        return PointSamples.of(fz, g, h, d)

    def at(self, segment: Indices, places: Floats, weights: Floats | None = None) -> PointSamples:
        """Return the samples at places (c, s), each from 0 to 1, along segments (c,).

        In place of the modes they have their sums with weights (j + i, c), or none at all.
        """
        nodes, coefficients = self.places[:, segment], self.coefficients[:, :, segment]
        count, modes = self.counts
        functions, terms = np.split(coefficients, [2 * count], axis=1)
        if weights is not None and len(weights):
            sums = [
                np.einsum("jc,kjc->kc", weights[own], terms[:, own])[:, None]
                for own in (slice(modes), slice(modes, None))
            ]
            functions = np.concatenate([functions, *sums], axis=1)
        values = np.repeat(functions[-1][:, :, None], places.shape[1], axis=2)
        for node, coefficient in zip(nodes[-2::-1], functions[-2::-1], strict=True):
            values *= places - node[:, None]
            values += coefficient[:, :, None]
        return PointSamples.of(*np.split(values, [count, 2 * count, 2 * count + 1]))


def looseness(times: Floats) -> Floats:
    """Return how far the bounds are those of the whole outline: a C^∞ step, 1 at both keys."""
    beside = np.minimum(times, 1 - times) / BESIDE_KEY
    inside = np.clip(beside, 1e-3, 1 - 1e-3)
    steps = 0.5 + 0.5 * np.tanh(0.5 / inside - 0.5 / (1.0 - inside))
    return np.where(beside >= 1.0, 0.0, steps)


def _low_samples(at_ends: Floats) -> Booleans:
    """Tell which samples may be lowest at some time of a run, or are beside one, (runs, p).

    Parameters
    ----------
    at_ends : float64, shape (runs + 1, p)
        The ratios at the times between runs, and at the first and the last one.
    """
    change = np.abs(np.diff(at_ends, axis=0))
    lowest = at_ends.min(axis=1)
    goal = np.minimum(1.0, np.maximum(lowest[:-1], lowest[1:]))
    low: Booleans = (1.0 - MARGIN) * np.minimum(at_ends[:-1], at_ends[1:]) - change <= goal[:, None]
    around = _wrapped(low, BESIDE, BESIDE)
    for place in range(2 * BESIDE + 1):
        low |= around[:, place : place + low.shape[1]]
    return low


def _wrapped(rows: Rows, before: int, after: int) -> Rows:
    """Return rows (n, p) of loops with some of their last and first entries on either side."""
    return np.hstack([rows[:, rows.shape[1] - before :], rows, rows[:, :after]])


def _worst(curves: OutlineCurves) -> Worst:
    """Return the extremes of the keyframes along the outline, between the samples too."""
    segments = np.arange(len(curves.following))
    grid = _around(np.full(len(segments), 0.5), 0.5)
    found = curves.at(segments, grid)
    k, sigma_a = (-_least(curves, grid, -getattr(found, of), of, -1) for of in ("k", "sigma_a"))
    return Worst(k=k, sigma_a=sigma_a, sigma_b=_least(curves, grid, found.sigma_b, "sigma_b", 1))


def _least(curves: OutlineCurves, places: Floats, values: Floats, of: str, sign: int) -> float:
    """Return the least value of a distortion, times a sign, that has these at places (c, s).

    All stretches that may hold it are cut finer: next to a sample there is one on either side.
    """
    segments, width, least = np.arange(len(values)), 0.5, float(values.min())
    for _ in range(ROUNDS):
        variation = np.abs(np.diff(values, axis=1)).max(axis=1)
        kept = np.flatnonzero(values.min(axis=1) - variation < least - EXACT)
        if not len(kept):
            break
        width *= 2.0 / PARTS
        middle = places[kept, values[kept].argmin(axis=1)]
        segments, places = segments[kept], _around(middle, width)
        values = sign * getattr(curves.at(segments, places), of)
        least = min(least, float(values.min()))
    return least


def _around(place: Floats, width: float) -> Floats:
    """Return places (c, PARTS + 1) around some (c,) within their segments."""
    return np.clip(place[:, None] + width * np.linspace(-1.0, 1.0, PARTS + 1), 0.0, 1.0)
