"""What is seen at a frame."""

from bisect import bisect_right
from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from typing import TypeVar

from app.document.layer import Layer
from app.document.layers import DrawOrderKey, SwitchGroup, SwitchKey, VisibilityKey
from app.document.model import Document
from app.document.timing import Cycle, count_changes_within

Change = TypeVar("Change", VisibilityKey, DrawOrderKey, SwitchKey)


def is_visible(document: Document, layer: Layer, frame: float) -> bool:
    """Tell whether a layer of a document is seen at a frame."""
    switches = visibility_keys(document, layer)
    count = bisect_right(switches, frame, key=lambda switch: switch.frame)
    return switches[max(count - 1, 0)].visible if switches else True


def visibility_keys(document: Document, layer: Layer) -> tuple[VisibilityKey, ...]:
    """Return when a layer comes to be seen or hidden; it begins as the first switch says.

    Always seen without any. In a group that is hidden nothing is. A choice decides alone; other
    layers are hidden, or shown and hidden by their switches.
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
    """Return when a layer of a choice comes to be seen or hidden, from the first frame on."""
    switches: list[VisibilityKey] = []
    begun = SwitchKey(first, choice.layer_at(first))
    for frame, seen in (begun, *(turn for turn in choice.keys if turn.frame > first)):
        visible = seen == identity
        if not switches or switches[-1].visible != visible:
            switches.append(VisibilityKey(frame, visible))
    return () if switches == [VisibilityKey(first, visible=True)] else tuple(switches)


def switch_cycle(document: Document, choice: SwitchGroup) -> Cycle | None:
    """Return the cycle with which the turns of a choice repeat, if they do.

    That is one that all of its layers have, in which all of its turns are; at the end the one
    that is seen at the beginning may be again.
    """
    shared, *others = (document.layer(each).cycles for each in choice.layers)
    for cycle in shared:
        if all(cycle in each for each in others) and is_switch_in_cycle(choice, cycle):
            return cycle
    return None


def with_repeats(document: Document, choice: SwitchGroup, end: int | None = None) -> SwitchGroup:
    """Return a choice with its turns in the repeats of the cycle of its layers, if it has one.

    Up to a frame, or the scene's last one.
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
    # A repeat may begin with what was seen at the end of the one before.
    changes = (turn for before, turn in pairwise(turns) if turn.layer != before.layer)
    return replace(choice, keys=(turns[0], *changes))


def turn_frame(document: Document, choice: SwitchGroup, frame: int) -> int:
    """Return the frame at which it is said what of a choice a frame shows: another in repeats."""
    cycle = switch_cycle(document, choice)
    is_repeat = cycle is not None and cycle.covers(frame) and frame != cycle.until
    return int(cycle.source_frame(frame)) if cycle is not None and is_repeat else frame


def is_switch_in_cycle(choice: SwitchGroup, cycle: Cycle) -> bool:
    """Tell whether all changes of a choice, but for those before and after, are in a cycle."""
    again = SwitchKey(cycle.last, choice.layer_at(cycle.first))
    return cycle.contains_changes(turn.frame for turn in choice.keys if turn != again)


def repeated(
    changes: tuple[Change, ...], cycles: tuple[Cycle, ...], end: int, rest: tuple[Change, ...]
) -> tuple[Change, ...]:
    """Return switches, placings or turns with those of cycles in each repeat, up to the end.

    Each repeat, and what follows the last one, begins as the stretch does: before the first change
    as `rest` has it.
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
    """Return the frame at which switches or placings say what a frame shows: another in repeats.

    What a repeat has of its own is said there.
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
