"""Proof of in-betweens: boundary × time is subdivided until the bound on every cell is tight.

f_z of an in-between is an exponential: it has no zeros and no winding. The extremes of k, σ_a and
σ_b are therefore on the boundary at every time (Theorem 4 of Chen and Weber 2015). For the linear
blend, a proof of k < 1 excludes zeros of f_z on the boundary at all times. As the keyframes have no
zeros inside, there are none inside at any time. Around holes the same holds for the whole boundary.

The proof is of the in-betweens as they are defined. A drawn in-between differs by rounding, and in
the metric variant by the accuracy of the integral equation.
"""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.arrays import Booleans, Floats, require_kind
from engine.interpolation.enclosures.pieces import Subdivision
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.corrected_cells import CorrectedCellEnclosures
from engine.interpolation.proof.enclosing_cells import CellEnclosures, Cells
from engine.maps import Enclosures

# Cells are cut until the enclosure is this close to an attained value: absolute for k, relative for
# σ_a and σ_b.
TIGHTNESS = 0.0005
LEAST = 0.05  # of σ_a: a smaller σ_b counts as this in the relative tightness
SHORTEST = 2.0**-24  # shorter pieces of time are not cut
DEEPEST = 40
NAMED = 2.0**-8  # longest time reported as unproven without a further cut
MOST_CELLS = 400_000  # enclosed in all
BLOCK = 8192  # cells at a time


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """Proven bounds of the in-betweens of two keyframes, for the closed domain and all times.

    Attributes
    ----------
    k, sigma_a, sigma_b : float
        Upper bounds of k and σ_a, lower bound of σ_b. Without a proof infinite, and 0 for σ_b.
    unproven_times : tuple of (float, float)
        Times in [0, 1] at which a fold is not excluded; empty if no in-between folds.
    not_tight : tuple of (float, float)
        Times at which a bound exceeds the attained value by more than `TIGHTNESS`.
    """

    k: float
    sigma_a: float
    sigma_b: float
    unproven_times: tuple[tuple[float, float], ...]
    not_tight: tuple[tuple[float, float], ...]

    @property
    def is_locally_injective(self) -> bool:
        """Whether every in-between is proven to be locally injective."""
        return self.k < 1 and self.sigma_b > 0


def prove(inbetweens: Inbetweens, time: float | None = None) -> Proof:
    """Enclose the distortion of all in-betweens, or of the frame at `time` in [0, 1] alone.

    Corrected in-betweens need a sampled domain with the boundary samples
    (`SampledDomain.sample_nodes`).
    """
    require_kind(inbetweens, Inbetweens, "the in-betweens to prove")
    keyframes = inbetweens.keyframe_blend.keyframes
    pieces = Subdivision.of([key.map.coefficients for key in keyframes], inbetweens.boundary)
    with np.errstate(over="ignore", invalid="ignore"):
        kind = CorrectedCellEnclosures if inbetweens.corrections else CellEnclosures
        enclosures = kind(inbetweens, pieces)
        cuts = enclosures.cuts if time is None else np.array([time, time])
        return _bisect(pieces, enclosures, cuts)


def _bisect(pieces: Subdivision, enclosures: CellEnclosures, cuts: Floats) -> Proof:
    none = np.array([0.0])
    attained = proven = Enclosures(none, none, none + inf)
    count = len(pieces.halves)
    pending = Cells(
        np.tile(np.arange(count), len(cuts) - 1),
        np.repeat(cuts[:-1], count),
        np.repeat(cuts[1:], count),
    )
    looked_at, unsettled = 0, []
    for depth in range(DEEPEST):
        found = [
            enclosures.of(pending.at(slice(i, i + BLOCK)))
            for i in range(0, len(pending.piece), BLOCK)
        ]
        enclosed = _together([block.enclosed for block in found])
        attained = _worst(attained, _together([block.attained for block in found]))
        tight, unfolded = _are_tight(enclosed, attained), (enclosed.k < 1) & (enclosed.sigma_b > 0)
        by_time = np.concatenate([block.by_time for block in found])
        long = pending.end - pending.start > NAMED
        # The worst value may be attained for a short time only; further cuts in time show it.
        by_time |= tight & long
        loose = ~(tight & (unfolded | ~long))
        unsettled.append(pending.at(~loose & ~unfolded))
        rest = pending.at(loose)
        looked_at += len(pending.piece)
        ends = depth == DEEPEST - 1 or looked_at + 2 * len(rest.piece) > MOST_CELLS
        if ends or not len(rest.piece):
            break
        proven = _worst(proven, Enclosures(*(part[~loose] for part in enclosed)))
        pending = _cut(pieces, rest, by_time[loose] & (rest.end - rest.start > SHORTEST))
    k, sigma_a, sigma_b = (float(part[0]) for part in _worst(proven, enclosed))
    return Proof(
        k=k,
        sigma_a=sigma_a,
        sigma_b=max(sigma_b, 0.0) if k < 1 else 0.0,
        unproven_times=_merged([*unsettled, rest.at(~unfolded[loose])]),
        not_tight=_merged([rest.at(unfolded[loose])]),
    )


def _cut(pieces: Subdivision, chosen: Cells, by_time: Booleans) -> Cells:
    """Halve cells, some in time and the others in place."""
    pieces.halve(chosen.piece[~by_time])
    in_time, in_place = chosen.at(by_time), chosen.at(~by_time)
    middle = (in_time.start + in_time.end) / 2
    half = pieces.halves[in_place.piece]
    return Cells(
        np.concatenate([in_time.piece, in_time.piece, half, half + 1]),
        np.concatenate([in_time.start, middle, in_place.start, in_place.start]),
        np.concatenate([middle, in_time.end, in_place.end, in_place.end]),
    )


def _are_tight(enclosed: Enclosures, attained: Enclosures) -> Booleans:
    """Return which cells exceed the attained extremes by `TIGHTNESS` at most; NaN does not."""
    sigma_a, sigma_b = attained.sigma_a, attained.sigma_b
    tight: Booleans = enclosed.k <= attained.k + TIGHTNESS
    tight &= enclosed.sigma_a <= sigma_a + TIGHTNESS * sigma_a
    tight &= enclosed.sigma_b >= sigma_b - TIGHTNESS * np.maximum(sigma_b, LEAST * sigma_a)
    return tight


def _together(parts: list[Enclosures]) -> Enclosures:
    return Enclosures(*map(np.concatenate, zip(*parts, strict=True)))


def _worst(one: Enclosures, other: Enclosures) -> Enclosures:
    """Return the extremes of both; NaN stays NaN."""
    return Enclosures(
        np.append(one.k, other.k).max(keepdims=True),
        np.append(one.sigma_a, other.sigma_a).max(keepdims=True),
        np.append(one.sigma_b, other.sigma_b).min(keepdims=True),
    )


def _merged(parts: list[Cells]) -> tuple[tuple[float, float], ...]:
    """Return the union of the cells' times as disjoint pieces."""
    starts, ends = (np.concatenate([getattr(p, end) for p in parts]) for end in ("start", "end"))
    order = np.argsort(starts)
    stretches: list[tuple[float, float]] = []
    for start, end in zip(starts[order].tolist(), ends[order].tolist(), strict=True):
        if stretches and start <= stretches[-1][1]:
            stretches[-1] = stretches[-1][0], max(end, stretches[-1][1])
        else:
            stretches.append((start, end))
    return tuple(stretches)
