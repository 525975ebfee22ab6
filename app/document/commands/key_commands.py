"""Commands on keys: posing, inserting, and moving them about in time."""

from collections.abc import Callable, Collection, Iterable, Sequence
from dataclasses import replace

from app.document.commands import keys_in_time
from app.document.commands.command import figure_command
from app.document.figure import Figure
from app.document.keyframe import Keyframe, Pose
from app.document.layering import moved_in_time
from app.document.timing import LINEAR, Cycle, Easing, Passing
from app.errors import LissomError


@figure_command("Pose")
def pose_key(figure: Figure, frame: int, pose: Pose) -> Figure:
    """Give the key at a frame another pose."""
    return exchange(figure, {frame: replace(figure.key(frame), pose=pose)})


@figure_command("Insert key")
def insert_key(figure: Figure, frame: int, pose: Pose, *, easing: Easing = LINEAR) -> Figure:
    """Insert a key at a frame that has none.

    A key that divides an interval takes its easing. Ways that are new get `easing`: that from a
    new first or last key, and that from the key that was last, unless it was given one. The
    animation grows where the frame lies beyond its ends; so it does in all commands here.
    """
    return _inserted(figure, frame, pose, easing)


@figure_command("Paste pose")
def put_pose(figure: Figure, frame: int, pose: Pose, easing: Easing) -> Figure:
    """Give the key at a frame a pose; where there is none, insert one."""
    if frame not in figure.key_frames:
        return _inserted(figure, frame, pose, easing)
    old = figure.key(frame)
    return figure if old.pose is pose else exchange(figure, {frame: replace(old, pose=pose)})


@figure_command("Paste keys")
def put_keys(figure: Figure, keys: Sequence[Keyframe]) -> Figure:
    """Put keys at their frames, where they replace those that are there."""
    return _with_keys(figure, keys_in_time.put(figure.keys, keys))


@figure_command("Move keys")
def move_keys(figure: Figure, frames: Collection[int], by: int) -> Figure:
    """Move the keys at some frames by a number of frames, and what repeats with all of its keys."""
    return _with_keys(
        figure,
        keys_in_time.moved(figure.keys, frames, by),
        _carried(figure, frames, lambda frame: frame + by),
    )


@figure_command("Copy keys")
def copy_keys(figure: Figure, frames: Collection[int], by: int) -> Figure:
    """Repeat the keys at some frames a number of frames later, or earlier."""
    return _with_keys(figure, keys_in_time.copied(figure.keys, frames, by))


@figure_command("Delete keys")
def delete_keys(figure: Figure, frames: Collection[int]) -> Figure:
    """Delete the keys at some frames; one key must remain. What has no keys repeats no longer."""
    keys = keys_in_time.without(figure.keys, frames)
    if not keys:
        raise LissomError("An animation has at least one key; pose the last one instead.")
    kept = {key.frame for key in keys}
    gone = {cycle for cycle in figure.cycles if not any(map(cycle.has, kept))}
    gone &= {cycle for cycle in figure.cycles if any(map(cycle.has, frames))}
    return _with_keys(figure, keys, tuple(each for each in figure.cycles if each not in gone))


@figure_command("Reverse keys")
def reverse_keys(
    figure: Figure, frames: Collection[int], span: tuple[int, int] | None = None
) -> Figure:
    """Let the keys at some frames, and the motion between them, run backwards.

    Parameters
    ----------
    frames : collection of int
    span : tuple of int, optional
        The first and the last frame of what runs backwards, where other figures do so together with
        this one; by default those of the keys.
    """
    return _with_keys(figure, keys_in_time.backwards(figure.keys, frames, span))


@figure_command("Scale time of keys")
def scale_keys(
    figure: Figure, frames: Collection[int], factor: float, first: int | None = None
) -> Figure:
    """Move the keys at some frames apart or together in time.

    Parameters
    ----------
    frames : collection of int
    factor : float
    first : int, optional
        The frame that stays; by default that of the first key.
    """
    keys, stays = keys_in_time.spread(figure.keys, frames, factor, first), first
    if stays is None:
        stays = min(frames, default=0)

    def to(frame: int) -> int:
        return keys_in_time.scaled(frame, stays, factor)

    return _with_keys(figure, keys, _carried(figure, frames, to))


@figure_command("Make last key equal first")
def match_ends(figure: Figure) -> Figure:
    """Give the last key the pose of the first one, so that a loop has no jump."""
    first, last = figure.keys[0], figure.keys[-1]
    if first is last:
        raise LissomError("A loop needs two keys; insert a second one first.")
    if first.pose is last.pose:
        return figure
    return exchange(figure, {last.frame: replace(last, pose=first.pose)})


@figure_command("Set easing")
def set_easing(figure: Figure, frames: Collection[int], easing: Easing) -> Figure:
    """Set how time runs from the keys at some frames to the next ones."""
    return _with_keys(figure, keys_in_time.eased(figure.keys, frames, easing))


@figure_command("Set passing")
def set_passing(figure: Figure, frames: Collection[int], passing: Passing) -> Figure:
    """Set how the motion passes the keys at some frames; one that held its pose does no longer."""
    return _with_keys(figure, keys_in_time.passed(figure.keys, frames, passing))


@figure_command("Set turns")
def set_turns(figure: Figure, frames: Collection[int], turns: int) -> Figure:
    """Set how often the shape turns round on the way from the keys at some frames."""
    keys = keys_in_time.at_frames(figure.keys, frames)
    return exchange(
        figure, {key.frame: replace(key, turns=turns) for key in keys if key.turns != turns}
    )


def _inserted(figure: Figure, frame: int, pose: Pose, easing: Easing) -> Figure:
    new = Keyframe(frame=frame, pose=pose, easing=easing)
    return _with_keys(figure, keys_in_time.inserted(figure.keys, new))


def exchange(figure: Figure, changed: dict[int, Keyframe]) -> Figure:
    """Return the figure with others for the keys at some frames, itself if there are none."""
    return _with_keys(figure, keys_in_time.exchanged(figure.keys, changed))


def _with_keys(
    figure: Figure, keys: tuple[Keyframe, ...], cycles: tuple[Cycle, ...] | None = None
) -> Figure:
    if keys is figure.keys:
        return figure
    return replace(figure, keys=keys, cycles=figure.cycles if cycles is None else cycles)


def _carried(
    figure: Figure, frames: Collection[int], to: Callable[[int], int]
) -> tuple[Cycle, ...]:
    """Return a figure's cycles; those of which all keys are among some go with them."""
    cycles = []
    for cycle in figure.cycles:
        own = {frame for frame in figure.key_frames if cycle.has(frame)}
        cycles.append(cycle.moved(to) if own and own <= set(frames) else cycle)
    return tuple(sorted(cycles, key=lambda cycle: cycle.first))


def stretched(figure: Figure, first: int, factor: float) -> Figure:
    """Return the figure with all of its time stretched or shortened around a frame that stays.

    Where it would be shown and hidden, or attached anew, at one frame, what comes later holds from
    there on. Springs swing in seconds, and go on doing so.
    """

    def to(frame: int) -> int:
        return keys_in_time.scaled(frame, first, factor)

    def all_to(keys: Iterable[keys_in_time.Key]) -> tuple[keys_in_time.Key, ...]:
        return keys_in_time.in_order(key.at_pace(to(key.frame), 1 / factor) for key in keys)

    switches = {to(switch.frame): switch for switch in figure.switches}
    joints = {max(to(joint.frame), 0): joint.moved(to) for joint in figure.joints}
    return replace(
        figure,
        switches=tuple(replace(switch, frame=at) for at, switch in switches.items()),
        joints=tuple(joints.values()),
        keys=all_to(figure.keys),
        cycles=tuple(cycle.moved(to) for cycle in figure.cycles),
        tracks=tuple(
            replace(track, keys=all_to(track.keys), delay=round(factor * track.delay))
            for track in figure.tracks
        ),
        movement=all_to(figure.movement),
        opacities=all_to(figure.opacities),
        placings=moved_in_time(figure.placings, to),
    )
