"""Visibility at a frame."""

from bisect import bisect_right
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import TypeVar

from app.document.layer import Layer
from app.document.layers.layer_keys import DrawOrderKey
from app.document.layers.visibility import SwitchGroup, SwitchKey, VisibilityKey
from app.document.model import Document
from app.document.timing.cycles import Cycle, count_changes_within

Change = TypeVar("Change", VisibilityKey, DrawOrderKey, SwitchKey)


def is_visible(document: Document, layer: Layer, frame: float) -> bool:
    switches = visibility_keys(document, layer)
    count = bisect_right(switches, frame, key=lambda switch: switch.frame)
    return switches[max(count - 1, 0)].visible if switches else True


def visibility_keys(document: Document, layer: Layer) -> tuple[VisibilityKey, ...]:
    """Return the visibility keys in effect; the first holds before its frame too.

    Without keys, the layer is always visible. A hidden group hides its layers. A switch group alone
    decides the visibility of its members.
    """
    if document.is_in_hidden(layer):
        return (VisibilityKey(0, visible=False),)
    given = document.switch_group_of(layer.id)
    if given is None:
        if layer.hidden:
            return (VisibilityKey(0, visible=False),)
        rest = layer.visibility_keys[:1]
        return repeated(layer.visibility_keys, layer.cycles, document.frames.last, rest)
    return _visibility_keys_in(with_repeats(document, given), layer.id, document.frames.first)


@lru_cache(maxsize=256)
def _visibility_keys_in(
    choice: SwitchGroup, identity: int, first: int
) -> tuple[VisibilityKey, ...]:
    """Return a member's visibility keys, derived from the switch keys, from `first` on."""
    switches: list[VisibilityKey] = []
    begun = SwitchKey(first, choice.layer_at(first))
    for frame, seen in (begun, *(turn for turn in choice.keys if turn.frame > first)):
        visible = seen == identity
        if not switches or switches[-1].visible != visible:
            switches.append(VisibilityKey(frame, visible))
    return () if switches == [VisibilityKey(first, visible=True)] else tuple(switches)


def switch_cycle(document: Document, choice: SwitchGroup) -> Cycle | None:
    """Return the cycle with which the switch keys of a group repeat, if any.

    All layers of the group have the cycle, and it contains all switch keys. A key at its end may
    repeat the layer at its beginning.
    """
    shared, *others = (document.layer(each).cycles for each in choice.layers)
    for cycle in shared:
        if all(cycle in each for each in others) and is_switch_in_cycle(choice, cycle):
            return cycle
    return None


def with_repeats(document: Document, choice: SwitchGroup, end: int | None = None) -> SwitchGroup:
    """Return a switch group with its keys repeated in the cycle of its layers, if any.

    The repeats extend to `end`, or to the document's last frame.
    """
    cycle = switch_cycle(document, choice)
    if cycle is None:
        return choice
    if end is not None:
        cycle = replace(cycle, until=end)
    return _repeated_switch_group(choice, cycle, document.frames.last)


@lru_cache(maxsize=64)
def _repeated_switch_group(choice: SwitchGroup, cycle: Cycle, end: int) -> SwitchGroup:
    rest = (SwitchKey(cycle.first, choice.layer_at(cycle.first)),)
    turns = repeated(choice.keys, (cycle,), end, rest)
    # A repeat may begin with the layer shown at the end of the one before.
    changes = (turn for before, turn in pairwise(turns) if turn.layer != before.layer)
    return replace(choice, keys=(turns[0], *changes))


def turn_frame(document: Document, choice: SwitchGroup, frame: int) -> int:
    """Return the frame whose switch key affects this frame; in repeats, an earlier frame."""
    cycle = switch_cycle(document, choice)
    is_repeat = cycle is not None and cycle.covers(frame) and frame != cycle.until
    return int(cycle.source_frame(frame)) if cycle is not None and is_repeat else frame


def is_switch_in_cycle(choice: SwitchGroup, cycle: Cycle) -> bool:
    """Return whether all changes of a switch group near a cycle lie within it."""
    again = SwitchKey(cycle.last, choice.layer_at(cycle.first))
    return cycle.contains_changes(turn.frame for turn in choice.keys if turn != again)


def repeated(
    changes: tuple[Change, ...], cycles: tuple[Cycle, ...], end: int, rest: tuple[Change, ...]
) -> tuple[Change, ...]:
    """Return visibility, order or switch keys with copies in each repeat, up to the end.

    Each repeat, and the time after the last, begins with the state at the cycle's first frame;
    `rest` is the state before the first key.
    """
    return _repeated(changes, cycles, end, rest) if changes and cycles else changes


@lru_cache(maxsize=256)
def _repeated(
    changes: tuple[Change, ...], cycles: tuple[Cycle, ...], end: int, rest: tuple[Change, ...]
) -> tuple[Change, ...]:
    for cycle in cycles:
        if not count_changes_within([each.frame for each in changes], cycle):
            continue
        own = [each for each in changes if cycle.first < each.frame < cycle.last]
        until = end if cycle.until is None else cycle.until
        before = [each for each in changes if each.frame <= cycle.first]
        begun = before[-1] if before else rest[0]
        again: dict[int, Change] = {}
        for start in range(cycle.last, until + 1, cycle.period):
            again[start] = _moved(begun, start)
            for each in own:
                at = each.frame + start - cycle.first
                if at <= until:
                    again[at] = _moved(each, at)
        again |= {each.frame: each for each in changes}
        changes = tuple(again[frame] for frame in sorted(again))
    return changes


def change_frame(
    changes: tuple[VisibilityKey, ...] | tuple[DrawOrderKey, ...],
    cycles: tuple[Cycle, ...],
    frame: int,
) -> int:
    """Return the frame whose key affects this frame; in repeats, an earlier frame.

    A key within a repeat affects its own frame.
    """
    frames = [each.frame for each in changes]
    if frame not in frames:
        for cycle in cycles:
            if cycle.covers(frame) and frame != cycle.until and count_changes_within(frames, cycle):
                return int(cycle.source_frame(frame))
    return frame


def _moved(change: Change, frame: int) -> Change:
    if isinstance(change, SwitchKey):
        return change._replace(frame=frame)
    return replace(change, frame=frame)
