"""Commands on choices: layers of one place that take turns, such as mouths."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from app.document.commands.command import command
from app.document.commands.staging.showing import revealed
from app.document.layering import Choice, Turn
from app.document.model import Document
from app.document.queries import is_visible, sights_of, turn_frame, with_repeats
from app.errors import LissomError


@command("Let layers take turns")
def form_choice(document: Document, name: str, layers: Sequence[int]) -> Document:
    """Let layers take turns, which are not in another choice.

    Where they were shown and hidden at frames of their own, the one in front of those that were
    seen is seen; where none was, the last one still is.
    """
    members = [document.layer(identity) for identity in layers]
    starts = {switch.frame for layer in members for switch in layer.switches}
    front = [layer for layer in reversed(document.layers) if layer in members]
    turns: list[Turn] = []
    for frame in sorted(starts | {document.frames.first}):
        seen = next((each.id for each in front if is_visible(document, each, frame)), None)
        if seen is not None and (not turns or seen != turns[-1].layer):
            turns.append(Turn(frame, seen))
    if [turn.layer for turn in turns] == list(layers[:1]):
        turns = []  # the first one, at all times
    for layer in members:
        document = _unswitched(document, layer.id)
    choice = Choice(name=name.strip(), layers=tuple(layers), turns=tuple(turns))
    return replace(document, choices=(*document.choices, choice))


@command("Choose from here on")
def choose_at(document: Document, identity: int, frame: int) -> Document:
    """Let a layer be the one of its choice that is seen from a frame on; in repeats, from all."""
    choice = _choice_of(document, identity)
    if with_repeats(document, choice).at(frame) == identity:
        return document
    frame = turn_frame(document, choice, frame)
    turns = choice.turns or (Turn(min(frame, document.frames.first), choice.layers[0]),)
    changed = replace(choice, turns=_put(turns, Turn(frame, identity)))
    return _exchange(document, choice, changed)


@command("Change nothing here")
def unchoose_at(document: Document, name: str, frame: int) -> Document:
    """Take back what a choice says at a frame: what was seen before it is still seen."""
    choice = document.choice(name)
    left = _plain(turn for turn in choice.turns if turn.frame != frame)
    return _exchange(document, choice, replace(choice, turns=left))


@command("Move choice in time")
def move_turn(document: Document, name: str, frame: int, to: int) -> Document:
    """Move the frame from which on a choice shows a layer, in place of what begins there."""
    choice = document.choice(name)
    moved = next((turn for turn in choice.turns if turn.frame == frame), None)
    if moved is None:
        raise LissomError(f"The choice {name!r} changes nothing at frame {frame}.")
    others = (turn for turn in choice.turns if turn is not moved)
    changed = replace(choice, turns=_put(others, moved._replace(frame=to)))
    return _exchange(document, choice, changed)


@command("Rename choice")
def rename_choice(document: Document, name: str, new: str) -> Document:
    """Give a choice another name, which no other one may have."""
    choice = document.choice(name)
    return _exchange(document, choice, replace(choice, name=new.strip()))


@command("Take into the choice")
def join_choice(document: Document, name: str, layers: Sequence[int]) -> Document:
    """Take layers into a choice, as the last ones; each is seen where it is chosen only."""
    choice = document.choice(name)
    new = tuple(identity for identity in layers if identity not in choice.layers)
    if not new:
        return document
    for identity in new:
        document = _unswitched(document, identity)
    return _exchange(document, choice, replace(choice, layers=(*choice.layers, *new)))


@command("Take out of the choice")
def leave_choice(document: Document, identity: int) -> Document:
    """Take a layer out of its choice; by itself it is seen when it was.

    Of the others the one before is seen then, too. A choice of one layer is none.
    """
    choice = _choice_of(document, identity)
    rest = _without(choice, identity)
    return _exchange(document, choice, rest, freed=[identity] if rest else choice.layers)


@command("Let layers take turns no more")
def dissolve_choice(document: Document, name: str) -> Document:
    """Let each layer of a choice be seen when it was, by itself."""
    choice = document.choice(name)
    return _exchange(document, choice, None, freed=choice.layers)


def let_go(document: Document, identity: int) -> Document:
    """Return a document in which a layer that is about to be removed is in no choice."""
    choice = document.choice_of(identity)
    if choice is None:
        return document
    rest = _without(choice, identity)
    return _exchange(document, choice, rest, freed=() if rest else choice.layers)


def _unswitched(document: Document, identity: int) -> Document:
    """Return a document in which nothing but a choice decides when a layer is seen."""
    document = revealed(document, identity)
    layer = document.layer(identity)
    return document.with_layer(replace(layer, switches=())) if layer.switches else document


def _without(choice: Choice, identity: int) -> Choice | None:
    layers = tuple(layer for layer in choice.layers if layer != identity)
    turns = _plain(turn for turn in choice.turns if turn.layer != identity)
    return replace(choice, layers=layers, turns=turns) if len(layers) > 1 else None


def _exchange(
    document: Document, choice: Choice, changed: Choice | None, freed: Collection[int] = ()
) -> Document:
    """Return a document with another choice, or none, and layers that are seen as it had them."""
    if changed == choice:
        return document
    # Whatever groups hide.
    visible = replace(document, groups=tuple(replace(g, hidden=False) for g in document.groups))
    layers = tuple(
        replace(each, switches=sights_of(visible, each), hidden=False) if each.id in freed else each
        for each in document.layers
    )
    choices = (changed if each is choice else each for each in document.choices)
    return replace(document, layers=layers, choices=tuple(filter(None, choices)))


def _put(turns: Iterable[Turn], new: Turn) -> tuple[Turn, ...]:
    """Return turns with another one in place of what begins at its frame."""
    others = [turn for turn in turns if turn.frame != new.frame]
    return _plain(sorted([*others, new]))


def _plain(turns: Iterable[Turn]) -> tuple[Turn, ...]:
    """Return turns without those that change nothing."""
    plain: list[Turn] = []
    for turn in turns:
        if not plain or turn.layer != plain[-1].layer:
            plain.append(turn)
    return tuple(plain)


def _choice_of(document: Document, identity: int) -> Choice:
    choice = document.choice_of(identity)
    if choice is None:
        name = document.layer(identity).name
        raise LissomError(f"The layer {name!r} takes no turns with others.")
    return choice
