"""Moving keys in time: pure functions on the keys of one channel, in the order of their frames."""

from collections import Counter
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, replace
from itertools import chain, pairwise
from math import floor
from typing import TypeVar

from app.document.channels.easing import HOLD, LINEAR, Easing
from app.document.channels.key import BaseKey, Key as ValueKey
from app.document.channels.kinds import SwitchMember
from app.document.channels.tangent_mode import TangentMode
from app.document.layer import NO_KEY
from app.errors import LissomError
from app.texts import N_, _

Key = TypeVar("Key", bound=BaseKey)
Keys = tuple[Key, ...]
KEYS_COLLIDE = N_("Two keys would be at frame {frame}; move or delete the key there first.")
KEYS_MEET = N_(
    "{channel}: the keys at frames {one} and {other} would both be at frame {frame}. Delete one "
    "of them first, or shorten the time less."
)
BAD_TIME_FACTOR = N_("Time can be scaled by a factor above 0 and up to 1000, not by {factor:g}.")


@dataclass(frozen=True, slots=True)
class TimeScale:
    """Scales frames around a fixed frame."""

    stays: int
    factor: float

    def __post_init__(self) -> None:
        if not 0 < self.factor <= 1000:
            raise LissomError(_(BAD_TIME_FACTOR).format(factor=self.factor))

    def __call__(self, frame: int) -> int:
        """Return the scaled frame, at least 0."""
        return max(self.stays + nearest_frame((frame - self.stays) * self.factor), 0)

    def scaled_time(self, time: float) -> float:
        """Return a scaled time in frames, whole or between two."""
        return self.stays + (time - self.stays) * self.factor

    def scaled(self, keys: Iterable[Key], channel: str) -> Keys[Key]:
        """Return keys at their scaled frames, with velocities scaled accordingly.

        Two keys at one frame are refused; `channel` names them. Before the fixed frame, where no
        frame is shown, the last of them counts.
        """
        placed: dict[int, Key] = {}
        for key in keys:
            at = self(key.frame)
            if at in placed and key.frame > self.stays:
                self.require_apart((placed[at], key), channel)
            placed[at] = key
        return tuple(key.mapped(self, 1 / self.factor) for key in placed.values())

    def require_apart(self, keys: Iterable[BaseKey], channel: str) -> None:
        """Refuse ordered keys of which two would be at one frame; `channel` names them."""
        for one, other in pairwise(key.frame for key in keys):
            at = self(other)
            if self(one) == at:
                raise LissomError(
                    _(KEYS_MEET).format(channel=channel, one=one, other=other, frame=at)
                )


def nearest_frame(time: float) -> int:
    """Return the nearest frame, the later one of two, so that scaled steps are equal.

    `round` takes the even one: times .5, 1.5 and 2.5 would become frames 0, 2 and 2.
    """
    return floor(time + 0.5)


def keys_at_frames(keys: Keys[Key], frames: Iterable[int]) -> list[Key]:
    """Return the keys at these frames in order of time."""
    found = {key.frame: key for key in keys}
    for frame in frames:
        if frame not in found:
            raise LissomError(_(NO_KEY).format(frame=frame))
    return [found[frame] for frame in sorted(set(frames))]


def sorted_by_frame(keys: Iterable[Key]) -> Keys[Key]:
    """Return keys as a row; two keys at one frame are refused."""
    ordered = tuple(sorted(keys, key=lambda key: key.frame))
    for frame, count in Counter(key.frame for key in ordered).items():
        if count > 1:
            raise LissomError(_(KEYS_COLLIDE).format(frame=frame))
    return ordered


def with_replaced_keys(keys: Keys[Key], changed: Mapping[int, Key]) -> Keys[Key]:
    """Return the row with some keys replaced; the same object without a change."""
    row = sorted_by_frame(changed.get(key.frame, key) for key in keys)
    return keys if row == keys else row


def with_inserted_key(keys: Keys[Key], new: Key) -> Keys[Key]:
    """Return the row with one more key.

    A key within a segment takes the easing of the segment. Otherwise the new segment takes the new
    key's easing; the former last key keeps an easing that is not linear.
    """
    row: list[Key] = list(keys)
    before = [key for key in row if key.frame < new.frame]
    if row and new.frame > row[-1].frame:
        if row[-1].easing == LINEAR:
            row[-1] = replace(row[-1], easing=new.easing)
    elif before:
        new = replace(new, easing=before[-1].easing)
    return sorted_by_frame(chain(row, [new]))


def with_overwritten_keys(keys: Keys[Key], others: Iterable[Key]) -> Keys[Key]:
    """Return the row with other keys at their frames, in place of existing keys."""
    return sorted_by_frame(
        ({key.frame: key for key in keys} | {key.frame: key for key in others}).values()
    )


def with_moved_keys(keys: Keys[Key], frames: Collection[int], by: int) -> Keys[Key]:
    """Return the row with the keys at some frames moved by a number of frames."""
    chosen = keys_at_frames(keys, frames)
    moved = {key.frame: key.retimed(key.frame + by, 1.0) for key in chosen if by}
    return with_replaced_keys(keys, moved)


def with_copied_keys(keys: Keys[Key], frames: Collection[int], by: int) -> Keys[Key]:
    """Return the row with copies of the keys at some frames, moved by a number of frames."""
    copies = [key.copied(key.frame + by) for key in keys_at_frames(keys, frames)]
    return sorted_by_frame(chain(keys, copies)) if copies else keys


def without_keys(keys: Keys[Key], frames: Collection[int]) -> Keys[Key]:
    """Return the row without the keys at some frames; it may be empty."""
    gone = keys_at_frames(keys, frames)
    return tuple(key for key in keys if key not in gone) if gone else keys


def with_reversed_keys(
    keys: Keys[Key],
    frames: Collection[int],
    span: tuple[int, int] | None = None,
    *,
    is_held: bool = False,
) -> Keys[Key]:
    """Return the row with keys and motion reversed in `span`, by default the range of the keys."""
    chosen = keys_at_frames(keys, frames)
    ends = sum(span) if span else chosen[0].frame + chosen[-1].frame if chosen else 0
    if len(chosen) < 2 and all(2 * key.frame == ends for key in chosen):
        return keys
    # A key stores what follows it: an easing, or the value that it holds. These are reversed
    # between the keys, and what follows the last key stays there.
    moved: dict[int, Key] = {}
    for before, key in pairwise([chosen[-1], *chosen]):
        is_first = key is chosen[0]
        if is_held:
            # Between two keys the value is that of the earlier one.
            moved[key.frame] = before.retimed(ends - key.frame, -1)
        else:
            eased = key.with_easing_of(before, backwards=not is_first)
            moved[key.frame] = eased.retimed(ends - key.frame, -1)
    return with_replaced_keys(keys, moved)


def with_scaled_keys(
    keys: Keys[Key], frames: Collection[int], scale: TimeScale, channel: str
) -> Keys[Key]:
    """Return the row with the keys at some frames scaled; `channel` names it in refusals."""
    chosen = keys_at_frames(keys, frames)
    if scale.factor == 1 or not chosen:
        return keys
    scale.require_apart(chosen, channel)
    changed = {key.frame: key.retimed(scale(key.frame), 1 / scale.factor) for key in chosen}
    return with_replaced_keys(keys, changed)


def with_easing(keys: Keys[Key], frames: Collection[int], easing: Easing) -> Keys[Key]:
    """Return the row with this easing after the keys at some frames."""
    changed = {}
    for key in keys_at_frames(keys, frames):
        free = key.without_velocity()
        changed[key.frame] = free if free.easing == easing else replace(free, easing=easing)
    return with_replaced_keys(keys, changed)


def with_tangent_mode(keys: Keys[Key], frames: Collection[int], passing: TangentMode) -> Keys[Key]:
    """Return the row with this tangent mode at some frames; a hold ends."""
    changed = {}
    for key in keys_at_frames(keys, frames):
        free = key.without_velocity()
        if key.shown_tangent_mode is passing:
            changed[key.frame] = free
        elif passing is TangentMode.HOLD:
            changed[key.frame] = replace(free, easing=HOLD)
        else:
            easing = LINEAR if key.easing == HOLD else key.easing
            changed[key.frame] = replace(free, easing=easing, tangent_mode=passing)
    return with_replaced_keys(keys, changed)


def without_repetitions(
    keys: Iterable[ValueKey[SwitchMember]],
) -> tuple[ValueKey[SwitchMember], ...]:
    """Return switch keys without those that show the layer that was visible before."""
    plain: list[ValueKey[SwitchMember]] = []
    for key in keys:
        if not plain or key.value != plain[-1].value:
            plain.append(key)
    return tuple(plain)
