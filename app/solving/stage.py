"""From what a pose script says of its layers together to a scene."""

from dataclasses import replace

from app.document import Document, Figure, Turn, choice_commands, is_visible
from app.errors import LissomError
from app.solving.script import PoseScript


def layer_named(document: Document, name: str) -> Figure:
    """Return the layer with a name."""
    names = {figure.name: figure for figure in document.figures}
    if name not in names:
        raise LissomError(f"there is no layer {name!r}; the layers are {', '.join(names)}")
    return names[name]


def with_choices(document: Document, script: PoseScript) -> Document:
    """Return a document whose layers take turns as a script says, whatever is hidden in it."""
    for given in script.choices:
        try:
            identities = {name: layer_named(document, name).id for name in given.layers}
        except LissomError as error:
            raise LissomError(f"choice {given.name!r}: {error}") from error
        form = choice_commands.form_choice(given.name, tuple(identities.values()))
        document = form(document)
        turns = tuple(Turn(frame, identities[layer]) for frame, layer in given.turns)
        (*others, made) = document.choices
        document = replace(document, choices=(*others, replace(made, turns=turns)))
    return document


def unseen(document: Document, script: PoseScript) -> list[str]:
    """Tell of layers that a script poses, switches or chooses, and that are never seen so."""
    first, last = document.frames.first, document.frames.last
    notices = []
    for part in script.figures:
        if part.layer is None or document.choice_of(layer_named(document, part.layer).id):
            continue
        figure = layer_named(document, part.layer)
        late = [frame for frame, visible in part.visible or () if visible and frame > last]
        if any(is_visible(document, figure, frame) for frame in range(first, last + 1)):
            continue
        if part.visible is None:
            notices.append(
                f"{part.layer} is hidden in the drawing, and so never seen; with "
                '"visible": [[0, true]] it is'
            )
        elif late:
            notices.append(
                f"{part.layer} is never seen: it is shown from frame {late[0]} on, and the "
                f"animation ends at frame {last}"
            )
        else:
            notices.append(f"{part.layer} is never seen: its visible shows it at no frame")
    for choice in script.choices:
        notices += [
            f"choice {choice.name!r}: {layer} from frame {frame} on is never seen, as the "
            f"animation ends at frame {last}"
            for frame, layer in choice.turns
            if frame > last
        ]
    return notices
