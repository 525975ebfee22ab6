"""What is seen at a frame."""

from app.document.figure import Figure
from app.document.model import Document


def is_visible(document: Document, figure: Figure, frame: float) -> bool:
    """Tell whether a figure of a document is seen at a frame.

    A choice decides that alone; other figures are hidden, or shown and hidden by their switches.
    What is in a hidden group is not seen.
    """
    if document.is_in_hidden_group(figure):
        return False
    choice = document.choice_of(figure.id)
    if choice is not None:
        return choice.at(frame) == figure.id
    if figure.hidden:
        return False
    shown = figure.switches[0].visible if figure.switches else True
    for switch in figure.switches:
        if switch.frame <= frame:
            shown = switch.visible
    return shown
