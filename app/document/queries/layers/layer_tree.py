"""The layers as a tree of groups and switch groups for the layer list."""

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass

from app.document.channels.kinds import SwitchMember
from app.document.layer import Layer
from app.document.layers.groups import Group
from app.document.layers.switch_group import SwitchGroup
from app.document.model import Document
from app.texts import _


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TreeRow:
    """A row of the tree: a group, a switch group or a layer; exactly one is set."""

    key: str  # unique in the tree
    depth: int  # nesting depth
    layers: tuple[int, ...]  # ids of the layers inside, from front to back
    is_open: bool = True  # whether its rows are listed
    group: Group | None = None
    switch_group: SwitchGroup | None = None
    layer: Layer | None = None

    @property
    def toggle(self) -> str:
        """Name under which the open state is stored; empty for a layer."""
        if self.group is not None:
            return f"group {self.group.name}"
        return "" if self.switch_group is None else f"choice {self.switch_group.name}"

    @property
    def member(self) -> SwitchMember | None:
        """The layer or group as a member of a switch group; None for a switch group."""
        if self.layer is not None:
            return self.layer.id
        return None if self.group is None else self.group.name

    @property
    def name(self) -> str:
        if self.group is not None:
            return self.group.name.rpartition("/")[2]
        named = self.switch_group or self.layer
        return "" if named is None else named.name


def layer_tree(
    document: Document, toggled: Collection[str] = (), kept: Collection[int] = ()
) -> tuple[TreeRow, ...]:
    """Return the rows of the layer list, the frontmost layer first.

    Groups are open and switch groups closed unless toggled. The members of a switch group are
    listed together at the foremost member. Each run of a group is a row. Layers with an id in
    `kept` are listed even in a closed row.
    """
    rows = _whole_tree(document, toggled)
    listed: list[TreeRow] = []
    closed: int | None = None  # depth of the closed row around
    for row in rows:
        if closed is not None and row.depth > closed:
            if row.layer is not None and row.layer.id in kept:
                listed.append(row)
            continue
        closed = None if row.is_open else row.depth
        listed.append(row)
    return tuple(listed)


def parent_label(document: Document, layer: Layer, frame: float) -> str:
    """Return a label with a layer's parent at a frame.

    The label is empty for a layer that never has a parent. An ellipsis stands for other parents at
    other frames. A member of a deform group is labelled with its group.
    """
    if layer.deform_group is not None:
        return _("bends with {group}").format(group=document.deform_layer(layer).name)
    parents = {joint.parent for joint in layer.attachments if joint.parent is not None}
    ancestors = document.parent_chain(layer.id, frame)[1:]
    if not parents:
        return ""
    now = ancestors[0].name if ancestors else _("nothing")
    others = parents - {each.id for each in ancestors[:1]}
    label = _("on {parent}…") if others else _("on {parent}")
    return label.format(parent=now)


_Place = Group | SwitchGroup


def _whole_tree(document: Document, toggled: Collection[str]) -> Iterator[TreeRow]:
    places = _places(document)
    return _rows([*reversed(document.layers)], places, 0, toggled)


def _places(document: Document) -> dict[int, tuple[_Place, ...]]:
    """Return the groups and switch groups around each layer, the outermost first, by layer id.

    A switch group is where its foremost member is, also for members in other groups.
    """
    places: dict[int, tuple[_Place, ...]] = {}
    known: dict[str, tuple[_Place, ...]] = {}  # around the members of a switch group
    for layer in reversed(document.layers):
        around: tuple[_Place, ...] = ()
        members: tuple[tuple[SwitchMember, Group | None], ...] = (
            *((group.name, group) for group in document.groups_around(layer.group)),
            (layer.id, None),
        )
        for member, group in members:
            switch = document.switch_group_of(member)
            if switch is not None:
                around = known.setdefault(switch.name, (*around, switch))
            if group is not None:
                around = (*around, group)
        places[layer.id] = around
    return places


def _rows(
    layers: list[Layer],
    places: Mapping[int, tuple[_Place, ...]],
    depth: int,
    toggled: Collection[str],
) -> Iterator[TreeRow]:
    """Yield the rows of layers, from front to back, that share their outer `depth` places."""
    left = layers
    while left:
        front = left[0]
        if len(places[front.id]) == depth:
            yield TreeRow(key=f"{front.id}", depth=depth, layers=(front.id,), layer=front)
            left = left[1:]
            continue
        place = places[front.id][depth]
        inside = [each for each in left if place in places[each.id][depth : depth + 1]]
        if isinstance(place, Group):
            # Each run of a group is a row.
            inside = left[: _run_length(left, inside)]
        identities = tuple(each.id for each in inside)
        if isinstance(place, Group):
            key = f"group {place.name}"
            yield TreeRow(
                key=f"{key} {front.id}",
                depth=depth,
                layers=identities,
                is_open=key not in toggled,
                group=place,
            )
        else:
            key = f"choice {place.name}"
            yield TreeRow(
                key=key,
                depth=depth,
                layers=identities,
                is_open=key in toggled,
                switch_group=place,
            )
        yield from _rows(inside, places, depth + 1, toggled)
        kept = {*identities}
        left = [each for each in left if each.id not in kept]


def _run_length(layers: list[Layer], inside: list[Layer]) -> int:
    """Return the number of first layers that are inside."""
    count = 0
    while count < len(inside) and layers[count] is inside[count]:
        count += 1
    return count
