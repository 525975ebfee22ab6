"""Commands on keys: posing, inserting, and moving them about in time."""

from collections import Counter
from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from app.document.commands.command import figure_command
from app.document.figure import Figure
from app.document.keyframe import Keyframe, Pose
from app.document.timing import HOLD, LINEAR, Easing, Passing
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
    others = {key.frame: key for key in figure.keys} | {key.frame: key for key in keys}
    return _with_keys(figure, others.values())


@figure_command("Move keys")
def move_keys(figure: Figure, frames: Collection[int], by: int) -> Figure:
    """Move the keys at some frames by a number of frames."""
    moved = {key.frame: replace(key, frame=key.frame + by) for key in _keys_at(figure, frames)}
    return exchange(figure, moved) if by else figure


@figure_command("Copy keys")
def copy_keys(figure: Figure, frames: Collection[int], by: int) -> Figure:
    """Repeat the keys at some frames a number of frames later, or earlier."""
    copies = [replace(key, frame=key.frame + by) for key in _keys_at(figure, frames)]
    return _with_keys(figure, (*figure.keys, *copies)) if copies else figure


@figure_command("Delete keys")
def delete_keys(figure: Figure, frames: Collection[int]) -> Figure:
    """Delete the keys at some frames; one key must remain."""
    gone = _keys_at(figure, frames)
    if not gone:
        return figure
    if len(gone) == len(figure.keys):
        raise LissomError("An animation has at least one key; pose the last one instead.")
    return replace(figure, keys=tuple(key for key in figure.keys if key not in gone))


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
    keys = _keys_at(figure, frames)
    ends = sum(span) if span else keys[0].frame + keys[-1].frame if keys else 0
    if len(keys) < 2 and all(2 * key.frame == ends for key in keys):
        return figure
    # Easing and turns belong to the interval after their key: those between the keys turn round
    # with them, and those after the last key stay where they are.
    ways = [(keys[-1].easing, keys[-1].turns)]
    ways += [(key.easing.reversed(), -key.turns) for key in keys[:-1]]
    turned = {
        key.frame: replace(key, frame=ends - key.frame, easing=easing, turns=turns)
        for key, (easing, turns) in zip(keys, ways, strict=True)
    }
    return exchange(figure, turned)


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
    keys = _keys_at(figure, frames)
    require_factor(factor)
    if factor == 1 or not keys:
        return figure
    first = keys[0].frame if first is None else first
    moved = [key for key in keys if key.frame != first]
    return exchange(
        figure, {key.frame: replace(key, frame=scaled(key.frame, first, factor)) for key in moved}
    )


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
    keys = [key for key in _keys_at(figure, frames) if key.easing != easing]
    return exchange(figure, {key.frame: replace(key, easing=easing) for key in keys})


@figure_command("Set passing")
def set_passing(figure: Figure, frames: Collection[int], passing: Passing) -> Figure:
    """Set how the motion passes the keys at some frames; one that held its pose does no longer."""
    changed = {}
    for key in _keys_at(figure, frames):
        if key.shown_passing is passing:
            continue
        if passing is Passing.HOLD:
            changed[key.frame] = replace(key, easing=HOLD)
        else:
            easing = LINEAR if key.easing == HOLD else key.easing
            changed[key.frame] = replace(key, easing=easing, passing=passing)
    return exchange(figure, changed)


@figure_command("Set turns")
def set_turns(figure: Figure, frames: Collection[int], turns: int) -> Figure:
    """Set how often the shape turns round on the way from the keys at some frames."""
    keys = [key for key in _keys_at(figure, frames) if key.turns != turns]
    return exchange(figure, {key.frame: replace(key, turns=turns) for key in keys})


def _inserted(figure: Figure, frame: int, pose: Pose, easing: Easing) -> Figure:
    keys = list(figure.keys)
    before = [key for key in keys if key.frame < frame]
    if frame > keys[-1].frame:
        if keys[-1].easing == LINEAR:
            keys[-1] = replace(keys[-1], easing=easing)
    elif before:
        easing = before[-1].easing
    return _with_keys(figure, (*keys, Keyframe(frame=frame, pose=pose, easing=easing)))


def _keys_at(figure: Figure, frames: Iterable[int]) -> list[Keyframe]:
    """Return the keys at these frames in order of time."""
    return [figure.key(frame) for frame in sorted(set(frames))]


def exchange(figure: Figure, changed: dict[int, Keyframe]) -> Figure:
    """Return the figure with others for the keys at some frames, itself if there are none."""
    keys = [changed.get(key.frame, key) for key in figure.keys]
    return _with_keys(figure, keys) if changed else figure


def _with_keys(figure: Figure, keys: Iterable[Keyframe]) -> Figure:
    """Return the figure with these keys in order of time."""
    ordered = tuple(sorted(keys, key=lambda key: key.frame))
    _require_apart(ordered)
    return replace(figure, keys=ordered)


def stretched(figure: Figure, first: int, factor: float) -> Figure:
    """Return the figure with all of its time stretched or shortened around a frame that stays.

    Where it would be shown and hidden at one frame, what comes later holds from there on.
    """
    switches = {scaled(switch.frame, first, factor): switch for switch in figure.switches}
    return _with_keys(
        replace(
            figure,
            switches=tuple(replace(switch, frame=to) for to, switch in switches.items()),
        ),
        (replace(key, frame=scaled(key.frame, first, factor)) for key in figure.keys),
    )


def _require_apart(keys: Iterable[Keyframe]) -> None:
    frame, count = Counter(key.frame for key in keys).most_common(1)[0]
    if count > 1:
        raise LissomError(
            f"Two keys would be at frame {frame}; move or delete the one there first."
        )


def scaled(frame: int, first: int, factor: float) -> int:
    """Return where a frame comes when time is stretched from the first frame on."""
    return first + round((frame - first) * factor)


def require_factor(factor: float) -> None:
    """Refuse a factor by which time cannot be scaled."""
    if not 0 < factor <= 1000:
        raise LissomError(f"Time can be scaled by more than 0 and up to 1000, not by {factor:g}.")
