"""Grouping of layers that are composited before they blend with their backdrop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Generic, NamedTuple, TypeVar

from app.document.layer import Layer
from app.document.layers.groups import BlendMode
from app.document.model import Document
from app.document.queries.layers.clipping import group_runs
from app.document.queries.layers.layer_state import layers_in_draw_order, opacity_at

Drawn = TypeVar("Drawn")


@dataclass(frozen=True, slots=True)
class CompositeGroup(Generic[Drawn]):
    """Parts that are composited first; the result then blends with the backdrop."""

    parts: tuple["Drawn | CompositeGroup[Drawn]", ...]  # from back to front
    opacity: float = 1.0  # in [0, 1]
    blend: BlendMode = "normal"
    # Whether the group is visible only within the alpha of its backdrop in the outer composite, and
    # blends with that backdrop as if it were opaque.
    clipped: bool = False
    # Pass-through group: its parts blend directly with the backdrop; the group's opacity is applied
    # to the result.
    is_pass_through: bool = False

    @property
    def is_plain(self) -> bool:
        """Whether drawing the parts one by one gives the same result."""
        return (
            self.opacity == 1
            and self.blend == "normal"
            and not (self.clipped or self.needs_backdrop)
        )

    @property
    def needs_backdrop(self) -> bool:
        """Whether the colours of the parts depend on the backdrop other than by covering it."""
        return any(
            isinstance(each, CompositeGroup) and (each.blend != "normal" or each.is_pass_through)
            for each in self.parts
        )


@dataclass(slots=True)
class _ClipUnit(Generic[Drawn]):
    """A layer or a run of a group, with the layers and groups clipped to it."""

    whole: CompositeGroup[Drawn]
    is_pass_through: bool = False  # whether the parts blend directly with the backdrop
    clipped: list[CompositeGroup[Drawn]] = field(default_factory=list)


def composite_layers(
    document: Document, drawn: Mapping[int, Drawn], frame: float
) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the compositing of drawn layers at a frame, from back to front.

    `drawn` has the visible layers by id. Each run of a group is composited separately. Layers
    clipped to an invisible base are invisible.
    """
    opacities = {layer.id: opacity_at(document, layer, frame) for layer in document.layers}
    return _parts(_Painted(document, drawn, opacities), layers_in_draw_order(document, frame), 0)


class _Painted(NamedTuple, Generic[Drawn]):
    """The drawn layers of a document and their opacities, by id."""

    document: Document
    drawn: Mapping[int, Drawn]
    opacities: Mapping[int, float]


def _parts(
    given: _Painted[Drawn], layers: Sequence[Layer], depth: int
) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the compositing of layers that share their groups down to this depth."""
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
    """Return the parts of a unit: its own parts, or one group."""
    # Without a base below, a clipped layer is not clipped.
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
