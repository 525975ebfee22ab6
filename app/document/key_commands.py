"""Commands on keys: posing, inserting, and moving them about in time."""

from collections import Counter
from collections.abc import Collection, Iterable
from dataclasses import replace

from app.document.commands import command
from app.document.easing import LINEAR, Easing
from app.document.keyframe import Keyframe, Pose
from app.document.model import Document
from app.document.settings import FrameRange
from app.errors import LissomError


@command("Pose")
def pose_key(document: Document, frame: int, pose: Pose) -> Document:
    """Give the key at a frame another pose."""
    return _exchange(document, {frame: replace(document.key(frame), pose=pose)})


@command("Insert key")
def insert_key(
    document: Document, frame: int, pose: Pose, *, easing: Easing | None = None
) -> Document:
    """Insert a key at a frame that has none.

    Without `easing` it takes that of the key before it, whose interval it divides. The animation
    grows where the frame lies beyond its ends; so it does in all commands here.
    """
    if easing is None:
        before = [key for key in document.keys if key.frame < frame]
        easing = before[-1].easing if before else LINEAR
    key = Keyframe(frame=frame, pose=pose, easing=easing)
    return _with_keys(document, (*document.keys, key))


@command("Move keys")
def move_keys(document: Document, frames: Collection[int], by: int) -> Document:
    """Move the keys at some frames by a number of frames."""
    keys = _keys_at(document, frames)
    if by == 0 or not keys:
        return document
    return _exchange(document, {key.frame: replace(key, frame=key.frame + by) for key in keys})


@command("Copy keys")
def copy_keys(document: Document, frames: Collection[int], by: int) -> Document:
    """Repeat the keys at some frames a number of frames later, or earlier."""
    copies = [replace(key, frame=key.frame + by) for key in _keys_at(document, frames)]
    return _with_keys(document, (*document.keys, *copies)) if copies else document


@command("Delete keys")
def delete_keys(document: Document, frames: Collection[int]) -> Document:
    """Delete the keys at some frames; one key must remain."""
    gone = _keys_at(document, frames)
    if not gone:
        return document
    if len(gone) == len(document.keys):
        raise LissomError("An animation has at least one key; pose the last one instead.")
    return replace(document, keys=tuple(key for key in document.keys if key not in gone))


@command("Reverse keys")
def reverse_keys(document: Document, frames: Collection[int]) -> Document:
    """Let the keys at some frames, and the motion between them, run backwards."""
    keys = _keys_at(document, frames)
    if len(keys) < 2:
        return document
    ends = keys[0].frame + keys[-1].frame
    # Easing and turns belong to the interval after their key: those between the keys turn round
    # with them, and those after the last key stay where they are.
    ways = [(keys[-1].easing, keys[-1].turns)]
    ways += [(key.easing.reversed(), -key.turns) for key in keys[:-1]]
    turned = {
        key.frame: replace(key, frame=ends - key.frame, easing=easing, turns=turns)
        for key, (easing, turns) in zip(keys, ways, strict=True)
    }
    return _exchange(document, turned)


@command("Scale time of keys")
def scale_keys(document: Document, frames: Collection[int], factor: float) -> Document:
    """Move the keys at some frames apart or together in time, the first of them staying."""
    keys = _keys_at(document, frames)
    _require_factor(factor)
    if factor == 1 or len(keys) < 2:
        return document
    first = keys[0].frame
    return _exchange(
        document, {key.frame: replace(key, frame=_scaled(key.frame, first, factor)) for key in keys}
    )


@command("Scale time")
def scale_time(document: Document, factor: float) -> Document:
    """Make the whole animation longer or shorter: its keys, its frames and its work range."""
    _require_factor(factor)
    if factor == 1:
        return document
    first = document.frames.first

    def scale(frames: FrameRange) -> FrameRange:
        return FrameRange(_scaled(frames.first, first, factor), _scaled(frames.last, first, factor))

    keys = tuple(replace(key, frame=_scaled(key.frame, first, factor)) for key in document.keys)
    _require_apart(keys)
    return replace(
        document,
        keys=keys,
        frames=scale(document.frames),
        work=None if document.work is None else scale(document.work),
    )


@command("Make last key equal first")
def match_ends(document: Document) -> Document:
    """Give the last key the pose of the first one, so that a loop has no jump."""
    first, last = document.keys[0], document.keys[-1]
    if first is last:
        raise LissomError("A loop needs two keys; insert a second one first.")
    if first.pose is last.pose:
        return document
    return _exchange(document, {last.frame: replace(last, pose=first.pose)})


@command("Set easing")
def set_easing(document: Document, frames: Collection[int], easing: Easing) -> Document:
    """Set how time runs from the keys at some frames to the next ones."""
    keys = [key for key in _keys_at(document, frames) if key.easing != easing]
    if not keys:
        return document
    return _exchange(document, {key.frame: replace(key, easing=easing) for key in keys})


@command("Set turns")
def set_turns(document: Document, frames: Collection[int], turns: int) -> Document:
    """Set how often the shape turns round on the way from the keys at some frames."""
    keys = [key for key in _keys_at(document, frames) if key.turns != turns]
    if not keys:
        return document
    return _exchange(document, {key.frame: replace(key, turns=turns) for key in keys})


def _keys_at(document: Document, frames: Iterable[int]) -> list[Keyframe]:
    """Return the keys at these frames in order of time."""
    return [document.key(frame) for frame in sorted(set(frames))]


def _exchange(document: Document, changed: dict[int, Keyframe]) -> Document:
    """Return the document with others for the keys at some frames."""
    return _with_keys(document, [changed.get(key.frame, key) for key in document.keys])


def _with_keys(document: Document, keys: Iterable[Keyframe]) -> Document:
    """Return the document with these keys in order of time, and with room for them."""
    ordered = tuple(sorted(keys, key=lambda key: key.frame))
    _require_apart(ordered)
    frames = document.frames
    frames = FrameRange(min(frames.first, ordered[0].frame), max(frames.last, ordered[-1].frame))
    return replace(document, keys=ordered, frames=frames)


def _require_apart(keys: Iterable[Keyframe]) -> None:
    frame, count = Counter(key.frame for key in keys).most_common(1)[0]
    if count > 1:
        raise LissomError(
            f"Two keys would be at frame {frame}; move or delete the one there first."
        )


def _scaled(frame: int, first: int, factor: float) -> int:
    return first + round((frame - first) * factor)


def _require_factor(factor: float) -> None:
    if not 0 < factor <= 1000:
        raise LissomError(f"Time can be scaled by more than 0 and up to 1000, not by {factor:g}.")
