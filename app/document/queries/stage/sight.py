"""What is seen at a frame."""

from dataclasses import replace
from typing import TypeVar

from app.document.figure import Figure
from app.document.layering import Placing, Switch
from app.document.model import Document
from app.document.timing import Cycle

Change = TypeVar("Change", Switch, Placing)


def is_visible(document: Document, figure: Figure, frame: float) -> bool:
    """Tell whether a figure of a document is seen at a frame."""
    switches = sights_of(document, figure)
    shown = switches[0].visible if switches else True
    for switch in switches:
        if switch.frame <= frame:
            shown = switch.visible
    return shown


def sights_of(document: Document, figure: Figure) -> tuple[Switch, ...]:
    """Return when a figure comes to be seen or hidden; it begins as the first switch says.

    Always seen without any. In a group that is hidden nothing is. A choice decides alone; other
    figures are hidden, or shown and hidden by their switches.
    """
    if document.is_in_hidden(figure):
        return (Switch(0, visible=False),)
    choice = document.choice_of(figure.id)
    if choice is None:
        if figure.hidden:
            return (Switch(0, visible=False),)
        rest = figure.switches[:1]
        return repeated(figure.switches, figure.cycles, document.frames.last, rest)
    switches: list[Switch] = []
    first = document.frames.first
    for frame in (first, *(turn.frame for turn in choice.turns if turn.frame > first)):
        visible = choice.at(frame) == figure.id
        if not switches or switches[-1].visible != visible:
            switches.append(Switch(frame, visible))
    return () if switches == [Switch(first, visible=True)] else tuple(switches)


def repeated(
    changes: tuple[Change, ...], cycles: tuple[Cycle, ...], end: int, rest: tuple[Change, ...]
) -> tuple[Change, ...]:
    """Return switches, or placings, with those of cycles in each repeat, up to the scene's end.

    Each repeat, and what follows the last one, begins as the stretch does: before the first change
    as `rest` has it.
    """
    for cycle in cycles:
        own = [each for each in changes if cycle.first < each.frame < cycle.last]
        if not own:
            continue
        until = end if cycle.until is None else cycle.until
        before = [each for each in changes if each.frame <= cycle.first]
        begun = before[-1] if before else rest[0]
        again: dict[int, Change] = {}
        for start in range(cycle.last, until + 1, cycle.period):
            again[start] = replace(begun, frame=start)
            for each in own:
                at = each.frame + start - cycle.first
                if at <= until:
                    again[at] = replace(each, frame=at)
        again |= {each.frame: each for each in changes}
        changes = tuple(again[frame] for frame in sorted(again))
    return changes
