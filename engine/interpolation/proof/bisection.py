"""In-betweens proven: the boundary times an interval of time, cut until every cell is tight.

f_z of an in-between has no zeros, being an exponential, and no winding; so the extremes of k, σ_a
and σ_b are on the boundary at every time (Theorem 4 of Chen and Weber 2015). The linear blend has
f_z without zeros on the boundary at all times, where k < 1 is proven, and so none inside: at the
keyframes it has none. Around holes all of that holds for the whole boundary.

The proof is of the in-betweens as they are defined; what is drawn differs from them by rounding,
and with the metric variant by the accuracy of the integral equation.
"""

from dataclasses import dataclass
from math import inf

import numpy as np

from engine.arrays import Booleans, Floats, require_kind
from engine.interpolation.enclosures import Subdivision
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.corrected_cells import CorrectedCellEnclosures
from engine.interpolation.proof.enclosing_cells import CellEnclosures, Cells
from engine.maps import Enclosures

# Cells are cut until the enclosure is this close to what is attained: of k, and as a share of σ_a
# and of σ_b.
TIGHTNESS = 0.0005
LEAST = 0.05  # of σ_a: what σ_b counts as at least there
SHORTEST = 2.0**-24  # pieces of time are not cut below this
DEEPEST = 40
NAMED = 2.0**-8  # how short a stretch of time is that is named as one where something folds
MOST_CELLS = 400_000  # that are looked at
BLOCK = 8192  # cells at a time


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """What is proven of the in-betweens of two keyframes, for the closed domain and all times.

    Parameters
    ----------
    k, sigma_a, sigma_b : float
        k and σ_a are never larger, σ_b is never smaller; infinite, and 0, where nothing is proven.
    unsettled, loose : tuple of (float, float)
        Stretches of time, from 0 to 1: those in which an in-between folds or is not proven not to,
        none if none ever does, and others in which some enclosure is not within `TIGHTNESS` of what
        is attained.
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
    """Enclose the distortion of in-betweens, or of one frame: cut cells until they are tight.

    Parameters
    ----------
    inbetweens : Inbetweens
        With corrections their sites have the samples of the boundary (`Sites.sample_nodes`).
    time : float, optional
        In [0, 1]; the proof is of this frame alone.
    """
    require_kind(inbetweens, Inbetweens, "what is proven")
    keyframes = inbetweens.keyframe_blend.keyframes
    pieces = Subdivision.of([key.map.coefficients for key in keyframes], inbetweens.boundary)
    with np.errstate(over="ignore", invalid="ignore"):
        kind = CorrectedCellEnclosures if inbetweens.corrections else CellEnclosures
        enclosures = kind(inbetweens, pieces)
        cuts = enclosures.cuts if time is None else np.array([time, time])
        return _bisect(pieces, enclosures, cuts)


def _bisect(pieces: Subdivision, enclosures: CellEnclosures, cuts: Floats) -> Proof:
    """Cut cells until they are tight."""
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
        # What is as bad as anywhere may still be so for a short time only.
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
    """Tell which cells are no worse than what is attained anywhere; not a number is not."""
    sigma_a, sigma_b = attained.sigma_a, attained.sigma_b
    tight: Booleans = enclosed.k <= attained.k + TIGHTNESS
    tight &= enclosed.sigma_a <= sigma_a + TIGHTNESS * sigma_a
    tight &= enclosed.sigma_b >= sigma_b - TIGHTNESS * np.maximum(sigma_b, LEAST * sigma_a)
    return tight


def _together(parts: list[Enclosures]) -> Enclosures:
    return Enclosures(*map(np.concatenate, zip(*parts, strict=True)))


def _worst(one: Enclosures, other: Enclosures) -> Enclosures:
    """Return the extremes of both; not a number stays so."""
    return Enclosures(
        np.append(one.k, other.k).max(keepdims=True),
        np.append(one.sigma_a, other.sigma_a).max(keepdims=True),
        np.append(one.sigma_b, other.sigma_b).min(keepdims=True),
    )


def _merged(parts: list[Cells]) -> tuple[tuple[float, float], ...]:
    """Return the stretches of time that cells cover together."""
    starts, ends = (np.concatenate([getattr(p, end) for p in parts]) for end in ("start", "end"))
    order = np.argsort(starts)
    stretches: list[tuple[float, float]] = []
    for start, end in zip(starts[order].tolist(), ends[order].tolist(), strict=True):
        if stretches and start <= stretches[-1][1]:
            stretches[-1] = stretches[-1][0], max(end, stretches[-1][1])
        else:
            stretches.append((start, end))
    return tuple(stretches)
