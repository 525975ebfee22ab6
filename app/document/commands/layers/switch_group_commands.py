"""Commands on switch groups: layers of which exactly one is visible, such as mouths."""

from collections.abc import Collection, Sequence
from dataclasses import replace

from app.document.channels.key import Key
from app.document.channels.kind import Channel
from app.document.channels.kinds import SWITCH, VISIBILITY
from app.document.commands.command import command
from app.document.commands.keys.retime import without_repetitions
from app.document.commands.layers.hidden import with_layer_shown
from app.document.layers.switch_group import SwitchGroup
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import source_frame
from app.document.queries.channel_values.repeats import with_repeats
from app.document.queries.layers.visibility import is_visible, visibility_keys
from app.errors import LissomError
from app.texts import _


@command(_("Create switch"))
def create_switch_group(document: Document, name: str, layers: Sequence[int]) -> Document:
    """Create a switch group from layers that are in no other switch group.

    Visibility keys become switch keys: at each frame the foremost visible layer is chosen. Where
    none is visible, the previous choice stays.
    """
    members = [document.layer(identity) for identity in layers]
    starts = {switch.frame for layer in members for switch in layer.keys_of(VISIBILITY)}
    front = [layer for layer in reversed(document.layers) if layer in members]
    turns: list[Key[int]] = []
    for frame in sorted(starts | {document.frames.first}):
        seen = next((each.id for each in front if is_visible(document, each, frame)), None)
        if seen is not None and (not turns or seen != turns[-1].value):
            turns.append(SWITCH.key(frame, seen))
    if [turn.value for turn in turns] == list(layers[:1]):
        turns = []  # the first layer at all frames is the default
    for layer in members:
        document = _without_visibility_keys(document, layer.id)
    choice = SwitchGroup(name=name.strip(), layers=tuple(layers), keys=tuple(turns))
    return replace(document, switch_groups=(*document.switch_groups, choice))


@command(_("Set switch key"))
def choose_at(document: Document, identity: int, frame: int) -> Document:
    """Show a layer of its switch group from a frame on; in a cycle, the key repeats."""
    choice = _switch_group_of(document, identity)
    if with_repeats(document, choice).layer_at(frame) == identity:
        return document
    shown = source_frame(document, Channel(SWITCH, part=choice.name), frame)
    frame = frame if shown is None else shown
    keys = choice.keys or (SWITCH.key(min(frame, document.frames.first), choice.layers[0]),)
    others = [key for key in keys if key.frame != frame]
    ordered = sorted([*others, SWITCH.key(frame, identity)], key=lambda key: key.frame)
    changed = replace(choice, keys=without_repetitions(ordered))
    return _replace_switch_group(document, choice, changed)


@command(_("Rename switch"))
def rename_switch_group(document: Document, name: str, new: str) -> Document:
    """Rename a switch group; the name must be free."""
    choice = document.switch_group(name)
    return _replace_switch_group(document, choice, replace(choice, name=new.strip()))


@command(_("Add to switch"))
def add_to_switch_group(document: Document, name: str, layers: Sequence[int]) -> Document:
    """Add layers to a switch group as the last ones; switch keys decide their visibility."""
    choice = document.switch_group(name)
    new = tuple(identity for identity in layers if identity not in choice.layers)
    if not new:
        return document
    for identity in new:
        document = _without_visibility_keys(document, identity)
    return _replace_switch_group(document, choice, replace(choice, layers=(*choice.layers, *new)))


@command(_("Remove from switch"))
def remove_from_switch_group(document: Document, identity: int) -> Document:
    """Remove a layer from its switch group; it keeps its visibility as keys of its own.

    At its frames the group shows the previous layer. A group of one layer is deleted.
    """
    choice = _switch_group_of(document, identity)
    rest = _without(choice, identity)
    return _replace_switch_group(
        document, choice, rest, freed=[identity] if rest else choice.layers
    )


@command(_("Delete switch"))
def delete_switch_group(document: Document, name: str) -> Document:
    """Delete a switch group; each layer keeps its visibility as keys of its own."""
    choice = document.switch_group(name)
    return _replace_switch_group(document, choice, None, freed=choice.layers)


def without_switch_member(document: Document, identity: int) -> Document:
    """Return a document whose switch groups do not contain a layer that is about to be deleted."""
    choice = document.switch_group_of(identity)
    if choice is None:
        return document
    rest = _without(choice, identity)
    return _replace_switch_group(document, choice, rest, freed=() if rest else choice.layers)


def _without_visibility_keys(document: Document, identity: int) -> Document:
    """Return a document in which only a switch group decides the visibility of the layer."""
    document = with_layer_shown(document, identity)
    layer = document.layer(identity)
    return document.with_layer(layer.with_keys_of(VISIBILITY, ()))


def _without(choice: SwitchGroup, identity: int) -> SwitchGroup | None:
    layers = tuple(layer for layer in choice.layers if layer != identity)
    turns = without_repetitions(key for key in choice.keys if key.value != identity)
    return replace(choice, layers=layers, keys=turns) if len(layers) > 1 else None


def _replace_switch_group(
    document: Document,
    choice: SwitchGroup,
    changed: SwitchGroup | None,
    freed: Collection[int] = (),
) -> Document:
    """Return a document with a changed or deleted switch group, and freed layers with own keys."""
    if changed == choice:
        return document
    # Groups that are hidden do not count.
    visible = replace(document, groups=tuple(replace(g, hidden=False) for g in document.groups))
    layers = tuple(
        replace(each.with_keys_of(VISIBILITY, visibility_keys(visible, each)), hidden=False)
        if each.id in freed
        else each
        for each in document.layers
    )
    choices = (changed if each is choice else each for each in document.switch_groups)
    return replace(document, layers=layers, switch_groups=tuple(filter(None, choices)))


def _switch_group_of(document: Document, identity: int) -> SwitchGroup:
    choice = document.switch_group_of(identity)
    if choice is None:
        name = document.layer(identity).name
        raise LissomError(_("The layer {name!r} is in no switch.").format(name=name))
    return choice
