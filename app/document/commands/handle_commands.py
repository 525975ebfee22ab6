"""Commands on handles. None of them changes a map: whatever is shown stays as it is."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from app.document.commands.command import figure_command
from app.document.figure import Figure
from app.document.keyframe import Handle, Keyframe, Target


@figure_command("Add handle")
def add_handle(
    figure: Figure, position: complex, *, name: str | None = None, weight: float = 1.0
) -> Figure:
    """Add a handle at a point of the picture; each key's target is where its map takes the point.

    Parameters
    ----------
    figure : Figure
    position : complex
        In pixels of the picture at rest, y up, on the shape.
    name : str, optional
        "handle 1" and so on by default. The new handle's id is `figure.next_handle`.
    weight : float
        How strongly it pulls, relative to others.
    """
    handle = Handle(
        id=figure.next_handle,
        name=_free_name(figure) if name is None else name,
        position=position,
        weight=weight,
    )
    return replace(
        figure,
        handles=(*figure.handles, handle),
        next_handle=handle.id + 1,
        keys=_follow(figure, handle),
    )


@figure_command("Move handle")
def move_handle(figure: Figure, identity: int, position: complex) -> Figure:
    """Put a handle elsewhere on the picture; its targets become where that point is now."""
    if figure.handle(identity).position == position:
        return figure
    handle = replace(figure.handle(identity), position=position)
    return replace(_with_handle(figure, handle), keys=_follow(figure, handle))


@figure_command("Delete handle")
def remove_handles(figure: Figure, identities: Collection[int]) -> Figure:
    """Remove handles by their ids. The poses stay."""
    gone = {figure.handle(identity).id for identity in identities}
    if not gone:
        return figure
    keys = []
    for key in figure.keys:
        targets = {i: target for i, target in key.pose.targets.items() if i not in gone}
        keys.append(replace(key, pose=replace(key.pose, targets=targets)))
    handles = tuple(handle for handle in figure.handles if handle.id not in gone)
    return replace(figure, handles=handles, keys=tuple(keys))


@figure_command("Rename handle")
def rename_handle(figure: Figure, identity: int, name: str) -> Figure:
    """Give a handle another name."""
    if figure.handle(identity).name == name:
        return figure
    return _with_handle(figure, replace(figure.handle(identity), name=name))


@figure_command("Set handle weight")
def weigh_handle(figure: Figure, identity: int, weight: float) -> Figure:
    """Let a handle pull more or less strongly in poses that are solved from now on."""
    if figure.handle(identity).weight == weight:
        return figure
    return _with_handle(figure, replace(figure.handle(identity), weight=weight))


def _with_handle(figure: Figure, changed: Handle) -> Figure:
    handles = tuple(changed if handle.id == changed.id else handle for handle in figure.handles)
    return replace(figure, handles=handles)


def _follow(figure: Figure, handle: Handle) -> tuple[Keyframe, ...]:
    """Return the keys with the handle's targets where their maps take its place."""
    place = np.array([handle.position], dtype=np.complex128)
    keys = []
    for key in figure.keys:
        old = key.pose.targets.get(handle.id)
        position = complex(figure.map_of(key.pose)(place)[0])
        target = Target(position=position) if old is None else replace(old, position=position)
        targets = {**key.pose.targets, handle.id: target}
        keys.append(replace(key, pose=replace(key.pose, targets=targets)))
    return tuple(keys)


def _free_name(figure: Figure) -> str:
    taken = {handle.name for handle in figure.handles}
    number = figure.next_handle + 1
    while f"handle {number}" in taken:
        number += 1
    return f"handle {number}"
