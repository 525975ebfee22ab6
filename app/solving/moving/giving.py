"""A motion on its way to a layer, key after key, as the window would solve each."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

from app.document import (
    Command,
    Document,
    GivenMotion,
    Keyframe,
    Layer,
    Pose,
    clip_of,
    find_shortfall,
    is_as_given,
    pose_as_drawn,
    scene_commands,
)
from app.errors import LissomError
from app.solving.drag import Drag, Rig, pose_at
from app.solving.moving.moments import JointMoment, held_by, moments_of
from app.solving.moving.order import MotionOrder, body_of, with_handles_at_joints, with_limits
from app.solving.moving.splicing import lead_before, spliced
from engine.geometry.motions import Body

# A pose that is not at rest by then creeps along a limit.
MOST_STEPS = 150
TRIES = 4  # by which the largest one is looked for
TOLD = 3  # joints that are named
WORST = 4  # keys that it is looked for by
SMALLEST = 0.05  # size that parameters may have


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Giving:
    """A motion on its way to a layer.

    Parameters
    ----------
    document : Document
        With handles at the joints, and bones.
    before : Layer
        As it was without.
    order : MotionOrder
    body : Body
    given : GivenMotion
        Without a digest, which is of keys yet to come.
    lead : Pose, optional
        What is shown where the motion blends in.
    wanted : tuple of JointMoment
        Of the keys to be solved; where the last one is the first one again, it is not among them.
    rig : Rig
        Of the joints alone: other handles go where the body carries them.
    poses : tuple of Pose
        Those that are solved.
    """

    document: Document
    before: Layer
    order: MotionOrder
    body: Body
    given: GivenMotion
    lead: Pose | None
    wanted: tuple[JointMoment, ...]
    rig: Rig
    poses: tuple[Pose, ...] = ()
    # How far some joints fall short of where the motion wants them, by their names, and at which
    # frame most; in pixels.
    short: Mapping[str, tuple[float, int]]
    # Between which sizes the largest is looked for that is within reach, and how often it was.
    sizes: tuple[float, float]
    tries: int = 0

    @property
    def is_solved(self) -> bool:
        """Whether every key is solved."""
        return len(self.poses) == len(self.wanted)

    @property
    def is_over(self) -> bool:
        """Whether every key is solved, and a smaller size is known where some are out of reach."""
        return self.is_solved and (not self.short or self.tries == TRIES)

    @property
    def progress(self) -> float:
        """The part of its steps that is done, 0 to 1."""
        return 1.0 if self.is_over else len(self.poses) / (len(self.wanted) + 1)

    @property
    def now(self) -> str:
        """What the next step does, in words."""
        if self.is_solved:
            return "Looking for a size that is within reach"
        return f"Solving pose {len(self.poses) + 1} of {len(self.wanted)}"

    @property
    def fitting(self) -> float | None:
        """The largest smaller size that is within reach, if one was found."""
        return self.sizes[0] if self.tries and self.sizes[0] > 0 else None

    @property
    def notices(self) -> tuple[str, ...]:
        """Which joints are out of reach, and at what size they are not, in words."""
        if not self.short:
            return ()
        worst = sorted(self.short.items(), key=lambda each: -each[1][0])
        told = ", ".join(
            f"{name!r} by {lag:.1f} px (frame {frame})" for name, (lag, frame) in worst[:TOLD]
        )
        if worst[TOLD:]:
            told += f" and {len(worst) - TOLD} more"
        size = self.fitting
        instead = "" if size is None else f"; at size {size:.2f} all is within reach"
        return (f"Some joints fall short of the motion: {told}{instead}",)

    @property
    def moved(self) -> Layer:
        """The layer with the motion, once every key is solved."""
        keys = [
            Keyframe(frame=moment.frame, pose=pose)
            for moment, pose in zip(self.wanted, self.poses, strict=True)
        ]
        given = self.given
        if not given.parameters.travel and given.rounds == 1:
            keys.append(replace(keys[0], frame=given.last))
        if self.lead is not None:
            keys.insert(0, Keyframe(frame=given.first, pose=self.lead))
        until = max((each.last for each in self.replaced), default=given.last)
        return spliced(self.document, self.before.id, keys, given, until)

    @property
    def replaced(self) -> tuple[GivenMotion, ...]:
        """The motion that it takes the place of, as it was given at the same frame."""
        return tuple(
            each
            for each in self.before.motions
            if each.first == self.given.first and is_as_given(self.before, each)
        )

    @property
    def command(self) -> Command:
        """What makes one step of undo of all of it."""
        return scene_commands.give_motion(self.moved, self.given)


def begin_giving(document: Document, identity: int, order: MotionOrder) -> Giving:
    """Return a motion that is on its way to a layer; nothing of it is solved yet.

    Parameters
    ----------
    document : Document
    identity : int
        The id of the layer.
    order : MotionOrder

    Raises
    ------
    LissomError, EngineError
        If the layer cannot be posed, a joint is not on it, or one that the motion needs is not
        there.
    """
    before = document.layer(identity)
    if before.still:
        raise LissomError(f"{before.name!r} stands still: there is no shape on it to be moved.")
    body = body_of(before, order)
    document, joints = with_handles_at_joints(document, identity, body, order)
    document = with_limits(document, identity, order.limits)
    into = document.layer(identity)
    lead_frames = lead_before(before, order.first, document.fps)
    start = order.first + lead_frames
    period = order.ready.frames(order.parameters, document.fps)
    given = GivenMotion(
        motion=order.motion,
        kind=order.kind,
        joints=joints,
        facing=body.facing,
        parameters=order.parameters,
        first=order.first,
        start=start,
        last=start + order.rounds * period,
        rounds=order.rounds,
    )
    lead = None
    if lead_frames:
        lead = pose_at(Rig.of(into), clip_of(document, identity), order.first)
    wanted, standing = moments_of(order, body, given)
    return Giving(
        document=document,
        before=before,
        order=order,
        body=body,
        given=given,
        lead=lead,
        wanted=wanted,
        rig=Rig.of(held_by(into, frozenset(joints.values()), standing)),
        short={},
        sizes=(0.0, order.parameters.size),
    )


def give_on(giving: Giving) -> Giving:
    """Take the next step: one key after the other, then a smaller size; on the worker thread."""
    if giving.is_solved:
        return _smaller(giving)
    moment = giving.wanted[len(giving.poses)]
    layer = giving.rig.layer
    begin = giving.poses[-1] if giving.poses else pose_as_drawn(layer.domain, layer.handles)
    pose = solved(giving.rig, begin, moment)
    names = {identity: name for name, identity in giving.given.joints.items()}
    short = dict(giving.short)
    for identity, lag in shortfalls(giving.rig, pose).items():
        name = names[identity]
        short[name] = max(short.get(name, (0.0, 0)), (lag, moment.frame))
    return replace(giving, poses=(*giving.poses, pose), short=short)


def solved(rig: Rig, begin: Pose, moment: JointMoment) -> Pose:
    """Return the pose that has the joints where a moment wants them, found from another pose."""
    targets = {**begin.targets, **moment.targets}
    return Drag.begin(rig, begin).towards(targets, MOST_STEPS).pose(targets)


def shortfalls(rig: Rig, pose: Pose) -> Mapping[int, float]:
    """Return by how many pixels handles by which a pose is held fall short, if they do."""
    return find_shortfall(rig.layer, pose).lags


def _smaller(giving: Giving) -> Giving:
    """Try the size halfway between one that is within reach and one that is not."""
    reached, short = giving.sizes
    size = max(SMALLEST, (reached + short) / 2)
    order = replace(giving.order, parameters=replace(giving.order.parameters, size=size))
    frames = {frame for _, frame in giving.short.values()}
    worst = [
        (moment, pose)
        for moment, pose in zip(
            moments_of(order, giving.body, giving.given)[0], giving.poses, strict=True
        )
        if moment.frame in frames
    ][:WORST]
    fits = all(
        not shortfalls(giving.rig, solved(giving.rig, pose, moment)) for moment, pose in worst
    )
    sizes = (size, short) if fits else (reached, size)
    return replace(giving, sizes=sizes, tries=giving.tries + 1)
