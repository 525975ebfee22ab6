"""Key poses of a motion preset as targets of handles."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from app.document import AppliedMotion, Layer, Spring, Target
from app.rigging import Body
from app.solving.motion_preset.motion_request import MotionRequest
from engine.maps import Bounds

# Weight of standing feet, so that they do not slide: target errors are below 1 % of a step.
FIRM = 1000.0
# Share of the layer's limits that poses may use, since in-betweens may need a little more.
SPENT = 0.97


@dataclass(frozen=True, slots=True, kw_only=True)
class JointKeyPose:
    """Targets of the joints at a frame, by handle id."""

    frame: int
    targets: Mapping[int, Target]


def find_key_poses(
    order: MotionRequest, body: Body, given: AppliedMotion
) -> tuple[tuple[JointKeyPose, ...], frozenset[int]]:
    """Return the key poses of a motion, and the handles that stand on the ground at some time.

    The last key of a repeat is left out, since it equals the first.
    """
    motion, parameters = order.preset, order.parameters
    period = (given.last - given.start) // given.repeat_count
    # Motions with steps have a key at every frame: feet would slide in in-betweens.
    steps = motion.template_for(order.kind).can_travel
    count = period if steps else min(period, motion.keys)
    offsets = [round(number * period / count) for number in range(count)]
    if parameters.travel:
        offsets = [
            turn * period + offset for turn in range(given.repeat_count) for offset in offsets
        ] + [given.repeat_count * period]
    postures = motion.poses_at(body, parameters, [offset / period for offset in offsets])
    standing = frozenset(given.joints[name] for each in postures for name in each.standing)
    return tuple(
        JointKeyPose(
            frame=given.start + offset,
            targets={
                identity: Target(position=posture.places[name], rotation=posture.turns.get(name))
                for name, identity in given.joints.items()
            },
        )
        for offset, posture in zip(offsets, postures, strict=True)
    ), standing


def with_joint_weights(layer: Layer, joints: frozenset[int], feet: frozenset[int]) -> Layer:
    """Return a layer whose poses only the joints hold, standing feet with the largest weight.

    Other handles follow the body like sprung handles.
    """
    handles = tuple(
        replace(each, weight=FIRM) if each.id in feet else each for each in layer.handles
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
