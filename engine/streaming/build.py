"""From the direct path to series: adaptive pieces of time, each compared with it."""

from collections import deque
from collections.abc import Generator
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np

from engine.arrays import Floats, Singles, freeze
from engine.interpolation import Scaling, chebyshev
from engine.streaming.channels import Channels, Sample, scales
from engine.streaming.series import Series, SeriesPiece

Result = TypeVar("Result")

SAMPLED = 8192  # columns that the rank of a motion is found from
DEGREES = (8, 16, 32)  # the nodes of each are among those of the next
LAST_TERMS = 2
MOST_ROWS = 12  # of a piece: a frame costs as many multiply-adds, a linear blend two
SHORTEST = 2.0**-14  # pieces are not halved below this
# Pieces that are tried. What is not accurate by then stays on the direct path: where float32 itself
# is too coarse, as for parts that cancel each other, no piece is short enough.
MOST_ATTEMPTS = 96
# Shares of the tolerance. The rest is for rounding to float32.
OF_POLYNOMIALS, OF_RANK, OF_RHO = 0.1, 0.4, 0.2
CHECKED = 0.7  # of the tolerance, at the times that are looked at; between them it may be more


def build_series(channels: Channels) -> Generator[None, None, Series]:
    """Build the series of an interval, a small part at each step.

    A step is one evaluation of the direct path or less, but for one in each piece that compresses
    it. The generator may be left at any step.

    Departs from the paper: Section 7 works out every in-between anew.

    Notes
    -----
    f^t is analytic in time (with ρ, both of its parts are), so that a polynomial through Chebyshev
    nodes converges geometrically. Pieces of time are halved where its last coefficients do not
    come down. What a piece's polynomials do at the many points is then written in the few
    functions of time that suffice for all of them. Stretches that no piece is accurate on are left
    out.
    """
    source = yield from _prepare(channels)
    # The longest first: easy stretches are covered before the hard ones take all attempts.
    pending = deque([(0.0, 1.0)])
    pieces, error = [], 0.0
    for _ in range(MOST_ATTEMPTS):
        if not pending:
            break
        start, end = pending.popleft()
        found = yield from _attempt(source, start, end)
        if found is not None:
            pieces.append(found[0])
            error = max(error, found[1])
        elif end - start > SHORTEST:
            middle = (start + end) / 2
            pending += [(start, middle), (middle, end)]
    pieces.sort(key=lambda piece: piece.start)
    return Series(pieces=tuple(pieces), rho=source.rho, error=error)


def finish(steps: Generator[None, None, Result]) -> Result:
    """Take all steps that are left, and return what comes of them."""
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            result: Result = stop.value
            return result


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Source:
    """The direct path, and its ρ unless nothing shows of it.

    `largest_loss` is the largest 1 − ρ, by which the scaled part is multiplied under work.
    """

    channels: Channels
    rho: Scaling | None
    largest_loss: float

    @property
    def tolerance(self) -> float:
        return self.channels.tolerance

    def exact(self, time: float) -> Floats:
        """Return the values (c,) with the direct path's own ρ."""
        values, scaled = self.channels.sample(time)
        inbetweens = self.channels.inbetweens
        if scaled is None or not scales(inbetweens):
            return values
        return values + (inbetweens.rho(time) - 1.0) * scaled


def _prepare(channels: Channels) -> Generator[None, None, _Source]:
    plain = _Source(channels=channels, rho=None, largest_loss=0.0)
    inbetweens = channels.inbetweens
    scale = inbetweens.scale if scales(inbetweens) else None
    if scale is None:
        return plain
    largest = 0.0
    for time in (0.0, 0.5, 1.0):
        scaled = channels.sample(time).scaled
        yield
        if scaled is not None:
            largest = max(largest, float(np.abs(scaled).max()))
    loss = 1.0 - scale.least
    if loss * largest <= OF_RHO * channels.tolerance:
        return plain
    return replace(plain, rho=scale, largest_loss=loss)


def _attempt(
    source: _Source, start: float, end: float
) -> Generator[None, None, tuple[SeriesPiece, float] | None]:
    """Return the piece from `start` to `end` and its error, or None where it is not accurate."""
    first = source.channels.sample(start)
    yield
    last = source.channels.sample(end)
    yield
    window = _Window(source=source, start=start, end=end, first=first, last=last)
    known: Singles | None = None
    before = np.inf
    for degree in DEGREES:
        known = yield from window.snapshots(degree, known)
        rest = _last_terms(known)
        if rest <= OF_POLYNOMIALS * source.tolerance:
            piece = window.compressed(known)
            yield
            error = yield from window.error(piece, degree)
            if error <= CHECKED * source.tolerance and len(piece.rows) <= MOST_ROWS:
                return piece, error
        # At the rate at which the terms came down, twice the degree brings their ratio squared.
        if rest * (rest / before) ** 2 > source.tolerance:
            return None
        before = rest
    return None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Window:
    """A piece of time under work, with the samples at both of its ends."""

    source: _Source
    start: float
    end: float
    first: Sample
    last: Sample

    def time(self, x: float) -> float:
        """Return the time at x in [−1, 1]."""
        return self.start + (self.end - self.start) * (1.0 + x) / 2

    def snapshots(self, degree: int, known: Singles | None) -> Generator[None, None, Singles]:
        """Return what the direct path adds to the blend of the ends at the nodes of a degree.

        Parameters
        ----------
        degree : int
        known : float32, shape (p, degree / 2 + 1, c), optional
            The same at the nodes of half the degree.

        Returns
        -------
        float32, shape (p, degree + 1, c)
            p is 2 where there is a ρ; the second part is what it scales, times `largest_loss`.
        """
        parts = 1 if self.source.rho is None else 2
        found = np.empty((parts, degree + 1, len(self.first.values)), dtype=np.float32)
        if known is not None:
            found[:, ::2] = known
        for index, x in enumerate(chebyshev.nodes(degree)):
            if known is not None and index % 2 == 0:
                continue
            if index in (0, degree):
                values, scaled = self.last if index else self.first
            else:
                values, scaled = self.source.channels.sample(self.time(float(x)))
            blend = (1.0 - x) / 2 * self.first.values + (1.0 + x) / 2 * self.last.values
            found[0, index] = values - blend
            if parts == 2 and scaled is not None:
                found[1, index] = self.source.largest_loss * scaled
            yield
        return found

    def compressed(self, snapshots: Singles) -> SeriesPiece:
        """Write snapshots (p, n, c) in few functions of time."""
        parts, count, size = snapshots.shape
        flat = snapshots.reshape(parts * count, size)
        times = leading_functions(flat, OF_RANK * self.source.tolerance)
        series = chebyshev.to_coefficients(count - 1) @ times.reshape(parts, count, -1)
        ends = np.zeros((count, 2))
        functions = [np.hstack([ends, part]) for part in series]
        functions[0][:2, :2] = [[0.5, 0.5], [-0.5, 0.5]]
        rows = np.empty((2 + times.shape[1], size), dtype=np.float32)
        rows[0], rows[1] = self.first.values, self.last.values
        np.matmul(times.T.astype(np.float32), flat, out=rows[2:])
        rows.setflags(write=False)
        return SeriesPiece(
            start=self.start,
            end=self.end,
            functions=freeze(functions[0]),
            scaled_functions=freeze(functions[1] / self.source.largest_loss)
            if parts == 2
            else None,
            rows=rows,
        )

    def error(self, piece: SeriesPiece, degree: int) -> Generator[None, None, float]:
        """Return the largest error at times where a polynomial of the degree errs most."""
        worst = 0.0
        for gap in (0, degree // 2, degree - 1):
            time = self.time(-np.cos(np.pi * (gap + 0.5) / degree))
            rho = 1.0 if self.source.rho is None else self.source.rho(time)
            values = piece.weights(time, rho) @ piece.rows
            worst = max(worst, float(np.abs(values - self.source.exact(time)).max()))
            yield
        return worst


def _last_terms(snapshots: Singles) -> float:
    """Return the largest of the last coefficients of the polynomials through snapshots."""
    last = chebyshev.to_coefficients(snapshots.shape[1] - 1)[-LAST_TERMS:].astype(np.float32)
    return max(float(np.abs(last @ part).max()) for part in snapshots)


def leading_functions(snapshots: Singles, tolerance: float) -> Floats:
    """Return an orthonormal basis (m, r) in which all columns of `snapshots` are written.

    A column is what one coordinate of one point does in time. As points move alike, far fewer
    functions of time occur among them than a polynomial basis has.

    Parameters
    ----------
    snapshots : float32, shape (m, c)
    tolerance : float
        The largest entry that `snapshots` may lose; sampled at some columns, which is enough where
        neighbouring points move alike.
    """
    # An odd stride takes x and y in turn.
    stride = (snapshots.shape[1] // SAMPLED) | 1
    rest = snapshots[:, ::stride].astype(np.float64)
    left, sizes, right = np.linalg.svd(rest, full_matrices=False)
    rank = 0
    while rank < len(sizes) and np.abs(rest).max() > tolerance:
        rest -= np.outer(left[:, rank], sizes[rank] * right[rank])
        rank += 1
    return np.ascontiguousarray(left[:, :rank])
