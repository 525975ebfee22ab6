"""The largest ρ that brings η back within the keyframes' bounds (Section 7.3, Appendix A)."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self, TypeVar

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.geometry import diameter, sample_graded
from engine.interpolation.added.closing import Closing
from engine.interpolation.scaling.outline_curves import (
    PARTS,
    ROUNDS,
    OutlineCurves,
    keyframe_extremes,
    places_around,
)
from engine.interpolation.scaling.pointwise import CEILING, TOO_HIGH, KeyframeExtremes, PointSamples
from engine.interpolation.series.chebyshev import PiecewiseSeries
from engine.interpolation.time_weights.weights import TimeWeights
from engine.maps import Bounds, HarmonicMap

# Length of the segments between samples of the outline, relative to the distance to the nearest
# vertex of the cage and to the diameter. Interpolation between samples is then accurate to 1e-7.
SEGMENT_PER_DISTANCE = 0.2
SEGMENT_PER_SIZE = 1 / 400
GAIN = 1e-7  # a segment is refined if it may lower ρ by more
MANY = 4096  # segments that are refined at a time
RUN = 16  # number of times in a run; all samples are evaluated at its ends only
BESIDE = 2  # samples on either side of a low one
MARGIN = 0.05  # a sample may be lower within a run than at both ends, by this ratio
# Share of the segment beside each key in which the bounds tighten, from the worst of the outline to
# each point's own.
BESIDE_KEY = 0.24

Rows = TypeVar("Rows", Floats, Booleans)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ExactRho:
    """The largest ρ at each time: the minimum of the pointwise ratios over the outline.

    This minimum has a kink in time wherever another point or another bound becomes the lowest.
    In-betweens therefore use `engine.interpolation.scaling.smoothed_rho.SmoothedRho`.

    Departs from the paper: next to a keyframe a point's own bounds leave no room where f_z̄ nearly
    vanishes. ρ would fall within a moment, and the shape would jump. Beside each key (`BESIDE_KEY`)
    ρ is therefore blended, by a C^∞ step, from the ρ for the outline-wide worst bounds. On the
    outline Properties 5 to 7 hold point by point away from the keys; Properties 5' to 7' always do.
    With curved time weights the given bounds replace the keyframes' own everywhere.

    Attributes
    ----------
    curves : OutlineCurves
        f_z and conj(f_z̄) of the keyframes.
    samples : PointSamples
        At the outline's samples (p,), in order along it, its vertices among them.
    extremes : KeyframeExtremes
        Worst extremes of the keyframes, joined with the given bounds for curved time weights.
    closings : tuple of PiecewiseSeries
        Series of h and d around holes.
    """

    time_weights: TimeWeights
    curves: OutlineCurves
    samples: PointSamples
    extremes: KeyframeExtremes
    closings: tuple[PiecewiseSeries, ...] = ()

    @classmethod
    def of(
        cls,
        maps: Sequence[HarmonicMap],
        outline: Complexes,
        time_weights: TimeWeights,
        bounds: Bounds,
        closings: tuple[Closing, ...] = (),
    ) -> Self:
        """Sample the weighted keyframes along the outline (p,) and along the holes."""
        span = maps[0].span
        longest = SEGMENT_PER_SIZE * diameter(outline)
        sampled = [
            sample_graded(loop, span.vertices, ratio=SEGMENT_PER_DISTANCE, longest=longest)
            for loop in (outline, *(hole.outline for hole in span.holes))
        ]
        points = np.concatenate(sampled)
        starts = np.cumsum([0, *map(len, sampled[:-1])])
        columns = np.array([f.columns for f in maps]).swapaxes(0, 1)  # Φ of all, and then Ψ of all
        columns = columns.reshape(-1, len(span)).T
        modes = [each.functions.coefficients for each in closings]
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
        worst = keyframe_extremes(curves)
        if not time_weights.is_straight:
            worst = worst.widened(bounds)
        return cls(
            time_weights=time_weights,
            curves=curves,
            samples=samples,
            extremes=worst,
            closings=tuple(each.series for each in closings),
        )

    def __call__(self, times: Floats) -> Floats:
        """Return ρ in (0, 1] at times (s,) in (0, 1), in ascending order.

        Times are taken in runs. Within a run only those samples are evaluated that are low, or
        falling towards low values, at the ends of the run.
        """
        if not self.time_weights.is_straight:
            return self._minima(times, is_own=False)
        rho, share = np.ones(len(times)), blend_in_outline_bounds(times)
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
        at_ends = samples.largest_rhos(self._weights(times[np.append(starts, len(times) - 1)]))
        lowest = np.full(len(times), CEILING)
        found = []
        for start, low in zip(starts, _low_samples(at_ends), strict=True):
            chosen = np.flatnonzero(low)
            if len(chosen):
                block = slice(start, start + RUN)
                weights = self._weights(times[block])
                within = self._bounded(self.samples.at(chosen), is_own=is_own)
                ratios = within.largest_rhos(weights)
                lowest[block] = ratios.min(axis=1)
                when, which = np.nonzero(self._promising(chosen, ratios))
                found.append((start + when, chosen[which]))
        if found:
            when, segment = (np.concatenate(each) for each in zip(*found, strict=True))
            for part in np.array_split(np.arange(len(when)), 1 + len(when) // MANY):
                self._refine(times, lowest, when[part], segment[part], is_own=is_own)
        return np.minimum((1.0 - TOO_HIGH) * lowest, 1.0)

    def _bounded(self, samples: PointSamples, *, is_own: bool) -> PointSamples:
        """Return samples with their own bounds, wider around holes, or with the worst bounds."""
        return (
            replace(samples, largest_extremes=self.extremes)
            if is_own
            else samples.with_bounds(self.extremes)
        )

    def _weights(self, times: Floats) -> Floats:
        """Return the weights of keyframes and modes at times (s,), for any points: (…, s, 1)."""
        keys = self.time_weights.at(times[:, None])
        series = [each.at(times)[..., None] for each in self.closings]
        return np.concatenate([keys, *series])

    def _promising(self, chosen: Indices, ratios: Floats) -> Booleans:
        """Mark the samples (c,) that start a segment with a possible minimum, (s, c)."""
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
        """Lower the minima by the values on segments (c,) at times `when` (c,).

        The ratios have kinks where the worse keyframe changes. The segments are therefore halved
        repeatedly around low places, and no parabola is fitted.
        """
        place, width = np.full(len(when), 0.5), 0.5
        weights, keys = self._weights(times), self.time_weights.count
        summed = np.concatenate([weights[:keys], np.ones((len(self.closings), len(times), 1))])
        for _ in range(ROUNDS):
            if not len(when):
                break
            places = places_around(place, width)
            samples = self.curves.at(segment, places, weights[keys:, when, 0])
            found = self._bounded(samples, is_own=is_own).largest_rhos(summed[:, when])
            best, rows = found.argmin(axis=1), np.arange(len(when))
            variation = np.abs(np.diff(found, axis=1)).max(axis=1, initial=0.0)
            np.minimum.at(lowest, when, found[rows, best])
            kept = found[rows, best] - variation < np.minimum(lowest[when], 1.0) - GAIN
            when, segment, place = when[kept], segment[kept], places[rows, best][kept]
            width *= 2.0 / PARTS


def blend_in_outline_bounds(times: Floats) -> Floats:
    """Return the blend weight of the outline-wide bounds: 1 at both keys, 0 inside, C^∞."""
    beside = np.minimum(times, 1 - times) / BESIDE_KEY
    inside = np.clip(beside, 1e-3, 1 - 1e-3)
    steps = 0.5 + 0.5 * np.tanh(0.5 / inside - 0.5 / (1.0 - inside))
    return np.where(beside >= 1.0, 0.0, steps)


def _low_samples(at_ends: Floats) -> Booleans:
    """Mark the samples that may be lowest within a run, and their neighbours, (runs, p).

    `at_ends` (runs + 1, p) are the ratios at the ends of all runs.
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
    """Return rows (n, p) of loops, extended by some of their last and first entries."""
    return np.hstack([rows[:, rows.shape[1] - before :], rows, rows[:, :after]])
