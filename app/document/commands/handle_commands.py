"""Commands on handles. None of them changes a map: whatever is shown stays as it is."""

from collections.abc import Callable, Collection
from dataclasses import replace
from functools import partial

import numpy as np

from app.document.commands.command import figure_command
from app.document.figure import Figure
from app.document.keyframe import Handle, Pose, Target


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
    return _with_poses(figure, partial(_follow, figure, handle), (*figure.handles, handle))


@figure_command("Move handle")
def move_handle(figure: Figure, identity: int, position: complex) -> Figure:
    """Put a handle elsewhere on the picture; its targets become where that point is now."""
    if figure.handle(identity).position == position:
        return figure
    handle = replace(figure.handle(identity), position=position)
    handles = _with_handle(figure, handle).handles
    return _with_poses(figure, partial(_follow, figure, handle), handles)


@figure_command("Delete handle")
def remove_handles(figure: Figure, identities: Collection[int]) -> Figure:
    """Remove handles by their ids. The poses stay."""
    gone = {figure.handle(identity).id for identity in identities}
    if not gone:
        return figure

    def remaining(pose: Pose) -> Pose:
        targets = {i: target for i, target in pose.targets.items() if i not in gone}
        return replace(pose, targets=targets)

    handles = tuple(handle for handle in figure.handles if handle.id not in gone)
    keys = tuple(
        replace(key, fronts={i: front for i, front in key.fronts.items() if i not in gone})
        for key in figure.keys
    )
    return _with_poses(replace(figure, keys=keys), remaining, handles)


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


def _with_poses(
    figure: Figure, change: Callable[[Pose], Pose], handles: tuple[Handle, ...]
) -> Figure:
    """Return the figure with other handles, and every pose of it changed."""
    return replace(
        figure,
        handles=handles,
        next_handle=max([figure.next_handle, *(handle.id + 1 for handle in handles)]),
        keys=tuple(replace(key, pose=change(key.pose)) for key in figure.keys),
        library=tuple(replace(kept, pose=change(kept.pose)) for kept in figure.library),
    )


def _follow(figure: Figure, handle: Handle, pose: Pose) -> Pose:
    """Return a pose with the handle's target where its map takes the handle."""
    old = pose.targets.get(handle.id)
    (place,) = figure.map_of(pose)(np.array([handle.position], dtype=np.complex128))
    position = complex(place)
    target = Target(position=position) if old is None else replace(old, position=position)
    return replace(pose, targets={**pose.targets, handle.id: target})


def _free_name(figure: Figure) -> str:
    taken = {handle.name for handle in figure.handles}
    number = figure.next_handle + 1
    while f"handle {number}" in taken:
        number += 1
    return f"handle {number}"
