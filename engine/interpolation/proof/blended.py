"""How cells are enclosed: which quantities each variant blends, and by which weights."""

from collections.abc import Callable
from math import inf
from typing import Any, NamedTuple

import numpy as np

from engine.arrays import Booleans, Floats, Indices
from engine.interpolation.derivatives import Passage
from engine.interpolation.inbetweens import Inbetweens, LinearInbetweens
from engine.interpolation.passing import Course
from engine.interpolation.proof import cells
from engine.interpolation.proof.cells import Patch
from engine.interpolation.proof.correction import Correction
from engine.interpolation.proof.pieces import EdgeCurves, EndValues, Subdivision
from engine.interpolation.proof.through import enclose_through
from engine.interpolation.scaling import ScalingEnclosures
from engine.maps import Boundary, Bounds, Enclosures
from engine.variant import Variant

PARTS = 4  # into which time is cut at first
SMALL = 1e-4  # what a logarithm may change in time without being looked at more closely
LEAST = 1.0  # what the changes of a quantity are compared with, at least

AnyCurves = EdgeCurves[Any]
AnyPatch = Patch[Any]


class Cells(NamedTuple):
    """Subdivision of the boundary (c,) from one time to another."""

    piece: Indices
    start: Floats
    end: Floats

    def at(self, which: Booleans | slice) -> "Cells":
        """Return some of them."""
        return Cells(self.piece[which], self.start[which], self.end[which])


class Found(NamedTuple):
    """What is known of cells: enclosures, what is attained, and where to cut (across time)."""

    enclosed: Enclosures
    attained: Enclosures
    by_time: Booleans


class Method(NamedTuple):
    """How to prove in-betweens.

    Parameters
    ----------
    enclose : callable
    cuts : float64, shape (b + 1,)
        Of time, from 0 to 1, over which no cell reaches.
    floor : Enclosures
        What need not be undercut.
    """

    enclose: Callable[[Cells], Found]
    cuts: Floats
    floor: Enclosures


def method_of(
    pieces: Subdivision,
    inbetweens: Inbetweens,
    variant: Variant,
    boundary: Boundary,
    bounds: Bounds,
) -> Method:
    """Return how the in-betweens of a variant are proven."""
    if isinstance(inbetweens, LinearInbetweens):
        closed = _Closed(None, None, None)
    else:
        scale, metric = inbetweens.scale, inbetweens.metric
        corrections = [
            Correction(closing, boundary, pieces, metric) for closing in inbetweens.closings
        ]
        closed = _Closed(
            None if scale is None else scale.enclosures(), *[*corrections, None, None][:2]
        )
    if variant is Variant.METRIC and not inbetweens.passage.course.is_straight:
        return _through(pieces, inbetweens.passage, bounds, closed)
    return _blended(pieces, inbetweens.passage, variant, closed)


def _blended(pieces: Subdivision, passage: Passage, variant: Variant, closed: "_Closed") -> Method:
    """Return the way for quantities that are polynomials in time."""
    known = _Known(pieces, variant)
    courses = passage.course, passage.eta_course or passage.course

    def enclose(chosen: Cells) -> Found:
        first, second = (
            _patch(curves.at(chosen.piece), controls_on(course, chosen.start, chosen.end))
            for curves, course in zip(known.curves(), courses, strict=True)
        )
        by_time = _varies_more_in_time(first, second)
        if variant is Variant.METRIC and closed.correction is not None:
            h, _ = closed.correction.on(*chosen)
            rho, at_corners, grown = closed.scaling(chosen)
            return Found(
                cells.corrected(first, second, cells.real_range(h), rho, cells.real_range(grown)),
                cells.corrected(
                    first.corners(),
                    second.corners(),
                    cells.real_range(h.corners()),
                    at_corners.ravel(),
                    cells.real_range(grown.corners()),
                ),
                _varies_more_in_time(first, second, h),
            )
        first, rho, at_corners = closed.applied(first, chosen)
        return Found(
            _enclosures(variant, first, second, rho),
            _enclosures(variant, first.corners(), second.corners(), at_corners),
            by_time,
        )

    start = np.array([0.0])
    return Method(enclose, closed.cuts, Enclosures(start, start, start + inf))


def _through(pieces: Subdivision, passage: Passage, bounds: Bounds, closed: "_Closed") -> Method:
    """Return the way for metric in-betweens through keyframes: their bounds hold at all times."""
    known = _Known(pieces, Variant.METRIC)
    course = passage.eta_course or passage.course
    floor = Enclosures(*(np.array([b]) for b in (bounds.k, bounds.sigma_a, bounds.sigma_b)))
    correction = closed.correction

    def enclose(chosen: Cells) -> Found:
        trace, eta = (curves.at(chosen.piece) for curves in known.curves())
        enclosed = enclose_through(trace, eta, course, bounds)
        key = slice(course.first, course.first + 1)
        none = np.zeros(len(chosen.piece))
        whole = Patch(trace.controls[:, key], none), Patch(eta.controls[:, key], none)
        attained = cells.from_metric(*(patch.corners() for patch in whole))
        if correction is None:
            return Found(enclosed, attained, np.zeros(len(chosen.piece), np.bool_))
        h, in_time = correction.on(*chosen)
        attained = Enclosures(
            np.maximum(attained.k, bounds.k),
            np.maximum(attained.sigma_a, bounds.sigma_a),
            np.minimum(attained.sigma_b, bounds.sigma_b),
        )
        enclosed = cells.widened(enclosed, cells.real_range(h))
        attained = cells.widened(attained, cells.real_range(h.corners()))
        if closed.scale is not None:
            rho, at_corners, grown = closed.scaling(chosen)
            enclosed = cells.scaled(enclosed, rho, cells.real_range(grown))
            attained = cells.scaled(attained, at_corners.ravel(), cells.real_range(grown.corners()))
        return Found(enclosed, attained, _is_long(h, in_time))

    cuts = closed.cuts if correction is not None else np.array([0.0, 1.0])
    return Method(enclose, cuts, floor)


def _is_long(h: Patch[np.complex128], error: Floats) -> Booleans:
    """Tell where h changes so much in time that the cells are to be cut in time."""
    values = h.controls.real
    in_time = np.ptp(values, axis=1).max(axis=1) + error
    long: Booleans = (in_time > SMALL) & (in_time > np.ptp(values, axis=2).max(axis=1))
    return long


class _Closed(NamedTuple):
    """What the scaling of Ψ and the corrections around holes do to cells."""

    scale: ScalingEnclosures | None
    correction: Correction | None
    opening: Correction | None

    @property
    def cuts(self) -> Floats:
        """Where time is cut first."""
        cuts = np.linspace(0.0, 1.0, PARTS + 1)
        for each in (self.correction, self.opening):
            cuts = cuts if each is None else np.union1d(cuts, each.breaks)
        return cuts

    def applied(
        self, log_modulus: Patch[np.float64], chosen: Cells
    ) -> tuple[Patch[np.float64], Floats, Floats]:
        """Return ln |f_z|, and what η is scaled by at most, on cells (c,) and at corners (4c,)."""
        if self.correction is not None:
            log_modulus = log_modulus.plus(cells.real_part(self.correction.on(*chosen)[0]))
        most, at_corners, grown = self.scaling(chosen)
        if self.opening is None:
            return log_modulus, most, at_corners.ravel()
        highest = grown.controls.max(axis=(1, 2)) + grown.error
        factors = np.exp(grown.controls).reshape(-1, 4)
        return log_modulus.plus(grown), most * np.exp(highest), (at_corners * factors).ravel()

    def scaling(self, chosen: Cells) -> tuple[Floats, Floats, Patch[np.float64]]:
        """Return the largest ρ on cells (c,), that at their corners (c, 4), and ln |w| of f_z."""
        piece, start, end = chosen
        none = Patch(np.zeros((len(piece), 2, 2)), np.zeros(len(piece)))
        if self.scale is None:
            return np.ones(len(piece)), np.ones((len(piece), 4)), none
        least, most = self.scale.on(start, end)
        rho = np.stack([self.scale.on(time, time)[1] for time in (start, end)], axis=1)
        at_corners = np.repeat(rho, 2, axis=1)
        if self.opening is None:
            return most, at_corners, none
        # Around holes f_z is that for ρ = 1 times w = ρ + (1 − ρ) e^d, with |w| ≥ `clear`.
        d, _ = self.opening.on(*chosen)
        size = d.highest.max(axis=(1, 2))
        clear = 1.0 - (1.0 - least) * np.expm1(size)
        clear = np.where(clear > 0, clear, np.nan)
        across = np.hypot(
            *(np.ptp(part, axis=(1, 2)) for part in (d.controls.real, d.controls.imag))
        )
        error = (1.0 - least) * np.exp(size) * (across + 2 * d.error) / clear
        error += np.expm1(size) * (most - least) / clear
        factor = rho[:, :, None] + (1.0 - rho[:, :, None]) * np.exp(d.controls)
        return most, at_corners, Patch(np.log(np.abs(factor)), error)


class _Known:
    """The two quantities that a variant blends, on all pieces so far; each is looked at once."""

    def __init__(self, pieces: Subdivision, variant: Variant) -> None:
        self._pieces = pieces
        self._variant = variant
        self._curves = _quantities(variant, pieces.derivatives(0))

    def curves(self) -> tuple[AnyCurves, AnyCurves]:
        """Return them."""
        since = len(self._curves[0].errors)
        if since < len(self._pieces.halves):
            first, second = _quantities(self._variant, self._pieces.derivatives(since))
            self._curves = _joined(self._curves[0], first), _joined(self._curves[1], second)
        return self._curves


def _quantities(variant: Variant, values: EndValues) -> tuple[AnyCurves, AnyCurves]:
    match variant:
        case Variant.LINEAR:
            return values.conformal(), values.anticonformal()
        case Variant.NU:
            return values.log_modulus(), values.nu()
        case Variant.ETA | Variant.SCALED_ETA:
            return values.log_modulus(), values.conj_eta()
        case Variant.METRIC:
            return values.trace(), values.conj_eta()


def _enclosures(variant: Variant, first: AnyPatch, second: AnyPatch, rho: Floats) -> Enclosures:
    match variant:
        case Variant.LINEAR:
            return cells.linear(first, second)
        case Variant.NU:
            return cells.from_nu(first, second)
        case Variant.ETA | Variant.SCALED_ETA:
            return cells.from_eta(first, second, rho)
        case Variant.METRIC:
            return cells.from_metric(first, second)


def controls_on(course: Course, starts: Floats, ends: Floats) -> Floats:
    """Return the weights of the keyframes at the control values of pieces of time (c,).

    Returns
    -------
    float64, shape (c, 2, 2) or (c, 4, q)
    """
    if course.controls is None:
        return np.stack([course.at(starts).T, course.at(ends).T], axis=1)
    weights = []
    for count in range(4):
        # The polar form: three times of which so many are the end.
        u, v, w = [ends if i < count else starts for i in range(3)]
        x, y, z = 1.0 - u, 1.0 - v, 1.0 - w
        weights.append(
            np.stack(
                [
                    x * y * z,
                    u * y * z + x * v * z + x * y * w,
                    u * v * z + u * y * w + x * v * w,
                    u * v * w,
                ]
            )
        )
    found: Floats = np.einsum("dkc,kq->cdq", np.array(weights), course.controls)
    return found


def _patch(curves: AnyCurves, weights: Floats) -> AnyPatch:
    """Blend curves (c, q, b) by weights (c, d, q)."""
    return Patch(
        weights @ curves.controls,
        (np.abs(weights) @ curves.errors[..., None])[..., 0].max(axis=1),
    )


def _varies_more_in_time(*patches: AnyPatch) -> Booleans:
    """Tell along which side cells are to be cut."""
    in_time, in_place = np.zeros((2, len(patches[0].error)))
    for patch in patches:
        size = np.maximum(np.abs(patch.controls).max(axis=(1, 2)), LEAST)
        in_time += np.abs(np.diff(patch.controls, axis=1)).max(axis=(1, 2), initial=0.0) / size
        along = np.abs(np.diff(patch.controls, axis=2)).max(axis=(1, 2), initial=0.0)
        in_place += (along + patch.error) / size
    more: Booleans = in_time > in_place
    return more


def _joined(one: AnyCurves, other: AnyCurves) -> AnyCurves:
    return EdgeCurves(
        np.concatenate([one.controls, other.controls]), np.concatenate([one.errors, other.errors])
    )
