"""Samples added during a search, and the barrier bounds of all samples.

Samples are added where a segment could bulge out farther than a part of the slack at its ends. The
barrier then sees a violation between samples before the certificate finds it. The barrier bounds
lie a little inside the bounds, which leaves the room between samples. A sample that is added in
this room gets a barrier bound of its own beyond it, and keeps it.
"""

from dataclasses import replace

import numpy as np

from engine.arrays import Floats, Indices
from engine.deform.interior_point.search import Search
from engine.deform.model.barrier import MARGIN, BarrierBounds, interpolate_duals
from engine.deform.model.evaluation import Evaluation
from engine.maps import Enclosures

# The barrier bound of a sample beyond the inner bounds lies this part of the remaining way farther
# out.
OUTWARDS = 0.1
# Segments may bulge by this part of the slack at their ends, or of the margin, before they are cut.
BULGE_PER_SLACK = 0.25
BULGE_PER_MARGIN = 0.9
# Most samples, over the shape's own. Segments that did break a bound are exempt: as long as they
# stay whole, no step is certified.
MOST_SAMPLES = 4


def barrier_bounds_around(
    inside: BarrierBounds, limits: BarrierBounds, a: Floats, b: Floats
) -> BarrierBounds:
    """Return the inner bounds, moved out a little where a sample is beyond or next to them."""
    k, sigma_a, sigma_b = b / a, a + b, a - b
    return BarrierBounds(
        k=np.maximum(inside.k, k + OUTWARDS * (limits.k - k)),
        sigma_a=np.maximum(inside.sigma_a, sigma_a + OUTWARDS * (limits.sigma_a - sigma_a)),
        sigma_b=np.minimum(inside.sigma_b, sigma_b + OUTWARDS * (limits.sigma_b - sigma_b)),
    )


def resolve_segments(
    search: Search, jet: Evaluation, enclosures: Enclosures, broken: Indices
) -> Search:
    """Return the search with samples added where segments could bulge, or broke a bound.

    Parameters
    ----------
    jet : Evaluation
        Of the search's map.
    enclosures : Enclosures
        Of the segments of its boundary, for its map.
    broken : Indices
        The segments that broke a bound.
    """
    boundary, limits = search.boundary, BarrierBounds.at(search.limits, search.boundary)
    a, b = jet.a, jet.b
    at_samples = np.array([b / a, a + b, b - a])
    ends = np.maximum(at_samples, at_samples[:, boundary.next_samples])
    proven = np.array([enclosures.k, enclosures.sigma_a, -enclosures.sigma_b])
    limit = np.array([limits.k, limits.sigma_a, -limits.sigma_b])
    limit = np.maximum(limit, limit[:, boundary.next_samples])
    way = np.array([limits.k, limits.sigma_a - 1.0, 1.0 - limits.sigma_b])
    allowed = np.maximum(BULGE_PER_SLACK * (limit - ends), BULGE_PER_MARGIN * MARGIN * np.abs(way))
    # Bulge of each segment, over the allowed one.
    excess = ((proven - ends) / allowed).max(axis=0)
    excess[broken] = np.inf
    most = int(MOST_SAMPLES * np.count_nonzero(boundary.weights))
    free = max(most - len(a), len(broken))
    worst = np.argsort(-excess, kind="stable")[:free]
    segments = np.sort(worst[excess[worst] > 1.0])
    if len(segments) == 0:
        return search
    finer = boundary.refined(segments)
    new = segments + np.arange(len(segments)) + 1
    alone = boundary.span.without_constant(search.map.coefficients)
    f, g = (finer.derivatives[new] @ alone).T
    duals = search.duals
    if duals is not None:
        duals = interpolate_duals(duals, segments, boundary.next_samples[segments])
    old, search = search.bounds, replace(search, boundary=finer, duals=duals)
    inside, outermost = (
        BarrierBounds(*(each[new] for each in walls))
        for walls in (search.level_bounds, BarrierBounds.at(search.limits, finer))
    )
    between = barrier_bounds_around(inside, outermost, np.abs(f), np.abs(g))
    walls = (np.insert(each, segments + 1, its) for each, its in zip(old, between, strict=True))
    return replace(search, bounds=BarrierBounds(*walls))
