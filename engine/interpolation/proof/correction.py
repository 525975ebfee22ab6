"""Holomorphic corrections on cells: closed periods and pins.

Along a piece of the boundary a function of the span differs from its linear interpolant by at most
h² max|H''| / 2, with |H''| ≤ Σ |dS_j| / (2π d_j) as in `engine.maps.certificate`. In time a series
differs from its chord by an eighth of its second derivative, which the coefficients bound.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from engine.arrays import Complexes, Floats, Indices
from engine.interpolation.added.closing import Closing
from engine.interpolation.enclosures.cells import BernsteinPatch
from engine.interpolation.enclosures.pieces import Subdivision, append_alternately
from engine.interpolation.series.chebyshev import PiecewiseSeries
from engine.interpolation.series.residual import HoleConstants
from engine.maps import Boundary

LEFT_OUT = 1e-9  # bound of rounding and of the terms omitted from the series of h


class LinearEnclosures(NamedTuple):
    """Series on pieces of time: values at both ends, (c, 2, j), errors of the chords, (c, j)."""

    ends: Floats
    errors: Floats


class TimeSeries:
    """Series in time with a bound on their second derivatives."""

    def __init__(self, series: PiecewiseSeries) -> None:
        self.series = series
        lengths = np.diff(series.breaks)
        second = chebyshev.chebder(series.coefficients, 2, axis=1)
        self._bends = np.abs(second).sum(axis=1) * (2.0 / lengths[:, None]) ** 2

    def linear_enclosures(self, starts: Floats, ends: Floats) -> LinearEnclosures:
        """Return the chords of pieces of time; no piece may cross a break."""
        middles = (starts + ends) / 2
        piece = np.searchsorted(self.series.breaks, middles, side="right") - 1
        piece = np.clip(piece, 0, len(self._bends) - 1)
        values = np.stack([self.series.at(starts).T, self.series.at(ends).T], axis=1)
        return LinearEnclosures(values, self._bends[piece] * ((ends - starts) ** 2 / 8)[:, None])


class CorrectionEnclosure:
    """The sum of functions of the span times series, on pieces of the boundary.

    Parameters
    ----------
    functions : complex128, shape (n, j)
        Coefficients in the span.
    pieces : Subdivision
        Still without halves: its pieces are the boundary's segments.
    constants : HoleConstants, optional
        Constants on the boundaries of holes; they are subtracted.
    """

    def __init__(
        self,
        functions: Complexes,
        series: PiecewiseSeries,
        boundary: Boundary,
        pieces: Subdivision,
        constants: HoleConstants | None = None,
    ) -> None:
        self._functions = functions
        self._series = TimeSeries(series)
        self._pieces, self._span = pieces, boundary.span
        count = len(boundary.span.vertices)
        bending = boundary.span.singularity_strengths(self._functions)[:count]
        kernel = np.sqrt(boundary.third_derivative_kernel[:, :count] / (2 * np.pi))
        self._errors = (kernel @ bending) * (boundary.half_lengths**2 / 2)[:, None]
        values = self._values(boundary.points)
        self._ends = np.stack([values, values[boundary.next_samples]], axis=1)
        self._lost = None if constants is None else TimeSeries(constants.series)
        # Constants by loop of the boundary; the outline has none.
        self._by_loop = np.zeros((0, 0))
        if constants is not None:
            self._by_loop = np.pad(constants.at_holes, ((1, 0), (0, 0)))

    @property
    def breaks(self) -> Floats:
        """Times at which cells must be cut."""
        own = self._series.series.breaks
        return own if self._lost is None else np.union1d(own, self._lost.series.breaks)

    def on(
        self, piece: Indices, starts: Floats, ends: Floats
    ) -> tuple[BernsteinPatch[np.complex128], Floats]:
        """Return the sum on cells, linear in time and along the piece, and its error due to time.

        The second value is the part (c,) of the error due to the pieces of time; the rest is due to
        the pieces of the boundary.
        """
        self._catch_up()
        modes, errors = self._ends[piece], self._errors[piece]
        chords = self._series.linear_enclosures(starts, ends)
        controls = np.einsum("caj,cbj->cab", chords.ends, modes)
        in_place = (np.abs(chords.ends).max(axis=1) * errors).sum(axis=1) + LEFT_OUT
        in_time = (chords.errors * (np.abs(modes).max(axis=1) + errors)).sum(axis=1)
        if self._lost is not None:
            constants = self._by_loop[self._pieces.loops[piece]]
            lost = self._lost.linear_enclosures(starts, ends)
            controls = controls - np.einsum("caj,cj->ca", lost.ends, constants)[:, :, None]
            in_time += (lost.errors * np.abs(constants)).sum(axis=1)
        return BernsteinPatch(controls, in_place + in_time), in_time

    def _catch_up(self) -> None:
        """Add the pieces created since the last call."""
        pieces = self._pieces
        parents = pieces.parents[len(self._errors) :: 2]
        if not len(parents):
            return
        middles = self._values((pieces.starts[parents] + pieces.ends[parents]) / 2)
        first, last = self._ends[parents, 0], self._ends[parents, 1]
        halves = np.stack([first, middles], axis=1), np.stack([middles, last], axis=1)
        self._ends = append_alternately(self._ends, *halves)
        quarter = self._errors[parents] / 4
        self._errors = append_alternately(self._errors, quarter, quarter)

    def _values(self, points: Complexes) -> Complexes:
        (values,) = self._span.evaluate(self._functions, points, orders=(0,))
        return values


def closing_on(
    closing: Closing,
    boundary: Boundary,
    pieces: Subdivision,
    constants: HoleConstants | None = None,
) -> CorrectionEnclosure:
    """Return the enclosure of h, which closes periods around holes."""
    functions, series = closing.functions.coefficients, closing.series
    return CorrectionEnclosure(functions, series, boundary, pieces, constants)
