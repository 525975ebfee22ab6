"""Keyframes between the samples of an outline, and their extremes there."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Complexes, Floats, Indices, freeze
from engine.geometry import next_on_loop
from engine.interpolation.scaling.pointwise import NEGLIGIBLE, KeyframeExtremes, PointSamples

# Accuracy of the worst bounds. With less, a scaling by them could have no room.
EXACT = NEGLIGIBLE / 10
# Number of parts of a segment around an extreme; each round makes the segment PARTS / 2 times
# shorter.
PARTS = 8
ROUNDS = 8


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OutlineCurves:
    """Holomorphic functions between the samples of an outline, by Hermite interpolation.

    Each segment has its own polynomial of degree 7 in w = (z − start) / span, in Newton's form. It
    matches the functions and their derivatives at four samples around the segment.

    Attributes
    ----------
    places : complex128, shape (8, p)
        w of the four samples of each segment, each twice.
    coefficients : complex128, shape (8, 2 q + j + i, p)
        f_z of the keyframes, conj(f_z̄) of the keyframes, and the modes of h and d.
    counts : (int, int)
        q and j.
    following : intp, shape (p,)
        The sample at the end of each segment.
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

        With weights (j + i, c) the sums of the modes replace the modes. Without weights the modes
        are left out.
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


def keyframe_extremes(curves: OutlineCurves) -> KeyframeExtremes:
    """Return the extremes of the keyframes along the outline, also between the samples."""
    segments = np.arange(len(curves.following))
    grid = places_around(np.full(len(segments), 0.5), 0.5)
    found = curves.at(segments, grid)
    k, sigma_a = (-_least(curves, grid, -getattr(found, of), of, -1) for of in ("k", "sigma_a"))
    return KeyframeExtremes(
        k=k, sigma_a=sigma_a, sigma_b=_least(curves, grid, found.sigma_b, "sigma_b", 1)
    )


def _least(curves: OutlineCurves, places: Floats, values: Floats, of: str, sign: int) -> float:
    """Return the least value of a distortion, times a sign, given its values at places (c, s).

    All segments that may contain the minimum are subdivided, on both sides of a sample.
    """
    segments, width, least = np.arange(len(values)), 0.5, float(values.min())
    for _ in range(ROUNDS):
        variation = np.abs(np.diff(values, axis=1)).max(axis=1)
        kept = np.flatnonzero(values.min(axis=1) - variation < least - EXACT)
        if not len(kept):
            break
        width *= 2.0 / PARTS
        middle = places[kept, values[kept].argmin(axis=1)]
        segments, places = segments[kept], places_around(middle, width)
        values = sign * getattr(curves.at(segments, places), of)
        least = min(least, float(values.min()))
    return least


def places_around(place: Floats, width: float) -> Floats:
    """Return places (c, PARTS + 1) around places (c,), within their segments."""
    return np.clip(place[:, None] + width * np.linspace(-1.0, 1.0, PARTS + 1), 0.0, 1.0)
