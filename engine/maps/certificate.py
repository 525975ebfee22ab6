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

Around holes both statements hold for the whole boundary, and |Φ'''| also has 2 |a_j| / d³ of each
logarithm. The winding has to be 0 along each loop separately. A map like 1/z turns a ring inside
out without a fold, but no deformation leads to it from the identity. Its log f_z is not
single-valued.
"""

from dataclasses import dataclass, replace
from math import inf, pi
from typing import NamedTuple

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices, ratio, require_kind
from engine.errors import EngineError
from engine.maps.boundary import Boundary
from engine.maps.bounds import LocalBounds
from engine.maps.harmonic_map import HarmonicMap
from engine.maps.span import Span

# Segments are bisected until the reported extremes are this close to attained values.
TIGHTNESS = 0.002
# A segment that is still open when it is this many times shorter stays open: its map folds, or
# touches a bound to the last digit.
FINEST = 1 << 14
# A map that needs more bisections than this is far from any certificate.
MOST_BISECTED = 20_000
# Fewer segments, counted with the functions of the span, are cut into four at once: that costs less
# than another round.
FEW = 4096
OTHER_SPAN = (
    "The map and the samples of the outline have different cages; use samples of the map's own "
    "cage."
)
# Relative error of F and G themselves, from rounding; generous.
ROUNDING = 1e-11


@dataclass(frozen=True, slots=True, kw_only=True)
class Certificate:
    """Proven bounds on a map's distortion, in the closed domain.

    Parameters
    ----------
    k, sigma_a, sigma_b : float
        Enclosures: k and σ_a are nowhere larger, σ_b is nowhere smaller. Where nothing better can
        be proven k is infinite and sigma_b is −sigma_a.
    winding : int or None
        Winding number of f_z along the boundary, the number of its zeros inside; None if f_z
        vanishes, or nearly, on the boundary, or if it winds around holes.
    is_certified : bool
        The map is locally injective and keeps its limits.
    limits : LocalBounds or None
        The limits of the test; None for the identity, which keeps all bounds.
    """

    k: float
    sigma_a: float
    sigma_b: float
    winding: int | None
    is_certified: bool
    limits: LocalBounds | None = None


def certify(harmonic_map: HarmonicMap, boundary: Boundary, limits: LocalBounds) -> Certificate:
    """Bound the distortion of a map in the whole domain, and test it against `limits`.

    Raises
    ------
    EngineError
        If the map has another cage.

    Notes
    -----
    Cost: O(m n) for m samples, and n logarithms for each bisected segment. A map is not certified
    if its slack is below the rounding, or its derivatives overflow, or it touches a limit within
    2⁻¹⁴ of a segment. All other maps within the limits are certified.
    """
    require_kind(harmonic_map, HarmonicMap, "the map")
    certificate, _, _ = certify_segments(harmonic_map, boundary, limits)
    return certificate


def certify_segments(
    harmonic_map: HarmonicMap, boundary: Boundary, limits: LocalBounds
) -> tuple[Certificate, Indices, "Enclosures"]:
    """Certify a map like `certify`, and report on its segments.

    Returns the certificate, the segments on which a limit is broken or could not be proven, and the
    `segment_enclosures` of all segments.

    Raises
    ------
    EngineError
        If the map has another cage.
    """
    with np.errstate(over="ignore", invalid="ignore"):
        return _bisect(boundary, _measure(harmonic_map, boundary), limits)


class Enclosures(NamedTuple):
    """Proven bounds on each segment between two samples, float64 (m,) each."""

    k: Floats
    sigma_a: Floats
    sigma_b: Floats


def segment_enclosures(harmonic_map: HarmonicMap, boundary: Boundary) -> Enclosures:
    """Bound the distortion on each segment, without bisection.

    Raises
    ------
    EngineError
        If the map has another cage.
    """
    segments = _measure(harmonic_map, boundary)
    (k, sigma_a, negative_sigma_b), _, _ = _enclose(segments)
    return Enclosures(k, sigma_a, -negative_sigma_b)


def _measure(harmonic_map: HarmonicMap, boundary: Boundary) -> "_Segments":
    """Return the map's values at the samples and its error bounds between them."""
    span = boundary.span
    if not harmonic_map.span.equals(span):
        raise EngineError(OTHER_SPAN)
    coefficients = harmonic_map.coefficients
    starts = np.empty((3, len(boundary.points)), np.complex128)
    starts[0] = boundary.points
    starts[1:] = (boundary.derivatives @ span.without_constant(coefficients)).T
    bending = boundary.third_derivative_kernel @ span.singularity_strengths(coefficients)
    return _Segments(
        nodes=np.stack([starts, starts[:, boundary.next_samples]], axis=1),
        errors=bending.T * (boundary.half_lengths**2 / 2),
        origins=np.arange(len(boundary.points)),
        span=span,
        coefficients=coefficients,
    )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Segments:
    """Segments of a map.

    `nodes` are z, F and G at both ends, complex128 (3, 2, s); `errors` ε_f and ε_g, float64 (2, s).
    """

    nodes: Complexes
    errors: Floats
    origins: Indices
    span: Span
    coefficients: Complexes

    @property
    def ends(self) -> Complexes:
        """F and G at both ends."""
        ends: Complexes = self.nodes[1:]
        return ends

    def divided(self, which: Booleans, /) -> tuple["_Segments", int]:
        """Return the parts of the chosen segments; the parts keep the segment's bound on |Φ'''|."""
        ends, origins = self.nodes[:, :, which], self.origins[which]
        parts = 4 if len(origins) * len(self.span) < FEW else 2
        share = (np.arange(1, parts) / parts)[:, None]
        nodes = np.empty((3, parts + 1, len(origins)), np.complex128)
        nodes[:, 0], nodes[:, parts] = ends[:, 0], ends[:, 1]
        nodes[0, 1:parts] = ends[0, 0] + share * (ends[0, 1] - ends[0, 0])
        (values,) = self.span.evaluate(self.coefficients, nodes[0, 1:parts].ravel(), orders=(1,))
        nodes[1:, 1:parts] = values.T.reshape(2, parts - 1, -1)
        divided = replace(
            self,
            nodes=np.stack([nodes[:, :-1], nodes[:, 1:]], axis=1).reshape(3, 2, -1),
            errors=np.tile(self.errors[:, which] / parts**2, parts),
            origins=np.tile(origins, parts),
        )
        return divided, parts


def _bisect(
    boundary: Boundary, segments: "_Segments", limits: LocalBounds
) -> tuple[Certificate, Indices, Enclosures]:
    # If the limits are equal for all samples one column suffices, at less cost.
    at = limits.at(boundary)
    limit = np.atleast_2d(np.array([at.k, at.sigma_a, np.negative(at.sigma_b)]).T).T
    if limit.shape[1] > 1:
        limit = np.maximum(limit, limit[:, boundary.next_samples])
    attained, proven = np.full((2, 3), -inf)
    kept = np.ones(3, dtype=bool)
    turned, bisected, shorter = np.zeros(len(boundary.points)), 0, 1
    broken: list[Indices] = []
    worst, clear, delta = _enclose(segments)
    enclosures = Enclosures(worst[0], worst[1], -worst[2])
    while True:
        distortions = _distortions(*np.abs(segments.ends[:, 0]))
        its = limit[:, segments.origins] if limit.shape[1] > 1 else limit
        attained = _largest(attained, distortions)
        kept &= (distortions <= its).all(axis=1)
        # Required tightness of enclosures. As long as all points seen keep a limit, bisection goes
        # on until the enclosures keep it too.
        goal = (attained + TIGHTNESS * np.array([1.0, attained[1], attained[1]]))[:, None]
        goal = np.where(kept[:, None], np.minimum(goal, its), goal)
        # Written as positive conditions, so that NaN is neither tight nor within.
        tight = clear & (worst <= goal).all(axis=0)
        within = clear & (worst <= its).all(axis=0)
        loose = ~tight
        count = int(np.count_nonzero(loose))
        bisected += count
        if count == 0 or shorter >= FINEST or bisected > MOST_BISECTED:
            np.add.at(turned, segments.origins, np.where(clear, delta, inf))
            broken.append(segments.origins[~within])
            proven = _largest(proven, worst)
            break
        np.add.at(turned, segments.origins[tight], delta[tight])
        broken.append(segments.origins[tight & ~within])
        proven = _largest(proven, worst[:, tight])
        segments, parts = segments.divided(loose)
        shorter *= parts
        worst, clear, delta = _enclose(segments)
    turns = np.add.reduceat(turned, boundary.starts)
    segments_broken = np.unique(np.concatenate(broken))
    certificate = _conclude(proven, turns, limits, keeps=len(segments_broken) == 0)
    return certificate, segments_broken, enclosures


def _largest(before: Floats, distortions: Floats) -> Floats:
    """Return the largest (3,) of earlier distortions and further ones (3, s); infinity for NaN."""
    largest: Floats = np.maximum(before, distortions.max(axis=1, initial=-inf))
    largest[np.isnan(largest)] = inf
    return largest


def _distortions(a: Floats, b: Floats) -> Floats:
    """Return k, σ_a and −σ_b (3, m), all bounded above, of |f_z| and |f_z̄| (m,)."""
    return np.array([ratio(b, a), a + b, b - a])


def _enclose(segments: "_Segments") -> tuple[Floats, Booleans, Floats]:
    """Return the enclosures (3, s), where F is proven not to vanish, and its rotation angles Δ."""
    (start, end), _ = segments.ends
    a, b = np.abs(segments.ends)
    delta = np.angle(end * start.conj())
    r = a * np.cos(delta / 2)
    error_f, error_g = segments.errors + ROUNDING * (a[0] + a[1])
    least, both = r - error_f, error_f + error_g
    of_ends = np.array([ratio(b + error_g, least), a + b + both, b - r + both])
    return of_ends.max(axis=1), least.min(axis=0) > 0, delta


def _conclude(proven: Floats, turns: Floats, limits: LocalBounds, *, keeps: bool) -> Certificate:
    winding = None
    if np.isfinite(turns).all():
        windings = np.round(turns / (2 * pi)).astype(int)
        winding = int(windings.sum())
        # Without zeros inside, but with winding around holes, f_z has no single-valued logarithm.
        if winding == 0 and windings.any():
            winding = None
    # Zeros of F inside make k infinite there; without k < 1 on the outline σ_b obeys no minimum
    # principle, and only |f_z| − |f_z̄| ≥ −|f_z̄| remains.
    largest_k, sigma_a, negative_sigma_b = proven.tolist()
    k = largest_k if winding == 0 else inf
    sigma_b = -negative_sigma_b if k < 1 else -sigma_a
    injective = k < 1 and sigma_b > 0
    return Certificate(
        k=k,
        sigma_a=sigma_a,
        sigma_b=sigma_b,
        winding=winding,
        is_certified=injective and keeps,
        limits=limits,
    )
