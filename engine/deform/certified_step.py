"""One Newton step that ends in a certified map."""

from dataclasses import dataclass

import numpy as np

from engine.arrays import Floats, Indices, readonly
from engine.deform.model.barrier import interpolate_duals
from engine.deform.model.evaluation import Evaluation
from engine.deform.model.newton import (
    Direction,
    Preconditioner,
    line_search,
    preconditioned_direction,
)
from engine.deform.model.objective import Objective
from engine.maps import Boundary, Certificate, HarmonicMap, LocalBounds, certify_segments

# No point of the shape moves farther (of L) in one step: removed handles make no jump.
FARTHEST = 0.05
# A step whose map is not certified is halved this many times.
HALVINGS = 5
# A shortened step means that a bound is near and the Hessian changes much.
FAR_FROM_BARRIER = 0.7
# Added samples are dropped when they outnumber this part of the shape's own samples.
MOST_ADDED = 0.1


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class CertifiedStep:
    """Outcome of one step.

    Parameters
    ----------
    evaluation : Evaluation
        Of `map`.
    length : float
        Part of the direction that was taken; 0 where no map along it could be certified.
    broken_segments : Indices
        Segments where the first trial map broke a bound.
    preconditioner : Preconditioner or None
        For the next step.
    """

    map: HarmonicMap
    certificate: Certificate
    evaluation: Evaluation
    direction: Direction
    length: float
    broken_segments: Indices
    preconditioner: Preconditioner | None


def take_certified_step(
    objective: Objective,
    jet: Evaluation,
    harmonic_map: HarmonicMap,
    certificate: Certificate,
    *,
    required: LocalBounds,
    preconditioner: Preconditioner | None,
) -> CertifiedStep:
    """Step as far along Newton's direction as the map stays certified within `required`.

    `preconditioner` comes from the step before.
    """
    direction, preconditioner = preconditioned_direction(objective, jet, preconditioner)
    direction = _moderate(direction, objective.boundary)
    value = objective.value(jet)
    start, length, refusals, broken = jet, 1.0, 0, np.empty(0, np.intp)
    while refusals < HALVINGS:
        length, reached = line_search(objective, start, direction, value, length)
        if length == 0:
            break
        tried = harmonic_map.changed(length * direction.phi, length * direction.psi)
        proof, segments, _ = certify_segments(tried, objective.boundary, required)
        if proof.is_certified:
            harmonic_map, certificate, jet = tried, proof, reached
            break
        if refusals == 0:
            broken = segments
        refusals += 1
        length /= 2
    return CertifiedStep(
        map=harmonic_map,
        certificate=certificate,
        evaluation=jet,
        direction=direction,
        length=length if refusals < HALVINGS else 0.0,
        broken_segments=broken,
        preconditioner=preconditioner if refusals == 0 and length > FAR_FROM_BARRIER else None,
    )


def add_samples(
    base: Boundary, boundary: Boundary, duals: Floats, segments: Indices
) -> tuple[Boundary, Floats | None]:
    """Return a boundary with samples added in the segments, and the dual variables for it.

    The barrier then sees the violations that the certificate found between samples. When there are
    too many samples, the base boundary replaces them.
    """
    if len(segments) == 0:
        return boundary, readonly(duals)
    if len(boundary.points) + len(segments) > (1 + MOST_ADDED) * len(base.points):
        return base, None
    between = interpolate_duals(duals, segments, boundary.next_samples[segments])
    return boundary.refined(segments), between


def _moderate(direction: Direction, boundary: Boundary) -> Direction:
    """Return the direction, shortened if it moves the outline too far."""
    coordinates = boundary.vertex_coordinates
    moves = coordinates @ direction.phi + (coordinates @ direction.psi).conj()
    farthest = float(np.abs(moves).max()) / (FARTHEST * boundary.size)
    return direction if farthest <= 1 else direction.scaled(1 / farthest)
