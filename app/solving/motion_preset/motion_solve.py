"""Solving the keys of a motion preset one by one, as the window does."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from app.document import (
    AppliedMotion,
    Command,
    Document,
    Keyframe,
    Layer,
    MadeKey,
    Pose,
    clip_of,
    is_motion_unedited,
    layer_commands,
    measure_target_errors,
    scene_commands,
)
from app.errors import LissomError
from app.rigging import Body
from app.solving.drag.drag_solver import DragSolver
from app.solving.drag.rig import Rig
from app.solving.drag.shown_pose import fit_shown_pose
from app.solving.motion_preset.body_rig import rig_body
from app.solving.motion_preset.key_poses import (
    JointKeyPose,
    find_key_poses,
    find_raised_arms,
    find_start_pose,
    plan_performance,
    with_joint_weights,
)
from app.solving.motion_preset.limb_cuts import PARTED, find_limb_cuts, part_limbs
from app.solving.motion_preset.misses import describe_misses
from app.solving.motion_preset.motion_request import MotionRequest, find_rest_body
from app.solving.motion_preset.preset_springs import make_springs, with_springs
from app.solving.motion_preset.splicing import count_blend_frames, splice_motion
from app.texts import _
from engine.arrays import Bytes

# Largest number of steps; a pose that needs more moves slowly along a limit.
MOST_STEPS = 150
SIZE_TRIES = 4  # tries in the search for the largest reachable size
WORST = 4  # keys tested in the search
SMALLEST = 0.05  # smallest size of parameters


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class MotionSolve:
    """The state of applying a motion preset to a layer."""

    document: Document  # with handles and bones at the joints
    before: Layer  # the original layer
    request: MotionRequest
    body: Body
    applied: AppliedMotion  # without a digest, since the keys are not yet solved
    blend_pose: Pose | None  # the pose from which the motion blends in
    key_poses: tuple[JointKeyPose, ...]  # to solve, without a last key that equals the first
    rig: Rig  # of the joints only; other handles follow the body
    poses: tuple[Pose, ...] = ()  # the solved poses, as the preset makes them
    edited_poses: tuple[Pose, ...] = ()  # the same with what was changed by hand
    # Largest target error of each joint by name, in pixels, with its frame.
    target_errors: Mapping[str, tuple[float, int]]
    # Bounds of the largest reachable size, and the number of tries.
    size_range: tuple[float, float]
    tries: int = 0
    parted: bool = False  # whether limbs that touch in the drawing were parted

    @property
    def is_solved(self) -> bool:
        """Whether every key is solved."""
        return len(self.poses) == len(self.key_poses)

    @property
    def is_over(self) -> bool:
        """Whether every key is solved and the search for a reachable size is finished."""
        return self.is_solved and (not self.target_errors or self.tries == SIZE_TRIES)

    @property
    def progress(self) -> float:
        """The finished share of the steps, 0 to 1."""
        return 1.0 if self.is_over else len(self.poses) / (len(self.key_poses) + 1)

    @property
    def status_text(self) -> str:
        """Description of the next step."""
        if self.is_solved:
            return _("Finding a reachable size")
        return _("Solving pose {number} of {count}").format(
            number=len(self.poses) + 1, count=len(self.key_poses)
        )

    @property
    def reachable_size(self) -> float | None:
        """The largest reachable size found, if any."""
        return self.size_range[0] if self.tries and self.size_range[0] > 0 else None

    @property
    def notices(self) -> tuple[str, ...]:
        """Notices about parted limbs, unreachable joints, and a reachable size."""
        parted = [_(PARTED)] if self.parted else []
        return (*parted, *describe_misses(self.target_errors, self.reachable_size))

    @property
    def posed_layer(self) -> Layer:
        """The layer with the motion, once every key is solved."""
        given = replace(self.applied, made=self._made_keys)
        keys = self._keys
        if not given.parameters.travel and given.repeat_count == 1:
            keys.append(replace(keys[0], frame=given.last))
        if self.blend_pose is not None:
            keys.insert(0, Keyframe(frame=given.first, pose=self.blend_pose))
        until = max((each.last for each in self.replaced_motions), default=given.last)
        edits = self.request.edits
        has_edits = edits is not None and edits.are_any
        return splice_motion(self.document, self.before.id, keys, given, until, has_edits=has_edits)

    @property
    def _made_keys(self) -> tuple[MadeKey, ...]:
        count = len(self.request.preset.phases)
        return tuple(
            MadeKey(
                offset=moment.frame - self.applied.start,
                targets={i: target.position for i, target in pose.targets.items()},
            )
            for moment, pose in zip(self.key_poses[:count], self.poses[:count], strict=True)
        )

    @property
    def _keys(self) -> list[Keyframe]:
        """The keys of one repeat, with what was changed by hand."""
        edits, count = self.request.edits, len(self.request.preset.phases)
        keys = []
        for number, (moment, pose) in enumerate(
            zip(self.key_poses, self.edited_poses, strict=True)
        ):
            before = None if edits is None else edits.kept.get(number % count)
            if edits is not None and number in edits.deleted:
                continue
            key = Keyframe(frame=moment.frame, pose=pose)
            if before is not None:
                key = replace(before, frame=moment.frame, pose=pose)
            keys.append(key)
        if edits is not None and not self.applied.parameters.travel:
            keys += self._inserted_keys({key.frame for key in keys})
        return sorted(keys, key=lambda key: key.frame)

    def _inserted_keys(self, taken: set[int]) -> list[Keyframe]:
        """Return the keys that were inserted by hand, at their shares of the cycle."""
        edits, given = self.request.edits, self.applied
        period = (given.last - given.start) // given.repeat_count
        keys = []
        for key in () if edits is None else edits.others:
            share = (key.frame - self.request.edited_start) / self.request.edited_period
            frame = given.start + round(share * period)
            if frame not in taken and frame < given.start + period:
                keys.append(replace(key, frame=frame))
                taken.add(frame)
        return keys

    @property
    def replaced_motions(self) -> tuple[AppliedMotion, ...]:
        """Unedited motions of the same first frame, which this one replaces."""
        return tuple(
            each
            for each in self.before.motions
            if each.first == self.applied.first and is_motion_unedited(self.before, each)
        )

    @property
    def command(self) -> Command:
        """The command that applies everything as one undo step."""
        apply = scene_commands.apply_motion(self.posed_layer, self.applied)
        keep = layer_commands.keep_attachments(self.before.id)
        parted = Command(apply.label, lambda document: keep(apply(document)))
        return parted if self.parted else apply


def start_motion_solve(
    document: Document, identity: int, order: MotionRequest, rgba: Bytes | None = None
) -> MotionSolve:
    """Return the initial state of applying a motion preset; no key is solved yet.

    With the picture `rgba`, limbs that touch in the drawing are parted first. Raises a
    `LissomError` or `EngineError` if the layer cannot be posed, or a joint is off it or missing.
    """
    before = document.layer(identity)
    if before.still:
        raise LissomError(
            _("{layer!r} cannot move, because it contains no shape.").format(layer=before.name)
        )
    body = find_rest_body(before, order)
    period = order.preset.frames(order.parameters, document.fps)
    cuts = None
    if rgba is not None:
        arms = find_raised_arms(body, plan_performance(order, body, period), order.preset.phases)
        cuts = find_limb_cuts(before, body, rgba, arms=arms)
    if cuts is not None and rgba is not None:
        document = part_limbs(document, identity, cuts, rgba)
        body = find_rest_body(document.layer(identity), replace(order, joints=cuts.joints))
    document, joints = rig_body(document, identity, body, order.handles)
    lead_frames = count_blend_frames(before, order.first, document.fps)
    start = order.first + lead_frames
    performed = plan_performance(order, body, period)
    given = AppliedMotion(
        motion=order.motion,
        kind=order.kind,
        joints=joints,
        facing=body.facing,
        parameters=order.parameters,
        first=order.first,
        start=start,
        last=start + order.repeat_count * period,
        repeat_count=order.repeat_count,
        stride=performed.stride,
        springs=make_springs(performed.following, joints, period / document.fps),
    )
    edited = order.edits.springs if order.edits is not None else ()
    into = with_springs(document.layer(identity), given, edited)
    document = document.with_layer(into)
    lead = None
    if lead_frames:
        lead = fit_shown_pose(Rig.of(into), clip_of(document, identity), order.first)
    wanted, standing = find_key_poses(order, body, given)
    return MotionSolve(
        document=document,
        before=before,
        request=order,
        body=body,
        applied=given,
        blend_pose=lead,
        key_poses=wanted,
        rig=Rig.of(with_joint_weights(into, frozenset(joints.values()), standing)),
        target_errors={},
        size_range=(0.0, order.parameters.size),
        parted=cuts is not None,
    )


def step_motion_solve(giving: MotionSolve) -> MotionSolve:
    """Solve the next key, or try a smaller size; on the worker thread."""
    if giving.is_solved:
        return _smaller(giving)
    moment = giving.key_poses[len(giving.poses)]
    begin = find_start_pose(giving.rig, giving.poses, giving.key_poses)
    pose = solve_key_pose(giving.rig, begin, moment)
    names = {identity: name for name, identity in giving.applied.joints.items()}
    short = dict(giving.target_errors)
    for identity, lag in find_target_errors(giving.rig, pose).items():
        name = names[identity]
        short[name] = max(short.get(name, (0.0, 0)), (lag, moment.frame))
    edited = pose
    if moment.shifts:
        drag = DragSolver.begin(giving.rig, pose)
        targets, pulled = moment.shifted(pose), moment.shifts.keys()
        edited = drag.step_towards(targets, MOST_STEPS, pulled=pulled).make_pose(targets)
    return replace(
        giving,
        poses=(*giving.poses, pose),
        edited_poses=(*giving.edited_poses, edited),
        target_errors=short,
    )


def solve_key_pose(rig: Rig, begin: Pose, moment: JointKeyPose) -> Pose:
    """Return the pose for the joint targets, solved from another pose."""
    targets = {**begin.targets, **moment.targets}
    for limb in rig.limbs.limbs if rig.limbs is not None else ():
        # Knees follow their feet; a knee with a target of its own would carry a foot that stands.
        for joint in limb.chain.handles[1:-1]:
            if targets[joint].side is not None:
                targets[joint] = replace(begin.targets[joint], side=targets[joint].side)
    return DragSolver.begin(rig, begin).step_towards(targets, MOST_STEPS).make_pose(targets)


def find_target_errors(rig: Rig, pose: Pose) -> Mapping[int, float]:
    """Return the target errors in pixels of handles that miss their targets."""
    return measure_target_errors(rig.layer, pose).errors


def _smaller(giving: MotionSolve) -> MotionSolve:
    """Try the middle between a reachable and an unreachable size."""
    reached, short = giving.size_range
    size = max(SMALLEST, (reached + short) / 2)
    order = replace(giving.request, parameters=replace(giving.request.parameters, size=size))
    frames = {frame for _, frame in giving.target_errors.values()}
    worst = [
        (moment, pose)
        for moment, pose in zip(
            find_key_poses(order, giving.body, giving.applied)[0], giving.poses, strict=True
        )
        if moment.frame in frames
    ][:WORST]
    fits = all(
        not find_target_errors(giving.rig, solve_key_pose(giving.rig, pose, moment))
        for moment, pose in worst
    )
    sizes = (size, short) if fits else (reached, size)
    return replace(giving, size_range=sizes, tries=giving.tries + 1)
