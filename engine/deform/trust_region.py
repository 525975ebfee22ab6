"""Control of a drag: trust-region radius, barrier weight, and position of the barrier."""

from cmath import phase, rect
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import inf, sqrt
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes, Floats
from engine.deform.handles import Handles, HandleTargets
from engine.deform.model.barrier import MARGIN, BarrierBounds
from engine.deform.model.evaluation import Evaluation
from engine.maps import Boundary, Certificate, HarmonicMap, LocalBounds, segment_enclosures

# Trust region: a handle is pulled towards a point at most this far (of L) ahead of it, and turned
# by at most this angle. Farther away the quadratic model is useless. Both times the present radius.
STEP_RADIUS = 0.02
TURN_RADIUS = 0.2
# Least relative radius.
SMALLEST_RADIUS = 0.1
# Handles whose correlation with their targets is weaker have no common rotation.
CORRELATED = 0.5
# Weight of the barrier at the start, and at most.
FIRST_WEIGHT = 1e-2
MOST_WEIGHT = 100.0
# Least weight while handles move, and when they have arrived.
LEAST_MOVING = 1e-3
LEAST_RESTING = 1e-6
# Factors of the weight after a step that the bounds cut short, and after a full one.
RAISE = 4.0
LOWER = 0.5
# Lengths of steps that the bounds have cut short, and that they have not.
SHORT = 0.3
FULL = 0.7
# A drag makes progress when its target error (over L) falls this much below its least value so far.
PROGRESS = 1e-3
# After so many steps without progress the drag is at rest.
IDLE_AT_REST = 50
# The barrier stands beyond every sample by this much, or this part of sigma_a. A map may be at its
# limits to the last digit, and the barrier's Hessian has a root only where there is slack.
LEAST_SLACK = 1e-10
# A step leaves at least this part of the slack between the barrier and the map.
KEPT = 0.1
# While a map is outside its bounds the limits follow it at this relative distance.
FOLLOW = 0.005
# Of k, σ_a and σ_b.
WORST = (np.maximum, np.maximum, np.minimum)
# Maps stay this far (of the way to the identity) inside their bounds. A later certificate, from
# other samples or on another machine, then finds them within.
ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class BarrierSchedule:
    """Barrier weight and relative trust-region radius, adapted to the outcome of the steps.

    Parameters
    ----------
    weight : float
        Of the barrier: raised after a step that was cut short, lowered after a full one.
    step_radius : float
        Relative radius: lowered after a step that was cut short, raised after a full one.
    smallest_error : float
        Smallest target error since the targets changed.
    idle_steps : int
        Steps without progress.
    """

    weight: float = FIRST_WEIGHT
    step_radius: float = 1.0
    smallest_error: float = inf
    idle_steps: int = 0

    def for_new_targets(self) -> Self:
        """Return the schedule with progress reset."""
        return replace(self, smallest_error=inf, idle_steps=0)

    def after_step(self, *, length: float, error: float, moving: bool) -> Self:
        """Return the schedule of the next step.

        Parameters
        ----------
        length : float
            Part of the step that was taken.
        error : float
            Target error of the drag, over L.
        moving : bool
            Whether the handles are still far from their targets.
        """
        progress = error < self.smallest_error - PROGRESS
        weight, leash = self.weight, self.step_radius
        if length < SHORT:
            weight = min(RAISE * weight, MOST_WEIGHT)
            leash = max(leash / 2, SMALLEST_RADIUS)
        elif length > FULL:
            least = LEAST_MOVING if moving else LEAST_RESTING
            weight, leash = max(LOWER * weight, least), min(2 * leash, 1.0)
        return replace(
            self,
            weight=weight,
            step_radius=leash,
            smallest_error=error if progress else self.smallest_error,
            idle_steps=0 if progress else self.idle_steps + 1,
        )

    @property
    def is_at_rest(self) -> bool:
        """Whether more steps would most likely gain nothing."""
        return self.idle_steps >= IDLE_AT_REST


def cut_to_radius(
    handles: Handles, size: float, leash: float, jet: Evaluation, targets: HandleTargets
) -> tuple[HandleTargets, bool]:
    """Return the targets cut to a part of the trust region, and whether the cut changed any.

    The common rotation of all handles is applied first: straight ways to a target that is mainly a
    rotation would squeeze the shape.
    """
    distance, most = STEP_RADIUS * size * leash, TURN_RADIUS * leash
    positions = _rotated_toward(handles, jet.positions, targets.positions, most)
    pull = targets.positions - positions
    cut = distance / np.maximum(np.abs(pull), distance)
    near, turning = targets.rotations.copy(), np.isfinite(targets.rotations)
    leashed = bool((cut < 1.0).any())
    if turning.any():
        now = np.angle(jet.fz[turning])
        turn = np.angle(np.exp(1j * (targets.rotations[turning] - now)))
        near[turning] = now + np.minimum(np.maximum(turn, -most), most)
        leashed = leashed or bool(np.abs(turn).max() > most)
    return HandleTargets(
        positions + cut * pull, near, targets.pulls, targets.distance_constraints
    ), leashed


def align_rigidly(
    handles: Handles, targets: HandleTargets, at_rest: HarmonicMap, turn: float = 0.0
) -> HarmonicMap:
    """Return the rigid motion that brings the shape at rest nearest to the targets.

    It is turned by a further angle `turn` around the centre of the targets.
    """
    common = fit_rigid_motion(handles, handles.points, targets.positions)
    factor = complex(np.exp(1j * (common.angle + turn)))
    return HarmonicMap.similarity(
        at_rest.cage,
        at_rest.holes,
        factor=factor,
        shift=common.target_centre - factor * common.centre,
    )


def _rotated_toward(
    handles: Handles, positions: Complexes, targets: Complexes, most: float
) -> Complexes:
    """Return the positions turned as a whole towards the targets, up to an angle."""
    if len(positions) == 0:
        return positions
    common = fit_rigid_motion(handles, positions, targets)
    turn = rect(1.0, min(max(common.angle, -most), most))
    turned: Complexes = common.centre + turn * (positions - common.centre)
    return turned


class RigidFit(NamedTuple):
    """The rigid motion that brings points nearest to their targets (Procrustes).

    Parameters
    ----------
    angle : float
        Between both; 0 where the correlation is weak.
    correlation : float
        How much of the way to the targets a rotation leads, 0 to 1.
    misfit : float
        Root mean square distance from the targets after the best motion.
    """

    centre: complex
    target_centre: complex
    angle: float
    correlation: float
    misfit: float


def fit_rigid_motion(handles: Handles, positions: Complexes, targets: Complexes) -> RigidFit:
    """Return the common rigid motion of all handles, weighted by stiffness."""
    weights = handles.stiffness / handles.stiffness.sum()
    centre, wanted = complex(weights @ positions), complex(weights @ targets)
    from_centre, from_wanted = positions - centre, targets - wanted
    product = complex(weights @ (from_centre.conj() * from_wanted))
    lengths, others = np.abs(from_centre), np.abs(from_wanted)
    scale = float(weights @ (lengths * others))
    squares = float(weights @ (lengths * lengths + others * others))
    return RigidFit(
        centre,
        wanted,
        angle=phase(product) if abs(product) > CORRELATED * scale else 0.0,
        correlation=abs(product) / scale if scale > 0 else 1.0,
        misfit=sqrt(max(squares - 2 * abs(product), 0.0)),
    )


def widen_limits(
    proven: Certificate | LocalBounds, bounds: LocalBounds, *, room: float = FOLLOW
) -> LocalBounds:
    """Return the bounds, widened to the proven distortions.

    The part `room` of the remaining slack is added.
    """
    return LocalBounds(
        k=np.maximum(bounds.k, proven.k + room * (1 - proven.k)),
        sigma_a=np.maximum(bounds.sigma_a, proven.sigma_a * (1 + room)),
        sigma_b=np.minimum(bounds.sigma_b, proven.sigma_b * (1 - room)),
    )


def proven_around(
    harmonic_map: HarmonicMap, certificate: Certificate, boundary: Boundary
) -> LocalBounds:
    """Return proven bounds around each sample of a map; without bisection, except for the worst."""
    of_segments = segment_enclosures(harmonic_map, boundary)
    k, sigma_a, sigma_b = (np.empty_like(each) for each in of_segments)
    for at, its, worst in zip((k, sigma_a, sigma_b), of_segments, WORST, strict=True):
        at[boundary.next_samples] = its
        worst(at, its, out=at)
    return LocalBounds(
        k=np.minimum(k, certificate.k),
        sigma_a=np.minimum(sigma_a, certificate.sigma_a),
        sigma_b=np.maximum(sigma_b, certificate.sigma_b),
    )


def tighten_limits(
    bounds: LocalBounds, before: LocalBounds, boundary: Boundary, reached: Floats
) -> LocalBounds:
    """Return the bounds, or limits that close in on a map that is outside the bounds.

    `reached` are the map's distortions (3, m).
    """
    outside = reached >= stack_limits(bounds.at(boundary))
    if not outside.any():
        return bounds
    # Where no sample is outside, no value bounds the worst from below.
    worst_k, worst_a, negative_b = np.where(outside, reached, -np.inf).max(axis=1).tolist()
    near = LocalBounds(
        k=1 - (1 - FOLLOW) * (1 - worst_k),
        sigma_a=worst_a * (1 + FOLLOW),
        sigma_b=-negative_b * (1 - FOLLOW),
    )
    return LocalBounds(
        k=np.maximum(bounds.k, np.minimum(before.k, near.k)),
        sigma_a=np.maximum(bounds.sigma_a, np.minimum(before.sigma_a, near.sigma_a)),
        sigma_b=np.minimum(bounds.sigma_b, np.maximum(before.sigma_b, near.sigma_b)),
    )


def place_barrier_bounds(
    limits: LocalBounds, boundary: Boundary, reached: Floats, certificate: Certificate
) -> tuple[BarrierBounds, LocalBounds]:
    """Return the barrier bounds of the samples, and the bounds of the whole next map.

    `reached` are the map's distortions (3, m).
    """
    at, least = stack_limits(limits.at(boundary)), np.full((3, 1), LEAST_SLACK)
    inner = stack_limits(limits.towards_identity(MARGIN).at(boundary))
    least[1:] *= reached[1].max()
    # A map may start between the barrier and the limits.
    walls = np.maximum(inner, reached + np.maximum((at - reached) / 4, least))
    beyond = walls - at
    # Between its samples the present map may have less slack than a step must leave.
    required = beyond - KEPT * (walls - reached), beyond
    widened = (_shifted(limits, each.max(axis=1).tolist()) for each in required)
    proven, found = proven_at(certificate, reached), limits
    for asked in chain(widened, (limits.towards_identity(ROUNDING),)):
        if limits.include(asked) and (proven <= stack_limits(asked.at(boundary))).all():
            found = asked
            break
    k, sigma_a, negative_b = walls
    return BarrierBounds(k, sigma_a, -negative_b), found


def _shifted(limits: LocalBounds, beyond: Sequence[float]) -> LocalBounds:
    """Return limits that are wider by these amounts, in rows of `stack_limits`."""
    more, longer, shorter = beyond
    return LocalBounds(
        k=limits.k + more, sigma_a=limits.sigma_a + longer, sigma_b=limits.sigma_b - shorter
    )


def proven_at(certificate: Certificate, reached: Floats) -> Floats:
    """Estimate the proven distortions around samples from the samples' distortions, (3, m) each.

    The worst proven value exceeds the worst sample by some amount; each sample gets the same
    amount.
    """
    worst = reached.max(axis=1, keepdims=True)
    proven: Floats = stack_limits(certificate) + (reached - worst)
    return proven


def stack_limits(limits: Certificate | LocalBounds) -> Floats:
    """Return k, σ_a and −σ_b, all upper limits, as rows (3, 1) or (3, m)."""
    rows = np.array([limits.k, limits.sigma_a, np.negative(limits.sigma_b)], np.float64)
    return rows.reshape(3, -1)


def stack_distortions(a: Floats, b: Floats) -> Floats:
    """Return the rows (3, m) k, σ_a, −σ_b of |f_z| and |f_z̄| (m,)."""
    return np.array([b / a, a + b, b - a])
