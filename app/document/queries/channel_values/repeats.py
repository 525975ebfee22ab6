"""How channels repeat in cycles.

Keys that are interpolated repeat all together, or not at all. Keys that hold repeat from the
cycle's first frame to its last.
"""

from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import Any, TypeVar, cast

from app.document.channels.cycles import Cycle, count_changes_within
from app.document.channels.key import Key
from app.document.channels.kind import ChannelKind
from app.document.channels.kinds import DEPTH, SWITCH
from app.document.layer import Layer
from app.document.layers.switch_group import SwitchGroup
from app.document.model import Document

V = TypeVar("V")


def repeating_cycle(
    kind: ChannelKind[V], keys: Sequence[Key[V]], cycles: tuple[Cycle, ...]
) -> Cycle | None:
    """Return the cycle with which interpolated keys repeat, if any.

    The cycle contains all keys. A key at its end equals the key at its beginning except for full
    turns.
    """
    if not cycles or len(keys) < 2 or kind.is_held:
        return None
    first, last = keys[0], keys[-1]
    is_closed = all(each.is_same_state(first, last) for each in kind.components)
    for cycle in cycles:
        if cycle.repeats_keys(keys) and (last.frame - first.frame < cycle.period or is_closed):
            return cycle
    return None


def repeated_keys(
    keys: tuple[Key[V], ...], cycles: tuple[Cycle, ...], end: int, rest: V
) -> tuple[Key[V], ...]:
    """Return keys that hold with copies in each repeat, up to the end.

    Each repeat, and the time after the last, begins with the state at the cycle's first frame;
    `rest` is the state before the first key.
    """
    return _repeated(keys, cycles, end, rest) if keys and cycles else keys


@lru_cache(maxsize=256)
def _repeated(
    keys: tuple[Key[V], ...], cycles: tuple[Cycle, ...], end: int, rest: V
) -> tuple[Key[V], ...]:
    for cycle in cycles:
        if not count_changes_within([each.frame for each in keys], cycle):
            continue
        own = [each for each in keys if cycle.first < each.frame < cycle.last]
        until = end if cycle.until is None else cycle.until
        before = [each for each in keys if each.frame <= cycle.first]
        begun = before[-1] if before else replace(keys[0], value=rest)
        again: dict[int, Key[V]] = {}
        for start in range(cycle.last, until + 1, cycle.period):
            again[start] = replace(begun, frame=start)
            for each in own:
                at = each.frame + start - cycle.first
                if at <= until:
                    again[at] = replace(each, frame=at)
        again |= {each.frame: each for each in keys}
        keys = tuple(again[frame] for frame in sorted(again))
    return keys


def keyed_frame(
    kind: ChannelKind[Any], keys: tuple[Key[Any], ...], cycles: tuple[Cycle, ...], frame: int
) -> int:
    """Return the frame whose key of a layer's channel affects this frame; in repeats, an earlier.

    A key within a repeat, of a channel that holds, affects its own frame.
    """
    if not kind.is_held:
        cycle = repeating_cycle(kind, keys, cycles)
        in_cycle = cycle is not None and cycle.covers(frame)
        return int(cycle.source_frame(frame)) if cycle is not None and in_cycle else frame
    frames = [each.frame for each in keys]
    if frame not in frames:
        for cycle in cycles:
            if cycle.covers(frame) and frame != cycle.until and count_changes_within(frames, cycle):
                return int(cycle.source_frame(frame))
    return frame


def rest_value(layer: Layer, kind: ChannelKind[V], part: int | str | None) -> V:
    """Return the value of a layer's channel before its first key, if keys of its kind hold."""
    if kind is DEPTH and isinstance(part, int):
        return cast(V, layer.handle(part).depth)
    if kind.holds_before:
        keys = layer.keys_of(kind, part)
        return keys[0].value if keys else kind.default
    return kind.default


def held_key_at(keys: tuple[Key[V], ...], frame: float) -> Key[V] | None:
    """Return the last key at or before a frame; None before the first."""
    count = bisect_right(keys, frame, key=lambda each: each.frame)
    return keys[count - 1] if count else None


def switch_cycle(document: Document, switch: SwitchGroup) -> Cycle | None:
    """Return the cycle with which the switch keys of a group repeat, if any.

    All its moving layers have the cycle, and it contains all switch keys. A key at its end may
    repeat the member at its beginning.
    """
    shared, *others = [each.cycles for each in document.moving_layers(switch)] or [()]
    for cycle in shared:
        if all(cycle in each for each in others) and is_switch_in_cycle(switch, cycle):
            return cycle
    return None


def with_repeats(document: Document, switch: SwitchGroup, end: int | None = None) -> SwitchGroup:
    """Return a switch group with its keys repeated in the cycle of its layers, if any.

    The repeats extend to `end`, or to the document's last frame.
    """
    cycle = switch_cycle(document, switch)
    if cycle is None:
        return switch
    if end is not None:
        cycle = replace(cycle, until=end)
    return _repeated_switch_group(switch, cycle, document.frames.last)


@lru_cache(maxsize=64)
def _repeated_switch_group(switch: SwitchGroup, cycle: Cycle, end: int) -> SwitchGroup:
    begun = SWITCH.key(cycle.first, switch.member_at(cycle.first))
    keys = repeated_keys(switch.keys, (cycle,), end, begun.value)
    # A repeat may begin with the layer shown at the end of the one before.
    changes = (key for before, key in pairwise(keys) if key.value != before.value)
    return replace(switch, keys=(keys[0], *changes))


def is_switch_in_cycle(switch: SwitchGroup, cycle: Cycle) -> bool:
    """Return whether all changes of a switch group near a cycle lie within it."""
    again = switch.member_at(cycle.first)
    return cycle.contains_changes(
        key.frame for key in switch.keys if (key.frame, key.value) != (cycle.last, again)
    )
