"""Bounds of keyframes between two points of the boundary.

On a piece of a segment F = f_z and G = conj(f_z̄) differ from their linear interpolants by at most
ε (`engine.maps.certificate`). The blended quantities are functions of F and G. They follow as
Bézier curves in the place s along the piece, each with an error bound:

    ln |F|              linear, |ΔF|² / (8 r²) and −ln(1 − ε_f / r),
    F G = conj(η)       quadratic, |F| ε_g + |G| ε_f + ε_f ε_g,
    |F|² + |G|² = 𝒜     quadratic, (2 |F| + ε_f) ε_f + (2 |G| + ε_g) ε_g,
    G / F = ν           linear, |ΔF| |F_0 G_1 − F_1 G_0| / (4 r³) and (ε_g + |ν| ε_f) / (r − ε_f),

where r is the least |F| of the interpolant. The first terms are an eighth of the second derivative.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, NamedTuple, Self, TypeVar

import numpy as np
import numpy.typing as npt

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.maps import ROUNDING, Boundary, Span

type_ = TypeVar("type_", bound=np.generic)
number = TypeVar("number", np.float64, np.complex128)


class BoundaryBezier(NamedTuple, Generic[number]):
    """Bézier curves along pieces, one for each keyframe.

    `controls` are float64 or complex128 (p, q, b). `errors` (p, q) bound the distance of the
    quantity from the curve; infinite if no bound is known.
    """

    controls: npt.NDArray[number]
    errors: Floats

    def at(self, which: Indices) -> "BoundaryBezier[number]":
        """Return the curves of some of the pieces."""
        return BoundaryBezier(self.controls[which], self.errors[which])

    def of(self, keyframes: list[int]) -> "BoundaryBezier[number]":
        """Return the curves of some of the keyframes."""
        return BoundaryBezier(self.controls[:, keyframes], self.errors[:, keyframes])


@dataclass(slots=True, kw_only=True, eq=False)
class Subdivision:
    """Pieces (p,) of a boundary: its segments, and the halves requested so far.

    Attributes
    ----------
    coefficients : complex128, shape (n, 2q)
        Coefficients of Φ and Ψ of each keyframe in turn.
    starts, ends : complex128, shape (p,)
    first, last : complex128, shape (p, 2q)
        F and G of each keyframe at both ends.
    epsilon : float64, shape (p, 2q)
        Bound of their distance from the linear interpolants.
    halves : intp, shape (p,)
        Index of the first half; the second one follows. −1 without halves.
    parents : intp, shape (p,)
        Index of the piece that was halved; −1 for a segment.
    loops : intp, shape (p,)
        Loop of the boundary that contains the piece; 0 is the outline.
    """

    span: Span
    coefficients: Complexes
    starts: Complexes
    ends: Complexes
    first: Complexes
    last: Complexes
    epsilon: Floats
    halves: Indices
    parents: Indices
    loops: Indices

    @classmethod
    def of(cls, maps: Sequence[Complexes], boundary: Boundary) -> Self:
        """Start with the segments of the boundary, and maps given as coefficients (n, 2)."""
        span, following = boundary.span, boundary.next_samples
        coefficients = np.hstack(maps)
        values = boundary.derivatives @ span.without_constant(coefficients)
        bending = boundary.third_derivative_kernel @ span.singularity_strengths(coefficients)
        return cls(
            span=span,
            coefficients=coefficients,
            starts=boundary.points,
            ends=boundary.points[following],
            first=values,
            last=values[following],
            epsilon=bending * (boundary.half_lengths**2 / 2)[:, None],
            halves=np.full(len(values), -1),
            parents=np.full(len(values), -1),
            loops=np.searchsorted(boundary.starts, np.arange(len(values)), side="right") - 1,
        )

    def halve(self, which: Indices) -> None:
        """Add the halves of some pieces; the bound on |Φ'''| stays valid in both."""
        new = np.unique(which[self.halves[which] < 0])
        if not len(new):
            return
        middles = (self.starts[new] + self.ends[new]) / 2
        (values,) = self.span.evaluate(self.coefficients, middles, orders=(1,))
        quarter = self.epsilon[new] / 4
        self.halves[new] = len(self.halves) + 2 * np.arange(len(new))
        self.starts = append_alternately(self.starts, self.starts[new], middles)
        self.ends = append_alternately(self.ends, middles, self.ends[new])
        self.first = append_alternately(self.first, self.first[new], values)
        self.last = append_alternately(self.last, values, self.last[new])
        self.epsilon = append_alternately(self.epsilon, quarter, quarter)
        unhalved = np.full(len(new), -1)
        self.halves = append_alternately(self.halves, unhalved, unhalved)
        self.parents = append_alternately(self.parents, new, new)
        self.loops = append_alternately(self.loops, self.loops[new], self.loops[new])

    def derivatives(self, since: int) -> "EndpointValues":
        """Return F and G of all pieces from index `since` on."""
        first, last, epsilon = self.first[since:], self.last[since:], self.epsilon[since:]
        f0, f1, ef = first[:, ::2], last[:, ::2], epsilon[:, ::2]
        g0, g1, eg = first[:, 1::2], last[:, 1::2], epsilon[:, 1::2]
        rounding = ROUNDING * (np.abs(f0) + np.abs(f1))
        return EndpointValues(f0, f1, ef + rounding, g0, g1, eg + rounding)


class EndpointValues(NamedTuple):
    """F and G at both ends of pieces, each (p, q), and their ε."""

    f0: Complexes
    f1: Complexes
    ef: Floats
    g0: Complexes
    g1: Complexes
    eg: Floats

    @property
    def least(self) -> Floats:
        """Lower bound of |F| of the linear interpolants."""
        turn = np.angle(self.f1 * self.f0.conj())
        r: Floats = np.minimum(np.abs(self.f0), np.abs(self.f1)) * np.cos(turn / 2)
        return r

    @property
    def largest(self) -> tuple[Floats, Floats]:
        """The largest |F| and |G| of the linear interpolants."""
        return (
            np.maximum(np.abs(self.f0), np.abs(self.f1)),
            np.maximum(np.abs(self.g0), np.abs(self.g1)),
        )

    def log_modulus(self) -> BoundaryBezier[np.float64]:
        ends = np.log(np.abs(np.stack([self.f0, self.f1], axis=2)))
        return BoundaryBezier(ends, self._errors_of_log())

    def log_change(self) -> BoundaryBezier[np.complex128]:
        """Return the increase of log F from the start of each piece."""
        change = np.log(self.f1 / self.f0)
        return BoundaryBezier(np.stack([0 * change, change], axis=2), self._errors_of_log())

    def _errors_of_log(self) -> Floats:
        r, bend = self.least, np.abs(self.f1 - self.f0) ** 2 / 8
        clear = r > self.ef
        safe = np.where(clear, r, 1.0)
        errors = bend / safe**2 - np.log1p(-np.where(clear, self.ef, 0.0) / safe)
        return _where_clear(clear, errors)

    def nu(self) -> BoundaryBezier[np.complex128]:
        """Return ν up to conjugation."""
        r, bend = self.least, np.abs(self.f1 - self.f0)
        clear = r > self.ef
        safe = np.where(clear, r, 1.0)
        ends = np.stack([self.g0 / self.f0, self.g1 / self.f1], axis=2)
        size = self.largest[1] / safe
        errors = bend * np.abs(self.f0 * self.g1 - self.f1 * self.g0) / (4 * safe**3)
        errors = errors + (self.eg + size * self.ef) / np.where(clear, r - self.ef, 1.0)
        return BoundaryBezier(ends, _where_clear(clear, errors))

    def conj_eta(self) -> BoundaryBezier[np.complex128]:
        middle = (self.f0 * self.g1 + self.f1 * self.g0) / 2
        a, b = self.largest
        return BoundaryBezier(
            np.stack([self.f0 * self.g0, middle, self.f1 * self.g1], axis=2),
            a * self.eg + b * self.ef + self.ef * self.eg,
        )

    def trace(self) -> BoundaryBezier[np.float64]:
        """Return 𝒜, half the trace of the metric tensor."""
        a, b = self.largest
        controls = [
            np.abs(self.f0) ** 2 + np.abs(self.g0) ** 2,
            (self.f0 * self.f1.conj() + self.g0 * self.g1.conj()).real,
            np.abs(self.f1) ** 2 + np.abs(self.g1) ** 2,
        ]
        errors = (2 * a + self.ef) * self.ef + (2 * b + self.eg) * self.eg
        return BoundaryBezier(np.stack(controls, axis=2), errors)

    def conformal(self) -> BoundaryBezier[np.complex128]:
        """Return F."""
        return BoundaryBezier(np.stack([self.f0, self.f1], axis=2), self.ef)

    def anticonformal(self) -> BoundaryBezier[np.complex128]:
        """Return G."""
        return BoundaryBezier(np.stack([self.g0, self.g1], axis=2), self.eg)


def append_alternately(
    values: npt.NDArray[type_], first: npt.NDArray[type_], second: npt.NDArray[type_]
) -> npt.NDArray[type_]:
    """Append entries, alternately from two arrays."""
    both = np.stack([first, second], axis=1).reshape(-1, *values.shape[1:])
    return np.concatenate([values, both])


def _where_clear(clear: Booleans, errors: Floats) -> Floats:
    known: Floats = np.where(clear, errors, np.inf)
    return known
