"""A whole motion as one base shape and a few weighted shapes added to it, weights in [0, 1].

Game engines call them morph targets or blend shapes; the weights are piecewise linear functions of
time.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from engine.arrays import Complexes, Floats, as_number, as_reals, freeze
from engine.errors import EngineError

# Shares of the tolerance: for the basis, for the linear weights between times, and for the targets
# left out. Times cost little, targets much.
OF_BASIS, OF_TIME, OF_RANK = 0.02, 0.1, 0.85
NO_TIMES = "times must be finite numbers, at least one, not {times}."
TIMES_FALL = "times must increase from one to the next."
BLOCK = 256  # moments that are evaluated at once
SHORTEST = 2.0**-6  # duration of a jump of the motion, in which no tolerance is kept


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MorphTargets:
    """Positions of m points: base + Σ_j w_j(t) targets_j.

    Attributes
    ----------
    base : complex128, shape (m,)
    targets : complex128, shape (r, m)
    times : float64, shape (n,)
        Increasing.
    weights : float64, shape (n, r)
        At the times, in [0, 1]; linear in between.
    error : float
        Largest distance from the motion of any point, at the times and halfway between two.
    """

    base: Complexes
    targets: Complexes
    times: Floats
    weights: Floats
    error: float

    def positions(self, time: float) -> Complexes:
        """Return the points (m,) at a time; constant before the first and after the last time."""
        weights = np.array([np.interp(time, self.times, column) for column in self.weights.T])
        return np.asarray(self.base + weights @ self.targets)


def build_morph_targets(
    sample: Callable[[float], Complexes],
    base: Complexes,
    times: Sequence[float],
    *,
    tolerance: float,
    most: int | None = None,
) -> Generator[float, None, MorphTargets]:
    """Find the fewest targets that keep a motion within a tolerance; yield the time at each step.

    Parameters
    ----------
    sample : callable
        Returns the points (m,) at a time from the first to the last of `times`.
    base : complex128, shape (m,)
        The shape to which all targets are added.
    times : sequence of float
        Increasing; at least one. The first samples. They must be close enough that every change
        between two times shows halfway between them.
    tolerance : float
        Largest allowed distance of a point from the motion, at any time except during a jump.
    most : int, optional
        Largest number of targets. If they do not suffice, `error` is above the tolerance.

    Notes
    -----
    Times are halved until linear weights between them are accurate enough. The motion at all times
    is a matrix of points by times, with a low rank up to the tolerance. Its principal components
    about the mean are the targets. One more target, whose weight is always 1, keeps the others'
    weights nonnegative, since engines clip negative weights. It is left out if the motion allows
    that, for example if the motion starts at the base.
    """
    moments = as_reals(times, "times")
    if moments.ndim != 1 or not len(moments) or not np.isfinite(moments).all():
        raise EngineError(NO_TIMES, times=moments)
    if (np.diff(moments) <= 0).any():
        raise EngineError(TIMES_FALL)
    as_number(tolerance, "The tolerance of targets", above=0)
    snapshots = _Snapshots(base, OF_BASIS * tolerance)
    snapshots.append(times[0], snapshots.take(sample(times[0])))
    yield times[0]
    for start, end in pairwise(times):
        yield from snapshots.add_between(sample, start, end, OF_TIME * tolerance)
    found = snapshots.targets(0)
    for rank in range(1, snapshots.rank + 1):
        if found.error <= (OF_RANK + OF_TIME) * tolerance:
            break
        more = snapshots.targets(rank)
        if most is not None and len(more.targets) > most:
            break
        found = more
    return found


class _Snapshots:
    """A motion at some times, as coordinates in a basis that grows with the samples."""

    def __init__(self, base: Complexes, slack: float) -> None:
        self._base = base
        self._slack = slack  # largest distance that the basis may leave out
        self._rows = np.empty((0, 2 * len(base)))  # orthonormal
        self._times: list[float] = []
        self._moments: list[Floats] = []
        self._middles: list[Floats | None] = []  # halfway to the next time; None in a jump

    @property
    def rank(self) -> int:
        return len(self._rows)

    def take(self, points: Complexes) -> Floats:
        """Return the coordinates (q,) of the points, and extend the basis if necessary."""
        rest = (points - self._base).view(np.float64)
        coordinates = self._rows @ rest
        rest = rest - coordinates @ self._rows
        # A second projection, against rounding.
        again = self._rows @ rest
        rest -= again @ self._rows
        coordinates += again
        if float(np.abs(rest.view(np.complex128)).max(initial=0.0)) > self._slack:
            length = float(np.linalg.norm(rest))
            self._rows = np.vstack([self._rows, rest / length])
            coordinates = np.append(coordinates, length)
        return coordinates

    def append(self, time: float, coordinates: Floats) -> None:
        self._times.append(time)
        self._moments.append(coordinates)

    def add_between(
        self, sample: Callable[[float], Complexes], start: float, end: float, tolerance: float
    ) -> Generator[float, None, None]:
        """Add the times after `start` up to `end`, as close together as necessary."""
        pending = [(start, end, self.take(sample(end)))]
        yield end
        while pending:
            start, end, last = pending.pop()
            middle = (start + end) / 2
            between = self.take(sample(middle))
            yield middle
            bend = _table([between, -0.5 * self._moments[-1], -0.5 * last], self.rank).sum(axis=0)
            is_straight = self.largest(bend[None]) <= tolerance
            if is_straight or end - start <= SHORTEST:
                # The position in the middle of a jump has no duration.
                self._middles.append(between if is_straight else None)
                self.append(end, last)
            else:
                pending += [(middle, end, last), (start, middle, between)]

    def largest(self, coordinates: Floats) -> float:
        """Return the largest distance from the origin of any point at n times, (n, q)."""
        worst = 0.0
        rows = self._rows[: coordinates.shape[1]]
        for start in range(0, len(coordinates), BLOCK):
            points = (coordinates[start : start + BLOCK] @ rows).view(np.complex128)
            worst = max(worst, float(np.abs(points).max(initial=0.0)))
        return worst

    def targets(self, rank: int) -> MorphTargets:
        """Return the motion in `rank` shapes about its mean."""
        moments = _table(self._moments, self.rank)
        inner = [index for index, middle in enumerate(self._middles) if middle is not None]
        middles = _table([m for m in self._middles if m is not None], self.rank)
        seen = np.vstack([moments, middles])
        mean = seen.mean(axis=0)
        _, _, right = np.linalg.svd(seen - mean, full_matrices=False)
        axes = right[:rank]
        heights = (moments - mean) @ axes.T
        low, high = heights.min(axis=0), heights.max(axis=0)
        # Each axis points away from the base, so the target of weight 1 is small.
        centre = axes @ mean
        flip = np.where(np.abs(centre + high) < np.abs(centre + low), -1.0, 1.0)
        axes, heights = axes * flip[:, None], heights * flip
        low, high = np.minimum(low * flip, high * flip), np.maximum(low * flip, high * flip)
        spans = np.maximum(high - low, np.finfo(np.float64).tiny)
        weights, shapes = (heights - low) / spans, spans[:, None] * axes
        offset = mean + low @ axes
        if self.largest(offset[None]) > self._slack:
            weights = np.hstack([np.ones((len(weights), 1)), weights])
            shapes = np.vstack([offset, shapes])
        straight = (weights[:-1] + weights[1:])[inner] / 2
        apart = moments - weights @ shapes, middles - straight @ shapes
        error = max(map(self.largest, apart))
        return MorphTargets(
            base=self._base,
            targets=freeze((shapes @ self._rows).view(np.complex128)),
            times=freeze(np.array(self._times)),
            weights=freeze(weights),
            error=error + self._slack,
        )


def _table(rows: Sequence[Floats], width: int) -> Floats:
    """Return rows of coordinates, padded with 0: earlier rows have fewer coordinates."""
    table = np.zeros((len(rows), width))
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table
