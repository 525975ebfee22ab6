"""Clipping: the base layer or group, and the layers and groups clipped to it."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from app.document.layer import Layer
from app.document.layers.groups import ancestor_paths
from app.document.model import Document


class ClipStack(NamedTuple):
    """Layer ids of a clipping base and of the layers in front that are clipped to it."""

    base: tuple[int, ...]
    clipped: tuple[int, ...]
    units: tuple[int | str, ...]  # the clipped layers by id and the clipped groups by path


def group_runs(layers: Sequence[Layer], depth: int) -> list[tuple[str, list[Layer]]]:
    """Return runs of consecutive layers of one group with its path; "" for each ungrouped layer.

    All layers are in the same groups down to the depth.
    """
    found: list[tuple[str, list[Layer]]] = []
    for layer in layers:
        path = "".join(ancestor_paths(layer.group)[depth : depth + 1])
        if not (path and found and found[-1][0] == path):
            found.append((path, []))
        found[-1][1].append(layer)
    return found


def clip_stacks(document: Document) -> tuple[ClipStack, ...]:
    """Return the clipping bases of a document with their clipped layers."""
    drawn = [each for each in document.layers if not document.is_deform_group(each.id)]
    return tuple(_clip_stacks(document, drawn, 0))


def without_foreign_clips(document: Document, identities: Collection[int]) -> Document:
    """Return a copy in which layers are not clipped if their base is not among these ids."""
    free = {
        unit
        for stack in clip_stacks(document)
        if not any(each in identities for each in stack.base)
        for unit in stack.units
    }
    if not free:
        return document
    layers = tuple(
        replace(each, clipped=False) if each.id in free else each for each in document.layers
    )
    groups = tuple(
        replace(group, clipped=False) if group.name in free else group for group in document.groups
    )
    return replace(document, layers=layers, groups=groups)


def _clip_stacks(document: Document, layers: Sequence[Layer], depth: int) -> Iterator[ClipStack]:
    base: tuple[int, ...] = ()
    cut: list[int] = []
    units: list[int | str] = []
    for path, run in group_runs(layers, depth):
        if path:
            yield from _clip_stacks(document, run, depth + 1)
        identities = tuple(layer.id for layer in run)
        if document.group(path).clipped if path else run[0].clipped:
            cut += identities
            units.append(path or run[0].id)
            continue
        if base and cut:
            yield ClipStack(base, tuple(cut), tuple(units))
        base, cut, units = identities, [], []
    if base and cut:
        yield ClipStack(base, tuple(cut), tuple(units))
