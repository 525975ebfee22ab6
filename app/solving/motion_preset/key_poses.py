"""Key poses of a motion preset as targets of handles."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from app.document import AppliedMotion, Layer, Pose, Spring, Target, find_chains, rest_pose
from app.rigging import Body, Performance, Timing
from app.solving.drag.rig import Rig
from app.solving.motion_preset.motion_request import MotionRequest
from engine.maps import Bounds

RAISED = 0.45  # radians: an upper arm that turns farther leaves the trunk
# Weight of standing feet, so that they do not slide: target errors are below 1 % of a step.
FIRM = 1000.0
# Share of the layer's limits that poses may use, since in-betweens may need a little more.
SPENT = 0.97


@dataclass(frozen=True, slots=True, kw_only=True)
class JointKeyPose:
    """Targets of the joints at a frame, by handle id."""

    frame: int
    targets: Mapping[int, Target]
    # Ways in pixels by which handles were moved by hand, from where the preset leads them.
    shifts: Mapping[int, complex] = field(default_factory=dict)

    def shifted(self, pose: Pose) -> Mapping[int, Target]:
        """Return the targets of a pose of the preset with what was moved by hand."""
        return {
            identity: replace(target, position=target.position + self.shifts[identity], side=None)
            if identity in self.shifts
            else target
            for identity, target in pose.targets.items()
        }


def plan_performance(order: MotionRequest, body: Body, frames: int) -> Performance:
    """Return the motion of a body whose cycle takes a number of frames."""
    motion, parameters = order.preset, order.parameters
    times = motion.key_times(parameters, frames)
    zero = next(offset for offset, phase in times if phase == 0.0)
    shares = sorted((phase, (offset - zero) % frames / frames) for offset, phase in times)
    return motion.perform(body, parameters, Timing((*shares, (1.0, 1.0))))


def find_raised_arms(body: Body, performed: Performance, phases: Iterable[float]) -> list[str]:
    """Return the sides, L and R, of arms that a motion turns far from where they are drawn."""
    poses = [performed.pose_at(phase) for phase in phases]
    raised = []
    for side in "LR":
        bone = f"shoulder.{side}", f"elbow.{side}"
        if all(name in body.joints for name in bone):
            drawn = body.joints[bone[1]] - body.joints[bone[0]]
            turned = [(pose.places[bone[1]] - pose.places[bone[0]]) / drawn for pose in poses]
            if np.abs(np.angle(turned)).max() > RAISED:
                raised.append(side)
    return raised


class Standing(NamedTuple):
    """Handles of feet that stand on the ground at some time, and whether they always do."""

    feet: frozenset[int]
    is_always: bool


def find_key_poses(
    order: MotionRequest, body: Body, given: AppliedMotion
) -> tuple[tuple[JointKeyPose, ...], Standing]:
    """Return the key poses of a motion, and its standing feet.

    The last key of a repeat is left out, since it equals the first.
    """
    motion, parameters = order.preset, order.parameters
    period = (given.last - given.start) // given.repeat_count
    performed = plan_performance(order, body, period)
    times = list(motion.key_times(parameters, period))
    if parameters.travel:
        turns = range(given.repeat_count)
        times = [(turn * period + offset, phase) for turn in turns for offset, phase in times]
        times.append((given.repeat_count * period, times[0][1]))
    postures = [performed.pose_at(phase, offset / period) for offset, phase in times]
    edited = {} if order.edits is None else order.edits.shifts
    stands = frozenset[str]().union(*(each.standing for each in postures))
    standing = Standing(
        frozenset(given.joints[name] for name in stands),
        all(each.standing == stands for each in postures),
    )
    return tuple(
        JointKeyPose(
            frame=given.start + offset,
            targets={
                identity: Target(
                    position=posture.places[name],
                    rotation=posture.turns.get(name),
                    side=posture.sides.get(name),
                )
                for name, identity in given.joints.items()
            },
            shifts=edited.get(number % len(motion.phases), {}),
        )
        for number, ((offset, _), posture) in enumerate(zip(times, postures, strict=True))
    ), standing


def with_joint_weights(layer: Layer, joints: frozenset[int], standing: Standing) -> Layer:
    """Return a layer whose poses only the joints hold, standing feet with the largest weight.

    Other handles follow the body like sprung handles. Joints of a body whose feet always stand are
    locked, so that a root with a target of its own, as a neck that nods, does not carry the body
    along. In a walk legs may be too short for their steps, and the body gives way.
    """
    on_limbs = {each for chain in find_chains(layer.bones) for each in chain.handles[1:]}
    handles = tuple(
        replace(
            each,
            weight=FIRM if each.id in standing.feet else each.weight,
            locked=each.locked or (standing.is_always and each.id in joints - on_limbs),
        )
        for each in layer.handles
    )
    others = [each.id for each in layer.handles if each.id not in joints]
    loose = [each for each in others if layer.spring_of(each) is None]
    springs = (replace(each, enabled=True) for each in layer.springs)
    carried = (Spring(handle=each, frequency=1.0, damping=1.0) for each in loose)
    inside = Bounds(
        k=SPENT * layer.bounds.k,
        sigma_a=layer.bounds.sigma_a**SPENT,
        sigma_b=layer.bounds.sigma_b**SPENT,
    )
    return replace(layer, handles=handles, bounds=inside, tracks=(), springs=(*springs, *carried))


def find_start_pose(rig: Rig, poses: Sequence[Pose], moments: Sequence[JointKeyPose]) -> Pose:
    """Return the pose from which the next key is solved: rest, or the last one of `poses`.

    The roots of its limbs are where the preset has them, not where their legs pulled them. From
    there the body moves as a whole to the next key, and keeps its shape.
    """
    if not poses:
        return rest_pose(rig.layer.domain, rig.layer.handles)
    pose, planned = poses[-1], moments[len(poses) - 1].targets
    limbs = rig.limbs.limbs if rig.limbs is not None else ()
    roots = {limb.chain.root for limb in limbs}.intersection(planned)
    return replace(pose, targets={**pose.targets, **{root: planned[root] for root in roots}})
