"""Commands on handles. None of them changes a map: whatever is shown stays as it is."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from app.document.commands import command
from app.document.keyframe import Handle, Keyframe, Target
from app.document.model import Document


@command("Add handle")
def add_handle(
    document: Document, position: complex, *, name: str | None = None, weight: float = 1.0
) -> Document:
    """Add a handle at a point of the picture; each key's target is where its map takes the point.

    Parameters
    ----------
    document : Document
    position : complex
        In pixels of the picture at rest, y up, on the shape.
    name : str, optional
        "handle 1" and so on by default. The new handle's id is `document.next_handle`.
    weight : float
        How strongly it pulls, relative to others.
    """
    handle = Handle(
        id=document.next_handle,
        name=_free_name(document) if name is None else name,
        position=position,
        weight=weight,
    )
    return replace(
        document,
        handles=(*document.handles, handle),
        next_handle=handle.id + 1,
        keys=_follow(document, handle),
    )


@command("Move handle")
def move_handle(document: Document, identity: int, position: complex) -> Document:
    """Put a handle elsewhere on the picture; its targets become where that point is now."""
    if document.handle(identity).position == position:
        return document
    handle = replace(document.handle(identity), position=position)
    return replace(_with_handle(document, handle), keys=_follow(document, handle))


@command("Delete handle")
def remove_handles(document: Document, identities: Collection[int]) -> Document:
    """Remove handles by their ids. The poses stay."""
    gone = {document.handle(identity).id for identity in identities}
    if not gone:
        return document
    keys = []
    for key in document.keys:
        targets = {i: target for i, target in key.pose.targets.items() if i not in gone}
        keys.append(replace(key, pose=replace(key.pose, targets=targets)))
    handles = tuple(handle for handle in document.handles if handle.id not in gone)
    return replace(document, handles=handles, keys=tuple(keys))


@command("Rename handle")
def rename_handle(document: Document, identity: int, name: str) -> Document:
    """Give a handle another name."""
    if document.handle(identity).name == name:
        return document
    return _with_handle(document, replace(document.handle(identity), name=name))


@command("Set handle weight")
def weigh_handle(document: Document, identity: int, weight: float) -> Document:
    """Let a handle pull more or less strongly in poses that are solved from now on."""
    if document.handle(identity).weight == weight:
        return document
    return _with_handle(document, replace(document.handle(identity), weight=weight))


def _with_handle(document: Document, changed: Handle) -> Document:
    handles = tuple(changed if handle.id == changed.id else handle for handle in document.handles)
    return replace(document, handles=handles)


def _follow(document: Document, handle: Handle) -> tuple[Keyframe, ...]:
    """Return the keys with the handle's targets where their maps take its place."""
    place = np.array([handle.position], dtype=np.complex128)
    keys = []
    for key in document.keys:
        old = key.pose.targets.get(handle.id)
        position = complex(document.map_of(key.pose)(place)[0])
        target = Target(position=position, rotation=None if old is None else old.rotation)
        targets = {**key.pose.targets, handle.id: target}
        keys.append(replace(key, pose=replace(key.pose, targets=targets)))
    return tuple(keys)


def _free_name(document: Document) -> str:
    taken = {handle.name for handle in document.handles}
    number = document.next_handle + 1
    while f"handle {number}" in taken:
        number += 1
    return f"handle {number}"
