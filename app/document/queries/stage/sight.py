"""What is seen at a frame."""

from app.document.figure import Figure
from app.document.layering import Switch
from app.document.model import Document
from app.document.queries.spans import has_been


def is_visible(document: Document, figure: Figure, frame: float) -> bool:
    """Tell whether a figure of a document is seen at a frame."""
    switches = sights_of(document, figure)
    is_own = switches is figure.switches
    shown = switches[0].visible if switches else True
    for switch in switches:
        if has_been(figure, switch.frame, frame) if is_own else switch.frame <= frame:
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
        return (Switch(0, visible=False),) if figure.hidden else figure.switches
    switches: list[Switch] = []
    first = document.frames.first
    for frame in (first, *(turn.frame for turn in choice.turns if turn.frame > first)):
        visible = choice.at(frame) == figure.id
        if not switches or switches[-1].visible != visible:
            switches.append(Switch(frame, visible))
    return () if switches == [Switch(first, visible=True)] else tuple(switches)
