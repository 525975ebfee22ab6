"""Which figures are composited together before they meet what lies behind them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Generic, TypeVar

from app.document.figure import Figure
from app.document.layering import BlendMode, Group, paths_to
from app.document.model import Document

Drawn = TypeVar("Drawn")


@dataclass(frozen=True, slots=True)
class Composite(Generic[Drawn]):
    """What is painted over each other first, and then over all that lies behind, as one."""

    parts: tuple["Drawn | Composite[Drawn]", ...]  # from back to front
    opacity: float = 1.0  # in [0, 1]
    blend: BlendMode = "normal"


def composed(
    document: Document, drawn: Sequence[tuple[Figure, Drawn]]
) -> tuple[Drawn | Composite[Drawn], ...]:
    """Return how what is drawn of figures is composited, from back to front.

    Parameters
    ----------
    drawn : sequence of (Figure, Drawn)
        From back to front; of a group's figures each run without others between is composited by
        itself.
    """
    return _parts(document, drawn, 0)


def _parts(
    document: Document, drawn: Sequence[tuple[Figure, Drawn]], depth: int
) -> tuple[Drawn | Composite[Drawn], ...]:
    """Return the parts of what lies so deep in groups that are taken care of."""
    parts: list[Drawn | Composite[Drawn]] = []
    for path, run in _runs(drawn, depth):
        if not path:
            parts += [_faded(figure, each) for figure, each in run]
            continue
        inner = _parts(document, run, depth + 1)
        parts += _together(document.group(path), inner)
    return tuple(parts)


def _together(
    group: Group, parts: tuple[Drawn | Composite[Drawn], ...]
) -> tuple[Drawn | Composite[Drawn], ...]:
    """Return the parts of a group as one, or as they are where that comes to the same."""
    meets_more = any(isinstance(part, Composite) and part.blend != "normal" for part in parts)
    blend: BlendMode = "normal" if group.blend == "pass-through" else group.blend
    is_apart = blend != "normal" or (meets_more and group.blend == "normal")
    return (Composite(parts, group.opacity, blend),) if is_apart or group.opacity < 1 else parts


def _runs(
    drawn: Sequence[tuple[Figure, Drawn]], depth: int
) -> list[tuple[str, list[tuple[Figure, Drawn]]]]:
    """Return what follows each other in one group, with its path; "" outside of such."""
    runs: list[tuple[str, list[tuple[Figure, Drawn]]]] = []
    for figure, each in drawn:
        path = "".join(paths_to(figure.group)[depth : depth + 1])
        if not runs or runs[-1][0] != path:
            runs.append((path, []))
        runs[-1][1].append((figure, each))
    return runs


def _faded(figure: Figure, drawn: Drawn) -> Drawn | Composite[Drawn]:
    if figure.opacity == 1 and figure.blend == "normal":
        return drawn
    return Composite((drawn,), figure.opacity, figure.blend)
