"""Commands on choices: layers of one place that take turns, such as mouths."""

from collections.abc import Collection, Iterable, Sequence
from dataclasses import replace

from app.document.commands.command import command
from app.document.commands.layers.hidden import with_layer_shown
from app.document.layers import SwitchGroup, SwitchKey
from app.document.model import Document
from app.document.queries import is_visible, turn_frame, visibility_keys, with_repeats
from app.errors import LissomError


@command("Let layers take turns")
def create_switch_group(document: Document, name: str, layers: Sequence[int]) -> Document:
    """Let layers take turns, which are not in another choice.

    Where they were shown and hidden at frames of their own, the one in front of those that were
    seen is seen; where none was, the last one still is.
    """
    members = [document.layer(identity) for identity in layers]
    starts = {switch.frame for layer in members for switch in layer.visibility_keys}
    front = [layer for layer in reversed(document.layers) if layer in members]
    turns: list[SwitchKey] = []
    for frame in sorted(starts | {document.frames.first}):
        seen = next((each.id for each in front if is_visible(document, each, frame)), None)
        if seen is not None and (not turns or seen != turns[-1].layer):
            turns.append(SwitchKey(frame, seen))
    if [turn.layer for turn in turns] == list(layers[:1]):
        turns = []  # the first one, at all times
    for layer in members:
        document = _without_visibility_keys(document, layer.id)
    choice = SwitchGroup(name=name.strip(), layers=tuple(layers), keys=tuple(turns))
    return replace(document, switch_groups=(*document.switch_groups, choice))


@command("Choose from here on")
def choose_at(document: Document, identity: int, frame: int) -> Document:
    """Let a layer be the one of its choice that is seen from a frame on; in repeats, from all."""
    choice = _switch_group_of(document, identity)
    if with_repeats(document, choice).layer_at(frame) == identity:
        return document
    frame = turn_frame(document, choice, frame)
    turns = choice.keys or (SwitchKey(min(frame, document.frames.first), choice.layers[0]),)
    changed = replace(choice, keys=_put(turns, SwitchKey(frame, identity)))
    return _replace_switch_group(document, choice, changed)


@command("Change nothing here")
def unchoose_at(document: Document, name: str, frame: int) -> Document:
    """Take back what a choice says at a frame: what was seen before it is still seen."""
    choice = document.switch_group(name)
    left = _plain(turn for turn in choice.keys if turn.frame != frame)
    return _replace_switch_group(document, choice, replace(choice, keys=left))


@command("Move choice in time")
def move_turn(document: Document, name: str, frame: int, to: int) -> Document:
    """Move the frame from which on a choice shows a layer, in place of what begins there."""
    choice = document.switch_group(name)
    moved = next((turn for turn in choice.keys if turn.frame == frame), None)
    if moved is None:
        raise LissomError(f"The choice {name!r} changes nothing at frame {frame}.")
    others = (turn for turn in choice.keys if turn is not moved)
    changed = replace(choice, keys=_put(others, moved._replace(frame=to)))
    return _replace_switch_group(document, choice, changed)


@command("Rename choice")
def rename_switch_group(document: Document, name: str, new: str) -> Document:
    """Give a choice another name, which no other one may have."""
    choice = document.switch_group(name)
    return _replace_switch_group(document, choice, replace(choice, name=new.strip()))


@command("Take into the choice")
def add_to_switch_group(document: Document, name: str, layers: Sequence[int]) -> Document:
    """Take layers into a choice, as the last ones; each is seen where it is chosen only."""
    choice = document.switch_group(name)
    new = tuple(identity for identity in layers if identity not in choice.layers)
    if not new:
        return document
    for identity in new:
        document = _without_visibility_keys(document, identity)
    return _replace_switch_group(document, choice, replace(choice, layers=(*choice.layers, *new)))


@command("Take out of the choice")
def remove_from_switch_group(document: Document, identity: int) -> Document:
    """Take a layer out of its choice; by itself it is seen when it was.

    Of the others the one before is seen then, too. A choice of one layer is none.
    """
    choice = _switch_group_of(document, identity)
    rest = _without(choice, identity)
    return _replace_switch_group(
        document, choice, rest, freed=[identity] if rest else choice.layers
    )


@command("Let layers take turns no more")
def delete_switch_group(document: Document, name: str) -> Document:
    """Let each layer of a choice be seen when it was, by itself."""
    choice = document.switch_group(name)
    return _replace_switch_group(document, choice, None, freed=choice.layers)


def without_switch_member(document: Document, identity: int) -> Document:
    """Return a document in which a layer that is about to be removed is in no choice."""
    choice = document.switch_group_of(identity)
    if choice is None:
        return document
    rest = _without(choice, identity)
    return _replace_switch_group(document, choice, rest, freed=() if rest else choice.layers)


def _without_visibility_keys(document: Document, identity: int) -> Document:
    """Return a document in which nothing but a choice decides when a layer is seen."""
    document = with_layer_shown(document, identity)
    layer = document.layer(identity)
    return (
        document.with_layer(replace(layer, visibility_keys=()))
        if layer.visibility_keys
        else document
    )


def _without(choice: SwitchGroup, identity: int) -> SwitchGroup | None:
    layers = tuple(layer for layer in choice.layers if layer != identity)
    turns = _plain(turn for turn in choice.keys if turn.layer != identity)
    return replace(choice, layers=layers, keys=turns) if len(layers) > 1 else None


def _replace_switch_group(
    document: Document,
    choice: SwitchGroup,
    changed: SwitchGroup | None,
    freed: Collection[int] = (),
) -> Document:
    """Return a document with another choice, or none, and layers that are seen as it had them."""
    if changed == choice:
        return document
    # Whatever groups hide.
    visible = replace(document, groups=tuple(replace(g, hidden=False) for g in document.groups))
    layers = tuple(
        replace(each, visibility_keys=visibility_keys(visible, each), hidden=False)
        if each.id in freed
        else each
        for each in document.layers
    )
    choices = (changed if each is choice else each for each in document.switch_groups)
    return replace(document, layers=layers, switch_groups=tuple(filter(None, choices)))


def _put(turns: Iterable[SwitchKey], new: SwitchKey) -> tuple[SwitchKey, ...]:
    """Return turns with another one in place of what begins at its frame."""
    others = [turn for turn in turns if turn.frame != new.frame]
    return _plain(sorted([*others, new]))


def _plain(turns: Iterable[SwitchKey]) -> tuple[SwitchKey, ...]:
    """Return turns without those that change nothing."""
    plain: list[SwitchKey] = []
    for turn in turns:
        if not plain or turn.layer != plain[-1].layer:
            plain.append(turn)
    return tuple(plain)


def _switch_group_of(document: Document, identity: int) -> SwitchGroup:
    choice = document.switch_group_of(identity)
    if choice is None:
        name = document.layer(identity).name
        raise LissomError(f"The layer {name!r} takes no turns with others.")
    return choice
