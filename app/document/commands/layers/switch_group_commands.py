"""Commands on switch groups: layers and groups of which exactly one is visible, such as mouths."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

from app.document.channels.key import Key
from app.document.channels.kind import Channel
from app.document.channels.kinds import SWITCH, VISIBILITY, SwitchMember
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
def create_switch_group(document: Document, name: str, members: Sequence[SwitchMember]) -> Document:
    """Create a switch group from layers and groups that are in no other switch group.

    Visibility keys of layers become switch keys: at each frame the foremost visible member is
    chosen. Where none is visible, the previous choice stays. Layers in groups keep their keys.
    """
    for member in members:
        if isinstance(member, str):
            document.group(member)  # raises the error of a missing group
    inside = {member: document.member_layers(member) for member in members}
    starts = {
        key.frame
        for member, layers in inside.items()
        for layer in layers
        if member == layer.id
        for key in layer.keys_of(VISIBILITY)
    }
    order = {layer.id: place for place, layer in enumerate(document.layers)}
    front = sorted(members, key=lambda each: -max(order[layer.id] for layer in inside[each]))
    keys: list[Key[SwitchMember]] = []
    for frame in sorted(starts | {document.frames.first}):
        seen = next(
            (each for each in front if any(is_visible(document, of, frame) for of in inside[each])),
            None,
        )
        if seen is not None and (not keys or seen != keys[-1].value):
            keys.append(SWITCH.key(frame, seen))
    if [key.value for key in keys] == list(members[:1]):
        keys = []  # the first member at all frames is the default
    for member in members:
        document = _without_visibility_keys(document, member)
    switch = SwitchGroup(name=name.strip(), members=tuple(members), keys=tuple(keys))
    return replace(document, switch_groups=(*document.switch_groups, switch))


@command(_("Set switch key"))
def choose_at(document: Document, member: SwitchMember, frame: int) -> Document:
    """Show a member of its switch group from a frame on; in a cycle, the key repeats."""
    choice = _switch_group_of(document, member)
    if with_repeats(document, choice).member_at(frame) == member:
        return document
    shown = source_frame(document, Channel(SWITCH, part=choice.name), frame)
    frame = frame if shown is None else shown
    keys = choice.keys or (SWITCH.key(min(frame, document.frames.first), choice.members[0]),)
    others = [key for key in keys if key.frame != frame]
    ordered = sorted([*others, SWITCH.key(frame, member)], key=lambda key: key.frame)
    changed = replace(choice, keys=without_repetitions(ordered))
    return _replace_switch_group(document, choice, changed)


@command(_("Rename switch"))
def rename_switch_group(document: Document, name: str, new: str) -> Document:
    """Rename a switch group; the name must be free."""
    choice = document.switch_group(name)
    return _replace_switch_group(document, choice, replace(choice, name=new.strip()))


@command(_("Add to switch"))
def add_to_switch_group(document: Document, name: str, members: Sequence[SwitchMember]) -> Document:
    """Add layers or groups to a switch group as the last ones; its keys decide about them."""
    choice = document.switch_group(name)
    new = tuple(member for member in members if member not in choice.members)
    if not new:
        return document
    for member in new:
        document = _without_visibility_keys(document, member)
    return _replace_switch_group(document, choice, replace(choice, members=(*choice.members, *new)))


@command(_("Remove from switch"))
def remove_from_switch_group(document: Document, member: SwitchMember) -> Document:
    """Remove a member from its switch group; its layers keep their visibility as own keys.

    At its frames the switch shows the previous member. A switch of one member is deleted.
    """
    choice = _switch_group_of(document, member)
    rest = _without(choice, member)
    return _replace_switch_group(document, choice, rest, freed=[member] if rest else choice.members)


@command(_("Delete switch"))
def delete_switch_group(document: Document, name: str) -> Document:
    """Delete a switch group; its layers keep their visibility as keys of their own."""
    choice = document.switch_group(name)
    return _replace_switch_group(document, choice, None, freed=choice.members)


def without_switch_member(document: Document, member: SwitchMember) -> Document:
    """Return a document whose switch groups lack a layer or group that is about to be deleted."""
    choice = document.switch_group_of(member)
    if choice is None:
        return document
    rest = _without(choice, member)
    freed = () if rest else [each for each in choice.members if each != member]
    return _replace_switch_group(document, choice, rest, freed=freed)


def with_renamed_members(
    switches: Sequence[SwitchGroup], to: Mapping[str, str]
) -> tuple[SwitchGroup, ...]:
    """Return switch groups whose member groups have new paths."""

    def renamed(member: SwitchMember) -> SwitchMember:
        return to.get(member, member) if isinstance(member, str) else member

    return tuple(
        replace(
            switch,
            members=tuple(map(renamed, switch.members)),
            keys=tuple(replace(key, value=renamed(key.value)) for key in switch.keys),
        )
        for switch in switches
    )


def _without_visibility_keys(document: Document, member: SwitchMember) -> Document:
    """Return a document in which only a switch group decides about a member."""
    if isinstance(member, str):
        document.group(member)
        groups = tuple(
            replace(each, hidden=False) if each.name == member else each for each in document.groups
        )
        return replace(document, groups=groups)
    document = with_layer_shown(document, member)
    layer = document.layer(member)
    return document.with_layer(layer.with_keys_of(VISIBILITY, ()))


def _without(choice: SwitchGroup, member: SwitchMember) -> SwitchGroup | None:
    members = tuple(each for each in choice.members if each != member)
    keys = without_repetitions(key for key in choice.keys if key.value != member)
    return replace(choice, members=members, keys=keys) if len(members) > 1 else None


def _replace_switch_group(
    document: Document,
    choice: SwitchGroup,
    changed: SwitchGroup | None,
    freed: Collection[SwitchMember] = (),
) -> Document:
    """Return a document with a changed or deleted switch group; freed layers get own keys.

    Layers that an inner switch group decides about get none.
    """
    if changed == choice:
        return document
    # Groups that are hidden do not count, and neither do switch groups around.
    visible = replace(
        document,
        groups=tuple(replace(group, hidden=False) for group in document.groups),
        switch_groups=(choice,),
    )
    own = {layer.id for member in freed for layer in document.member_layers(member)}
    own -= {
        member for each in document.switch_groups if each is not choice for member in each.members
    }
    layers = tuple(
        replace(each.with_keys_of(VISIBILITY, visibility_keys(visible, each)), hidden=False)
        if each.id in own and (each.id in freed or not each.hidden)
        else each
        for each in document.layers
    )
    choices = (changed if each is choice else each for each in document.switch_groups)
    return replace(document, layers=layers, switch_groups=tuple(filter(None, choices)))


def _switch_group_of(document: Document, member: SwitchMember) -> SwitchGroup:
    choice = document.switch_group_of(member)
    if choice is None:
        name = document.member_name(member)
        raise LissomError(_("{name!r} is in no switch.").format(name=name))
    return choice
