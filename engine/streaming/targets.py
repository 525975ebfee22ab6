"""A whole motion as one shape and a few others that are added to it with weights in [0, 1].

What a game engine calls morph targets or blend shapes, with the weights as piecewise linear
functions of time.
"""

from collections.abc import Callable, Generator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from engine.arrays import Complexes, Floats, freeze

# Shares of the tolerance: of what the basis leaves out, of the weights' way between their times,
# and of the targets that are left out. Times cost little, targets much.
OF_BASIS, OF_TIME, OF_RANK = 0.02, 0.1, 0.85
BLOCK = 256  # moments that are written out at once


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ShapeTargets:
    """Where m points are: base + Σ_j w_j(t) targets_j.

    Parameters
    ----------
    base : complex128, shape (m,)
    targets : complex128, shape (r, m)
    times : float64, shape (n,)
        Increasing.
    weights : float64, shape (n, r)
        At the times, in [0, 1]; linear in between.
    error : float
        The largest distance from the motion that was found, of all points, at the times and in
        the middle between each two.
    """

    base: Complexes
    targets: Complexes
    times: Floats
    weights: Floats
    error: float

    def positions(self, time: float) -> Complexes:
        """Return the points (m,) at a time; before the first and after the last they rest."""
        weights = np.array([np.interp(time, self.times, column) for column in self.weights.T])
        places: Complexes = self.base + weights @ self.targets
        return places


def build_targets(
    sample: Callable[[float], Complexes],
    base: Complexes,
    times: Sequence[float],
    *,
    tolerance: float,
    most: int | None = None,
    shortest: float = 2.0**-6,
) -> Generator[float, None, ShapeTargets]:
    """Find the fewest targets that keep a motion within a tolerance; yield the time at each step.

    Parameters
    ----------
    sample : callable
        Returns the points (m,) at a time from the first to the last of `times`.
    base : complex128, shape (m,)
        What all targets are added to.
    times : sequence of float
        Increasing; at least one. Where the motion is looked at first: so closely that it does
        nothing in between that does not show in the middle.
    tolerance : float
        The largest distance that is allowed between a point and where it should be, at any time.
    most : int, optional
        How many targets there may be. Where they do not suffice, `error` tells how far they come.
    shortest : float
        Time that a jump of the motion may take: there no tolerance is kept.

    Notes
    -----
    Moments are halved until the weights' straight way from one to the next is close enough. The
    motion at all of them, a matrix of points by moments, has a low rank up to the tolerance; its
    principal components about the mean are the targets. With one more target, whose weight is
    always 1, the others' weights are never negative: engines cut those off. At first it is left
    out where the motion allows it, as where it starts at the base.
    """
    film = _Film(base, OF_BASIS * tolerance)
    film.add(times[0], sample(times[0]))
    yield times[0]
    for start, end in pairwise(times):
        last = film.take(sample(end))
        yield end
        yield from _follow(film, sample, (start, end, last), (OF_TIME * tolerance, shortest))
    found = film.targets(0)
    for rank in range(1, film.rank + 1):
        if found.error <= (OF_RANK + OF_TIME) * tolerance:
            break
        more = film.targets(rank)
        if most is not None and len(more.targets) > most:
            break
        found = more
    return found


def _follow(
    film: "_Film",
    sample: Callable[[float], Complexes],
    gap: tuple[float, float, Floats],
    limits: tuple[float, float],
) -> Generator[float, None, None]:
    """Add the moments from one to the next, after the first, as closely as is needed."""
    largest, shortest = limits
    pending = [gap]
    while pending:
        start, end, last = pending.pop()
        middle = (start + end) / 2
        between = film.take(sample(middle))
        yield middle
        bend = film.largest(_sum(between, -0.5 * film.latest, -0.5 * last)[None])
        if bend <= largest:
            film.add_middle(between)
            film.append(end, last)
        elif end - start <= shortest:
            # A jump: its middle is where it is for no time at all.
            film.add_middle(None)
            film.append(end, last)
        else:
            pending += [(middle, end, last), (start, middle, between)]


class _Film:
    """A motion at some moments, each of them as its coordinates in a basis that grows with them.

    Parameters
    ----------
    base : complex128, shape (m,)
    slack : float
        The largest distance that a basis may leave out.
    """

    def __init__(self, base: Complexes, slack: float) -> None:
        self._base = base
        self._slack = slack
        self._rows = np.empty((0, 2 * len(base)))  # orthonormal
        self._times: list[float] = []
        self._moments: list[Floats] = []
        self._middles: list[Floats | None] = []

    @property
    def rank(self) -> int:
        """How many shapes the basis has."""
        return len(self._rows)

    @property
    def latest(self) -> Floats:
        """The coordinates of the moment that was added last."""
        return self._moments[-1]

    def take(self, points: Complexes) -> Floats:
        """Return the coordinates (q,) of the points, in a basis that now has room for them."""
        rest = (points - self._base).view(np.float64)
        coordinates = self._rows @ rest
        rest = rest - coordinates @ self._rows
        # Once more, against rounding.
        again = self._rows @ rest
        rest -= again @ self._rows
        coordinates += again
        if float(np.abs(rest.view(np.complex128)).max(initial=0.0)) > self._slack:
            length = float(np.linalg.norm(rest))
            self._rows = np.vstack([self._rows, rest / length])
            coordinates = np.append(coordinates, length)
        return coordinates

    def add(self, time: float, points: Complexes) -> None:
        """Add a moment."""
        self.append(time, self.take(points))

    def append(self, time: float, coordinates: Floats) -> None:
        """Add a moment by its coordinates."""
        self._times.append(time)
        self._moments.append(coordinates)

    def add_middle(self, coordinates: Floats | None) -> None:
        """Note what is in the middle between the last moment and the next one; None of a jump."""
        self._middles.append(coordinates)

    def largest(self, coordinates: Floats) -> float:
        """Return the largest distance from the origin of any point in moments (n, q)."""
        worst = 0.0
        rows = self._rows[: coordinates.shape[1]]
        for start in range(0, len(coordinates), BLOCK):
            points = (coordinates[start : start + BLOCK] @ rows).view(np.complex128)
            worst = max(worst, float(np.abs(points).max(initial=0.0)))
        return worst

    def targets(self, rank: int) -> ShapeTargets:
        """Return the motion in so many shapes about its mean."""
        moments = _table(self._moments, self.rank)
        inner = [index for index, middle in enumerate(self._middles) if middle is not None]
        middles = _table([m for m in self._middles if m is not None], self.rank)
        seen = np.vstack([moments, middles])
        mean = seen.mean(axis=0)
        _, _, right = np.linalg.svd(seen - mean, full_matrices=False)
        axes = right[:rank]
        heights = (moments - mean) @ axes.T
        low, high = heights.min(axis=0), heights.max(axis=0)
        # Each axis points away from the base, so that little is left for the target of weight 1.
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
        error = max(
            self.largest(moments - weights @ shapes),
            self.largest(middles - straight @ shapes),
        )
        return ShapeTargets(
            base=self._base,
            targets=freeze((shapes @ self._rows).view(np.complex128)),
            times=freeze(np.array(self._times)),
            weights=freeze(weights),
            error=error + self._slack,
        )


def _sum(*terms: Floats) -> Floats:
    """Add up coordinates, of which those that were found earlier may be fewer."""
    total: Floats = _table(list(terms), max(map(len, terms))).sum(axis=0)
    return total


def _table(rows: Sequence[Floats], width: int) -> Floats:
    table = np.zeros((len(rows), width))
    for row, values in zip(table, rows, strict=True):
        row[: len(values)] = values
    return table
