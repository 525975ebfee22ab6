"""The layers as a tree of groups and switch groups for the layer list."""

from collections.abc import Collection, Iterator
from dataclasses import dataclass

from app.document.layer import Layer
from app.document.layers.groups import Group, ancestor_paths
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


def parent_label(document: Document, layer: Layer, frame: float) -> tuple[int, str]:
    """Return the number of a layer's ancestors at a frame, and a label with its parent.

    The label is empty for a layer that never has a parent. An ellipsis stands for other parents at
    other frames.
    """
    parents = {joint.parent for joint in layer.attachments if joint.parent is not None}
    ancestors = document.parent_chain(layer.id, frame)[1:]
    if not parents:
        return 0, ""
    now = ancestors[0].name if ancestors else _("nothing")
    others = parents - {each.id for each in ancestors[:1]}
    label = _("on {parent}…") if others else _("on {parent}")
    return len(ancestors), label.format(parent=now)


def _whole_tree(document: Document, toggled: Collection[str]) -> Iterator[TreeRow]:
    order = _in_order(document)
    path: tuple[str, ...] = ()
    listed_switch: SwitchGroup | None = None
    for index, (layer, choice, where) in enumerate(order):
        around = ancestor_paths(where)
        shared = sum(1 for one, other in zip(path, around, strict=False) if one == other)
        for depth in range(shared, len(around)):
            run = _run(order, index, around[depth])
            key = f"group {around[depth]}"
            yield TreeRow(
                key=f"{key} {run[0]}",
                depth=depth,
                layers=run,
                is_open=key not in toggled,
                group=document.group(around[depth]),
            )
        path = around
        if choice is not None and choice is not listed_switch:
            yield TreeRow(
                key=f"choice {choice.name}",
                depth=len(around),
                layers=tuple(each.id for each, other, _group in order if other is choice),
                is_open=f"choice {choice.name}" in toggled,
                switch_group=choice,
            )
        listed_switch = choice
        depth = len(around) + (choice is not None)
        yield TreeRow(key=f"{layer.id}", depth=depth, layers=(layer.id,), layer=layer)


_Listed = tuple[Layer, SwitchGroup | None, str]


def _in_order(document: Document) -> list[_Listed]:
    """Return the layers from front to back with their switch groups and groups.

    Members of a switch group are consecutive, at the foremost member.
    """
    order: list[_Listed] = []
    listed: set[str] = set()
    for layer in reversed(document.layers):
        choice = document.switch_group_of(layer.id)
        if choice is None:
            order.append((layer, None, layer.group))
        elif choice.name not in listed:
            listed.add(choice.name)
            members = (each for each in reversed(document.layers) if each.id in choice.layers)
            order += [(each, choice, layer.group) for each in members]
    return order


def _run(order: list[_Listed], first: int, path: str) -> tuple[int, ...]:
    """Return the ids of the run of consecutive layers of a group that begins at an index."""
    run = []
    for layer, _switch, where in order[first:]:
        if path not in ancestor_paths(where):
            break
        run.append(layer.id)
    return tuple(run)
