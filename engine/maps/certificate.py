"""Proof that a harmonic map is locally injective and within its bounds, in the whole domain.

On a segment of the outline F = f_z and G = conj(f_z̄) differ from their linear interpolants by at
most ε = h² max|Φ'''| / 2, with h half the segment's length and |Φ'''| ≤ Σ |dS_j| / (2π d_j²), where
dS_j is the jump of Δφ / Δz at cage vertex j and d_j its distance to the segment. With Δ the angle
between F at both ends, a_i and b_i the absolute values there and r_i = a_i cos(Δ/2), the whole
segment has

    σ_a ≤ max(a_i + b_i) + ε_f + ε_g,
    σ_b ≥ min(r_i − b_i) − ε_f − ε_g,
    k   ≤ max((b_i + ε_g) / (r_i − ε_f))    provided that min r_i > ε_f,

because |F| is at least its component along the bisector of the end values. Then F does not vanish
on the segment and turns by exactly Δ, so that the sum of all Δ is 2π times the winding number of F.
If that is 0, F has no zero in the domain, and the extremes of k, σ_a and σ_b are on the outline
(Theorem 4 of Chen and Weber 2015). Segments whose bounds are not good enough are bisected.

Around holes both hold for the whole boundary, and |Φ'''| also has 2 |a_j| / d³ of each logarithm.
The winding has to be 0 along every loop by itself: a map like 1/z turns a ring inside out without a
fold, but comes from the identity by no deformation, and has no single-valued log f_z.
"""

from dataclasses import dataclass
from math import inf, pi
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, ratio
from engine.errors import EngineError
from engine.maps.boundary import Boundary
from engine.maps.bounds import Limits
from engine.maps.harmonic_map import HarmonicMap
from engine.maps.span import Span

# Segments are bisected until the reported extremes are this close to attained ones.
TIGHTNESS = 0.002
# A segment that is not settled when it is this many times shorter never will be: its map folds, or
# touches a bound to the last digit.
DEEPEST = 14
# A map that needs more than this is far from any certificate.
MOST_BISECTIONS = 20_000
# Relative error of F and G themselves, from rounding; generous.
ROUNDING = 1e-11


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """What is proven about a map, in the closed domain.

    Parameters
    ----------
    k, sigma_a, sigma_b : float
        Enclosures: k and σ_a are nowhere larger, σ_b is nowhere smaller. Where nothing better can
        be proven k is infinite and sigma_b is −sigma_a.
    winding : int or None
        Winding number of f_z along the boundary, the number of its zeros inside; None if f_z
        vanishes, or nearly, on the boundary, or if it winds around holes.
    certified : bool
        The map is locally injective and keeps to the limits that it was tested for.
    limits : Limits or None
        Those limits; None of the identity, which keeps all bounds.
    """

    k: float
    sigma_a: float
    sigma_b: float
    winding: int | None
    certified: bool
    limits: Limits | None = None


def certify(harmonic_map: HarmonicMap, boundary: Boundary, limits: Limits) -> Certificate:
    """Bound the distortion of a map in the whole domain, and test it against `limits`.

    Raises
    ------
    EngineError
        If the map is over another cage.

    Notes
    -----
    Cost: O(m n) for m samples, and n logarithms for each bisected segment. A map within the limits
    by less than the rounding is not certified, nor one whose derivatives overflow; nothing else
    that holds is refused unless a limit is touched within 2⁻¹⁴ of a segment.
    """
    certificate, _ = certify_segments(harmonic_map, boundary, limits)
    return certificate


def certify_segments(
    harmonic_map: HarmonicMap, boundary: Boundary, limits: Limits
) -> tuple[Certificate, Indices]:
    """Certify a map like `certify`, and tell where it is not within the limits.

    Returns
    -------
    Certificate
    Indices
        The segments on which a limit is broken or could not be proven.

    Raises
    ------
    EngineError
        If the map is over another cage.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        coefficients, segments = _measure(harmonic_map, boundary)
        return _bisect(boundary, coefficients, segments, limits)


class Enclosures(NamedTuple):
    """What is proven about each segment between two samples, float64 (m,) each."""

    k: Floats
    sigma_a: Floats
    sigma_b: Floats


def segment_enclosures(harmonic_map: HarmonicMap, boundary: Boundary) -> Enclosures:
    """Bound the distortion on each segment as it is, without bisection.

    Raises
    ------
    EngineError
        If the map is over another cage.
    """
    _, segments = _measure(harmonic_map, boundary)
    return _enclose(segments)[0]


def _measure(harmonic_map: HarmonicMap, boundary: Boundary) -> tuple[Complexes, "_Segments"]:
    """Return φ and ψ (n, 2), and what is known of the map at the samples and between them."""
    span, following = boundary.span, boundary.following
    if not harmonic_map.span.equals(span):
        raise EngineError("The map is over another cage than the outline's samples.")
    coefficients = harmonic_map.coefficients
    values = boundary.derivatives @ span.without_constant(coefficients)
    bending = boundary.bending_kernel @ span.bending(coefficients)
    errors = bending * (boundary.half_lengths**2 / 2)[:, None]
    segments = _Segments(
        starts=boundary.points,
        ends=boundary.points[following],
        first=values,
        last=values[following],
        errors=errors,
        origins=np.arange(len(values)),
    )
    return coefficients, segments


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Segments:
    """Pieces (s,) of the sampled segments `origins`, F and G at their ends (s, 2), ε (s, 2)."""

    starts: Complexes
    ends: Complexes
    first: Complexes
    last: Complexes
    errors: Floats
    origins: Indices

    def halves(self, which: Booleans, span: Span, coefficients: Complexes) -> "_Segments":
        """Return both halves of the chosen segments; the bound on |Φ'''| holds on in each."""
        starts, ends = self.starts[which], self.ends[which]
        first, last = self.first[which], self.last[which]
        middles = (starts + ends) / 2
        (values,) = span.evaluate(coefficients, middles, orders=(1,))
        quarter = self.errors[which] / 4
        return _Segments(
            starts=np.concatenate([starts, middles]),
            ends=np.concatenate([middles, ends]),
            first=np.concatenate([first, values]),
            last=np.concatenate([values, last]),
            errors=np.concatenate([quarter, quarter]),
            origins=np.tile(self.origins[which], 2),
        )


@dataclass(slots=True)
class _Extremes:
    """The largest k and σ_a and the smallest σ_b met so far."""

    k: float = 0.0
    sigma_a: float = 0.0
    sigma_b: float = inf

    def include(self, k: Floats, sigma_a: Floats, sigma_b: Floats) -> None:
        self.k = max(self.k, _or_worst(k.max(initial=0.0), inf))
        self.sigma_a = max(self.sigma_a, _or_worst(sigma_a.max(initial=0.0), inf))
        self.sigma_b = min(self.sigma_b, _or_worst(sigma_b.min(initial=inf), -inf))


def _or_worst(value: float, worst: float) -> float:
    """Return the value, or the worst one in place of NaN, which compares with nothing."""
    return worst if np.isnan(value) else float(value)


def _bisect(
    boundary: Boundary, coefficients: Complexes, segments: _Segments, limits: Limits
) -> tuple[Certificate, Indices]:
    attained, proven = _Extremes(), _Extremes()
    turns, bisections = np.zeros(len(boundary.starts)), 0
    broken: list[Indices] = []
    for depth in range(DEEPEST + 1):
        a, b = np.abs(segments.first[:, 0]), np.abs(segments.first[:, 1])
        attained.include(ratio(b, a), a + b, a - b)
        (k, sigma_a, sigma_b), clear, delta = _enclose(segments)
        # All said positively: what is not a number is neither tight nor within.
        tight = clear & _are_tight(attained, limits, k, sigma_a, sigma_b)
        within = clear & (k <= limits.k) & (sigma_a <= limits.sigma_a) & (sigma_b >= limits.sigma_b)
        count = int(np.count_nonzero(~tight))
        bisections += count
        if count == 0 or depth == DEEPEST or bisections > MOST_BISECTIONS:
            proven.include(k, sigma_a, sigma_b)
            turns += _by_loop(segments, delta, boundary) if clear.all() else inf
            broken.append(segments.origins[~within])
            break
        broken.append(segments.origins[tight & ~within])
        proven.include(k[tight], sigma_a[tight], sigma_b[tight])
        turns += _by_loop(segments, np.where(tight, delta, 0.0), boundary)
        segments = segments.halves(~tight, boundary.span, coefficients)
    return _conclude(proven, turns, limits), np.unique(np.concatenate(broken))


def _by_loop(segments: _Segments, values: Floats, boundary: Boundary) -> Floats:
    """Return the sums over each loop, (1 + holes,)."""
    loop = np.searchsorted(boundary.starts, segments.origins, side="right") - 1
    sums: Floats = np.bincount(loop, values, minlength=len(boundary.starts)).astype(np.float64)
    return sums


def _enclose(segments: _Segments) -> tuple[Enclosures, Booleans, Floats]:
    """Return the enclosures, where F is proven not to vanish, and its angles of turn Δ."""
    a, b = np.abs(segments.first[:, 0]), np.abs(segments.first[:, 1])
    a_last, b_last = np.abs(segments.last[:, 0]), np.abs(segments.last[:, 1])
    delta = np.angle(segments.last[:, 0] * segments.first[:, 0].conj())
    cosine = np.cos(delta / 2)
    r, r_last = a * cosine, a_last * cosine
    error_f = segments.errors[:, 0] + ROUNDING * (a + a_last)
    error_g = segments.errors[:, 1] + ROUNDING * (a + a_last)
    both = error_f + error_g
    enclosures = Enclosures(
        k=np.maximum(ratio(b + error_g, r - error_f), ratio(b_last + error_g, r_last - error_f)),
        sigma_a=np.maximum(a + b, a_last + b_last) + both,
        sigma_b=np.minimum(r - b, r_last - b_last) - both,
    )
    return enclosures, np.minimum(r, r_last) > error_f, delta


def _are_tight(
    attained: _Extremes, limits: Limits, k: Floats, sigma_a: Floats, sigma_b: Floats
) -> Booleans:
    """Tell which enclosures are no worse than the attained extremes or the limits excuse."""
    slack = TIGHTNESS * attained.sigma_a
    k_goal = attained.k + TIGHTNESS
    sigma_a_goal = attained.sigma_a + slack
    sigma_b_goal = attained.sigma_b - slack
    # As long as a limit is kept at all points seen, the enclosure must try to keep it too.
    if attained.k <= limits.k:
        k_goal = min(k_goal, limits.k)
    if attained.sigma_a <= limits.sigma_a:
        sigma_a_goal = min(sigma_a_goal, limits.sigma_a)
    if attained.sigma_b >= limits.sigma_b:
        sigma_b_goal = max(sigma_b_goal, limits.sigma_b)
    tight: Booleans = (k <= k_goal) & (sigma_a <= sigma_a_goal) & (sigma_b >= sigma_b_goal)
    return tight


def _conclude(proven: _Extremes, turns: Floats, limits: Limits) -> Certificate:
    winding = None
    if np.isfinite(turns).all():
        windings = np.round(turns / (2 * pi)).astype(int)
        winding = int(windings.sum())
        # Without zeros inside, but around holes, f_z still has no single-valued logarithm.
        if winding == 0 and windings.any():
            winding = None
    # Zeros of F inside make k infinite there; without k < 1 on the outline σ_b obeys no minimum
    # principle, and only |f_z| − |f_z̄| ≥ −|f_z̄| remains.
    k = proven.k if winding == 0 else inf
    sigma_b = proven.sigma_b if k < 1 else -proven.sigma_a
    injective = k < 1 and sigma_b > 0
    return Certificate(
        k=k,
        sigma_a=proven.sigma_a,
        sigma_b=sigma_b,
        winding=winding,
        certified=injective and limits.allow(k=k, sigma_a=proven.sigma_a, sigma_b=sigma_b),
        limits=limits,
    )
