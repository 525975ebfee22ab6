"""What is clipped by what: a layer or a group, with all that is seen only where it is."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from app.document.layer import Layer
from app.document.layers import ancestor_paths
from app.document.model import Document


class ClipStack(NamedTuple):
    """The ids of a layer, or of those of a group, and of what is clipped by it in front of it."""

    base: tuple[int, ...]
    clipped: tuple[int, ...]
    units: tuple[int | str, ...]  # the same: a layer by its id, a group by its path


def group_runs(layers: Sequence[Layer], depth: int) -> list[tuple[str, list[Layer]]]:
    """Return layers that follow each other in one group, with its path; "" of others, each.

    All are in the same groups down to the depth.
    """
    found: list[tuple[str, list[Layer]]] = []
    for layer in layers:
        path = "".join(ancestor_paths(layer.group)[depth : depth + 1])
        if not (path and found and found[-1][0] == path):
            found.append((path, []))
        found[-1][1].append(layer)
    return found


def clip_stacks(document: Document) -> tuple[ClipStack, ...]:
    """Return what is clipped by what as the layers lie in a document."""
    return tuple(_clip_stacks(document, document.layers, 0))


def without_foreign_clips(document: Document, identities: Collection[int]) -> Document:
    """Return a document in which some layers, by their ids, are not clipped by what is no such."""
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
