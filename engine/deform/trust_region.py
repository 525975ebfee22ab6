"""Control of a drag: trust-region radius and barrier weight."""

from cmath import phase, rect
from dataclasses import dataclass, replace
from math import inf, sqrt
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Complexes
from engine.deform.forces.posed_armature import PosedArmature
from engine.deform.handles import Handles, HandleTargets
from engine.deform.model.evaluation import Evaluation
from engine.maps import HarmonicMap

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
    aims, armature = targets.aims, handles.armature
    if armature is not None:
        posed = PosedArmature(armature=armature, positions=jet.shaft_positions, aims=aims)
        aims, is_far = posed.cut_aims(distance)
        leashed = leashed or is_far
    return HandleTargets(positions + cut * pull, near, targets.pulls, aims), leashed


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
