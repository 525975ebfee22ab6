"""Which layers are composited together before they meet what lies behind them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, NamedTuple, TypeVar

from app.document.layer import Layer
from app.document.layers import BlendMode
from app.document.model import Document
from app.document.queries.layers.clipping import group_runs
from app.document.queries.layers.layer_state import layers_in_draw_order, opacity_at

Drawn = TypeVar("Drawn")


@dataclass(frozen=True, slots=True)
class CompositeGroup(Generic[Drawn]):
    """What is painted over each other first, and then over all that lies behind, as one."""

    parts: tuple["Drawn | CompositeGroup[Drawn]", ...]  # from back to front
    opacity: float = 1.0  # in [0, 1]
    blend: BlendMode = "normal"
    # Whether it is painted only where that is which lies behind it in the composite around it, as
    # if that were opaque there.
    clipped: bool = False
    # Whether its parts are painted over what lies behind at once, and that is faded in then.
    is_pass_through: bool = False

    @property
    def is_plain(self) -> bool:
        """Whether its parts could as well be painted one by one."""
        return (
            self.opacity == 1
            and self.blend == "normal"
            and not (self.clipped or self.needs_backdrop)
        )

    @property
    def needs_backdrop(self) -> bool:
        """Whether it matters to its parts what lies behind, other than that they cover it."""
        return any(
            isinstance(each, CompositeGroup) and (each.blend != "normal" or each.is_pass_through)
            for each in self.parts
        )


@dataclass(slots=True)
class _ClipUnit(Generic[Drawn]):
    """A layer or a run of a group, and what is cut by it."""

    whole: CompositeGroup[Drawn]
    is_pass_through: bool = False  # whether its parts meet what lies behind it
    clipped: list[CompositeGroup[Drawn]] = field(default_factory=list)


def composite_layers(
    document: Document, drawn: Mapping[int, Drawn], frame: float
) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return how what is drawn of layers is composited at a frame, from back to front.

    Parameters
    ----------
    drawn : mapping of int to Drawn
        By the ids of the layers that are seen. Of a group's layers each run without others
        between is composited by itself; what is cut by something that is not seen is not, either.
    frame : float
        It tells the order of the layers, and how opaque they are.
    """
    opacities = {layer.id: opacity_at(document, layer, frame) for layer in document.layers}
    return _parts(_Painted(document, drawn, opacities), layers_in_draw_order(document, frame), 0)


class _Painted(NamedTuple, Generic[Drawn]):
    """What is drawn of the layers of a document, and how opaque they are, by their ids."""

    document: Document
    drawn: Mapping[int, Drawn]
    opacities: Mapping[int, float]


def _parts(
    given: _Painted[Drawn], layers: Sequence[Layer], depth: int
) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the parts of layers that are in the same groups down to this depth."""
    units: list[_ClipUnit[Drawn]] = []
    for path, run in group_runs(layers, depth):
        unit: _ClipUnit[Drawn]
        if path:
            group, inner = given.document.group(path), _parts(given, run, depth + 1)
            blend: BlendMode = "normal" if group.blend == "pass-through" else group.blend
            whole = CompositeGroup(inner, group.opacity, blend, group.clipped)
            unit = _ClipUnit(whole, is_pass_through=group.blend == "pass-through")
        else:
            (layer,) = run
            seen = (given.drawn[layer.id],) if layer.id in given.drawn else ()
            opacity = given.opacities[layer.id]
            unit = _ClipUnit(CompositeGroup(seen, opacity, layer.blend, layer.clipped))
        if unit.whole.clipped and units and not units[-1].whole.clipped:
            units[-1].clipped.append(unit.whole)
        else:
            units.append(unit)
    return tuple(part for unit in units for part in _painted(unit))


def _painted(unit: _ClipUnit[Drawn]) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the parts that a unit is painted by: its own, or one."""
    # With nothing below it, it is cut by nothing.
    whole = CompositeGroup(unit.whole.parts, unit.whole.opacity, unit.whole.blend)
    cut = [each for each in unit.clipped if each.parts]
    if not whole.parts:
        return ()
    if cut:
        return (CompositeGroup((*whole.parts, *cut), whole.opacity, whole.blend),)
    if unit.is_pass_through and whole.opacity == 1:
        return whole.parts
    if unit.is_pass_through and whole.needs_backdrop:
        return (replace(whole, is_pass_through=True),)
    return whole.parts if whole.is_plain else (whole,)
