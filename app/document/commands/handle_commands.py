"""Commands on handles. None of them changes a map: whatever is shown stays as it is."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from app.document.commands.command import figure_command, numbered
from app.document.commands.track_handles import with_moved_handle, without_handles
from app.document.figure import Figure
from app.document.keyframe import Handle, Pose, Target


@figure_command("Add handle")
def add_handle(
    figure: Figure, position: complex, *, name: str | None = None, weight: float = 1.0
) -> Figure:
    """Add a handle at a point of the picture; each key's target is where its map takes the point.

    Parameters
    ----------
    position : complex
        In pixels of the picture at rest, y up, on the shape.
    name : str, optional
        "handle 1" and so on by default. The new handle's id is `figure.next_handle`.
    weight : float
        How strongly it pulls, relative to others.
    """
    handle = Handle(
        id=figure.next_handle,
        name=free_name(figure) if name is None else name,
        position=position,
        weight=weight,
    )
    return _with_poses(figure, partial(_follow, figure, handle), (*figure.handles, handle))


@figure_command("Add handles")
def add_handles(figure: Figure, handles: Sequence[Handle]) -> Figure:
    """Add several handles at once; their ids are given anew, from `figure.next_handle` on."""
    for number, handle in enumerate(handles, start=figure.next_handle):
        added = replace(handle, id=number)
        figure = _with_poses(figure, partial(_follow, figure, added), (*figure.handles, added))
    return figure


@figure_command("Move handle")
def move_handle(figure: Figure, identity: int, position: complex) -> Figure:
    """Put a handle elsewhere on the picture; its targets become where that point is now."""
    if figure.handle(identity).position == position:
        return figure
    handle = replace(figure.handle(identity), position=position)
    handles = tuple(handle if handle.id == other.id else other for other in figure.handles)
    moved = with_moved_handle(figure, identity, position)
    return _with_poses(moved, partial(_follow, figure, handle), handles)


@figure_command("Delete handle")
def remove_handles(figure: Figure, identities: Collection[int]) -> Figure:
    """Remove handles by their ids, with their springs, tracks and bones. The poses stay."""
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
    motions = tuple(
        replace(each, joints={name: i for name, i in each.joints.items() if i not in gone})
        for each in figure.motions
    )
    left = without_handles(replace(figure, keys=keys, motions=motions), gone)
    return _with_poses(left, remaining, handles)


@figure_command("Rename handle")
def rename_handle(figure: Figure, identity: int, name: str) -> Figure:
    """Give a handle another name."""
    return with_handles(figure, {identity}, name=name)


@figure_command("Set handle weight")
def weigh_handles(figure: Figure, identities: Collection[int], weight: float) -> Figure:
    """Let handles pull more or less strongly in poses that are solved from now on."""
    return with_handles(figure, identities, weight=weight)


@figure_command("Lock or unlock handles")
def lock_handles(figure: Figure, identities: Collection[int], *, locked: bool) -> Figure:
    """Lock handles in their places, or unlock them."""
    return with_handles(figure, identities, locked=locked)


@figure_command("Free or keep still")
def free_handles(figure: Figure, identities: Collection[int], *, free: bool) -> Figure:
    """Let handles move as they like between keys that have them at one place, or keep them."""
    return with_handles(figure, identities, free=free)


@figure_command("Group handles")
def group_handles(figure: Figure, identities: Collection[int], group: str) -> Figure:
    """Group handles under a name, to be selected and dragged together; with "", ungroup them."""
    return with_handles(figure, identities, group=group.strip())


def with_handles(figure: Figure, identities: Collection[int], **changes: Any) -> Figure:
    """Return the figure with some fields of some handles changed, itself if they have them."""
    for identity in identities:
        figure.handle(identity)
    handles = tuple(
        replace(handle, **changes) if handle.id in identities else handle
        for handle in figure.handles
    )
    return figure if handles == figure.handles else replace(figure, handles=handles)


def _with_poses(
    figure: Figure, change: Callable[[Pose], Pose], handles: tuple[Handle, ...]
) -> Figure:
    """Return the figure with other handles, and every pose of it changed."""
    return figure.with_poses(
        map(change, figure.poses),
        handles=handles,
        next_handle=max([figure.next_handle, *(handle.id + 1 for handle in handles)]),
    )


def _follow(figure: Figure, handle: Handle, pose: Pose) -> Pose:
    """Return a pose with the handle's target where its map takes the handle."""
    old = pose.targets.get(handle.id)
    (place,) = figure.map_of(pose)(np.array([handle.position], dtype=np.complex128))
    position = complex(place)
    target = Target(position=position) if old is None else replace(old, position=position)
    return replace(pose, targets={**pose.targets, handle.id: target})


def free_name(figure: Figure) -> str:
    """Return a name that no handle has, for the next handle."""
    taken = {handle.name for handle in figure.handles}
    return numbered("handle", taken, figure.next_handle + 1)
