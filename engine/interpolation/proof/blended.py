"""How cells are enclosed: which quantities each variant blends, and by which weights."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from engine.arrays import Booleans, Floats, Indices
from engine.interpolation.derivatives import Passage
from engine.interpolation.inbetweens import Inbetweens, LinearInbetweens
from engine.interpolation.passing import Course
from engine.interpolation.proof import cells
from engine.interpolation.proof.cells import Patch
from engine.interpolation.proof.pieces import EdgeCurves, EndValues, Subdivision
from engine.interpolation.proof.through import enclose_through
from engine.maps import Bounds, Enclosures
from engine.variant import Variant

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


Enclose = Callable[[Cells], Found]


def blended(pieces: Subdivision, inbetweens: Inbetweens, variant: Variant) -> Enclose:
    """Return how cells of a variant are enclosed whose quantities are polynomials in time."""
    known = _Known(pieces, variant)
    passage = inbetweens.passage
    courses = passage.course, passage.eta_course or passage.course
    scale = None
    if not isinstance(inbetweens, LinearInbetweens) and inbetweens.scale is not None:
        scale = inbetweens.scale.upper_bounds()

    def enclose(chosen: Cells) -> Found:
        first, second = (
            _patch(curves.at(chosen.piece), controls_on(course, chosen.start, chosen.end))
            for curves, course in zip(known.curves(), courses, strict=True)
        )
        rho, at_corners = np.ones(len(chosen.piece)), np.ones(4 * len(chosen.piece))
        if scale is not None:
            rho = scale.on(chosen.start, chosen.end)
            ends = [scale.on(time, time) for time in (chosen.start, chosen.end)]
            at_corners = np.repeat(np.stack(ends, axis=1).ravel(), 2)
        return Found(
            _enclosures(variant, first, second, rho),
            _enclosures(variant, first.corners(), second.corners(), at_corners),
            _varies_more_in_time(first, second),
        )

    return enclose


def through(pieces: Subdivision, passage: Passage, bounds: Bounds) -> Enclose:
    """Return how cells of metric in-betweens through keyframes are enclosed, at all times."""
    known = _Known(pieces, Variant.METRIC)
    course = passage.eta_course or passage.course

    def enclose(chosen: Cells) -> Found:
        trace, eta = (curves.at(chosen.piece) for curves in known.curves())
        enclosed = enclose_through(trace, eta, course, bounds)
        key = slice(course.first, course.first + 1)
        none = np.zeros(len(chosen.piece))
        attained = cells.from_metric(
            Patch(trace.controls[:, key, :1], none), Patch(eta.controls[:, key, :1], none)
        )
        return Found(enclosed, attained, np.zeros(len(chosen.piece), np.bool_))

    return enclose


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


def _varies_more_in_time(first: AnyPatch, second: AnyPatch) -> Booleans:
    """Tell along which side cells are to be cut."""
    in_time, in_place = np.zeros(len(first.error)), np.zeros(len(first.error))
    for patch in (first, second):
        size = np.abs(patch.controls).max(axis=(1, 2)) + 1e-300
        in_time += np.abs(np.diff(patch.controls, axis=1)).max(axis=(1, 2), initial=0.0) / size
        along = np.abs(np.diff(patch.controls, axis=2)).max(axis=(1, 2), initial=0.0)
        in_place += (along + patch.error) / size
    more: Booleans = in_time > in_place
    return more


def _joined(one: AnyCurves, other: AnyCurves) -> AnyCurves:
    return EdgeCurves(
        np.concatenate([one.controls, other.controls]), np.concatenate([one.errors, other.errors])
    )
