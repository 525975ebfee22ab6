"""What is clipped by what: a figure or a group, with all that is seen only where it is."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

from app.document.figure import Figure
from app.document.layering import paths_to
from app.document.model import Document


class Stack(NamedTuple):
    """The ids of a figure, or of those of a group, and of what is clipped by it in front of it."""

    base: tuple[int, ...]
    cut: tuple[int, ...]
    units: tuple[int | str, ...]  # the same: a figure by its id, a group by its path


def runs(figures: Sequence[Figure], depth: int) -> list[tuple[str, list[Figure]]]:
    """Return figures that follow each other in one group, with its path; "" of others, each.

    All are in the same groups down to the depth.
    """
    found: list[tuple[str, list[Figure]]] = []
    for figure in figures:
        path = "".join(paths_to(figure.group)[depth : depth + 1])
        if not (path and found and found[-1][0] == path):
            found.append((path, []))
        found[-1][1].append(figure)
    return found


def stacks(document: Document) -> tuple[Stack, ...]:
    """Return what is clipped by what as the figures lie in a document."""
    return tuple(_stacks(document, document.figures, 0))


def seen_alone(document: Document, identities: Collection[int]) -> Document:
    """Return a document in which some figures, by their ids, are not clipped by what is no such."""
    free = {
        unit
        for stack in stacks(document)
        if not any(each in identities for each in stack.base)
        for unit in stack.units
    }
    if not free:
        return document
    figures = tuple(
        replace(each, clipped=False) if each.id in free else each for each in document.figures
    )
    groups = tuple(
        replace(group, clipped=False) if group.name in free else group for group in document.groups
    )
    return replace(document, figures=figures, groups=groups)


def _stacks(document: Document, figures: Sequence[Figure], depth: int) -> Iterator[Stack]:
    base: tuple[int, ...] = ()
    cut: list[int] = []
    units: list[int | str] = []
    for path, run in runs(figures, depth):
        if path:
            yield from _stacks(document, run, depth + 1)
        identities = tuple(figure.id for figure in run)
        if document.group(path).clipped if path else run[0].clipped:
            cut += identities
            units.append(path or run[0].id)
            continue
        if base and cut:
            yield Stack(base, tuple(cut), tuple(units))
        base, cut, units = identities, [], []
    if base and cut:
        yield Stack(base, tuple(cut), tuple(units))
