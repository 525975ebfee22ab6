"""Grouping of layers that are composited before they blend with their backdrop."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, Generic, NamedTuple, TypeVar

from app.document.channels.kind import Channel
from app.document.channels.kinds import LAYER_KINDS
from app.document.layer import Layer
from app.document.layers.groups import BlendMode, Group, ancestor_paths
from app.document.model import Document
from app.document.queries.channel_values.values_at import layers_in_draw_order, opacity_at, value_at
from app.document.queries.layers.clipping import group_runs

Drawn = TypeVar("Drawn")
NO_EFFECTS: Mapping[str, Any] = MappingProxyType({})
# Values that leave a layer unchanged, by uniform.
DEFAULT_EFFECTS: Mapping[str, Any] = MappingProxyType(
    {kind.uniform: kind.default for kind in LAYER_KINDS.values() if kind.uniform}
)


@dataclass(frozen=True, slots=True)
class CompositeGroup(Generic[Drawn]):
    """Parts that are composited first; the result then blends with the backdrop."""

    parts: tuple["Drawn | CompositeGroup[Drawn]", ...]  # from back to front
    opacity: float = 1.0  # in [0, 1]
    blend: BlendMode = "normal"
    # Whether the group is visible only within the alpha of its backdrop in the outer composite, and
    # blends with that backdrop as if it were opaque.
    clipped: bool = False
    # Values for the shader of the result, by uniform; others are in `DEFAULT_EFFECTS`.
    effects: Mapping[str, Any] = field(default_factory=lambda: NO_EFFECTS)
    # Pass-through group: its parts blend directly with the backdrop; the group's opacity is applied
    # to the result.
    is_pass_through: bool = False
    # Of a pass-through group: parts of others that lie between its own, and are not faded.
    kept: tuple["Drawn | CompositeGroup[Drawn]", ...] = ()

    @property
    def is_plain(self) -> bool:
        """Whether drawing the parts one by one gives the same result."""
        return (
            self.opacity == 1
            and self.blend == "normal"
            and not (self.clipped or self.needs_backdrop or self.effects)
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
    # Parts of others between the group's own.
    kept: tuple["Drawn | CompositeGroup[Drawn]", ...] = ()
    clipped: list[CompositeGroup[Drawn]] = field(default_factory=list)


def composite_layers(
    document: Document, drawn: Mapping[int, Drawn], frame: float
) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the compositing of drawn layers at a frame, from back to front.

    `drawn` has the visible layers by id. Each run of a group is composited separately; the
    runs of a faded group are composited as one. Layers clipped to an invisible base are invisible.
    """
    layers = [
        each
        for each in layers_in_draw_order(document, frame)
        if not document.is_deform_group(each.id)
    ]
    return _parts(_Painted(document, drawn, frame), layers, 0)


def _effects(document: Document, layer: Layer, frame: float) -> Mapping[str, Any]:
    """Return the values of a layer's effects that change how it looks, by uniform."""
    kinds = (LAYER_KINDS[name] for name, _part in layer.channels)
    values = {
        kind: value_at(document, Channel(kind, layer.id), frame) for kind in kinds if kind.uniform
    }
    return {kind.uniform: value for kind, value in values.items() if value != kind.default}


class _Painted(NamedTuple, Generic[Drawn]):
    """The drawn layers of a document at a frame, by id."""

    document: Document
    drawn: Mapping[int, Drawn]
    frame: float


def _parts(
    given: _Painted[Drawn], layers: Sequence[Layer], depth: int
) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the compositing of layers that share their groups down to this depth."""
    units: list[_ClipUnit[Drawn]] = []
    for path, run in _joined_runs(given.document, group_runs(layers, depth)):
        unit: _ClipUnit[Drawn]
        if path and any(path not in ancestor_paths(layer.group) for layer in run):
            unit = _parted_unit(given, path, run, depth)
        elif path:
            group, inner = given.document.group(path), _parts(given, run, depth + 1)
            blend = "normal" if group.blend == "pass-through" else group.blend
            whole = CompositeGroup(inner, group.opacity, blend, group.clipped)
            unit = _ClipUnit(whole, is_pass_through=group.blend == "pass-through")
        else:
            (layer,) = run
            seen = (given.drawn[layer.id],) if layer.id in given.drawn else ()
            document, frame = given.document, given.frame
            opacity, effects = opacity_at(document, layer, frame), _effects(document, layer, frame)
            whole = CompositeGroup(seen, opacity, layer.blend, layer.clipped, effects)
            unit = _ClipUnit(whole)
        if unit.whole.clipped and units and not units[-1].whole.clipped:
            units[-1].clipped.append(unit.whole)
        else:
            units.append(unit)
    return tuple(part for unit in units for part in _painted(unit))


def _joined_runs(
    document: Document, runs: Sequence[tuple[str, list[Layer]]]
) -> list[tuple[str, list[Layer]]]:
    """Join the runs of a faded group that others part, with what lies between them."""
    joined: list[tuple[str, list[Layer]]] = []
    rest = list(runs)
    while rest:
        path, run = rest.pop(0)
        last = max((place for place, (other, _) in enumerate(rest) if other == path), default=-1)
        inside = rest[: last + 1]
        is_clipped = any(
            document.group(other).clipped if other else others[0].clipped
            for other, others in inside
        )
        if path and inside and not is_clipped and _fades_plainly(document.group(path)):
            run = [*run, *(layer for _path, others in inside for layer in others)]
            rest = rest[last + 1 :]
        joined.append((path, run))
    return joined


def _fades_plainly(group: Group) -> bool:
    is_plain = group.blend in {"normal", "pass-through"} and not group.clipped
    return is_plain and group.opacity < 1


def _parted_unit(
    given: _Painted[Drawn], path: str, layers: Sequence[Layer], depth: int
) -> _ClipUnit[Drawn]:
    """Return a faded group whose layers others part: its parts are faded as one, the others not."""
    parts: list[Drawn | CompositeGroup[Drawn]] = []
    kept: list[Drawn | CompositeGroup[Drawn]] = []
    for own, run in group_runs(layers, depth):
        if own == path:
            parts += _parts(given, run, depth + 1)
            continue
        others = _parts(given, run, depth)
        parts += others
        kept += others
    whole = CompositeGroup(tuple(parts), given.document.group(path).opacity)
    return _ClipUnit(whole, is_pass_through=True, kept=tuple(kept))


def _painted(unit: _ClipUnit[Drawn]) -> tuple[Drawn | CompositeGroup[Drawn], ...]:
    """Return the parts of a unit: its own parts, or one group."""
    # Without a base below, a clipped layer is not clipped.
    whole = replace(unit.whole, clipped=False)
    cut = [each for each in unit.clipped if each.parts]
    if not whole.parts:
        return ()
    if cut:
        # Effects change the base alone, opacity and blend all that is clipped to it.
        base = whole.parts
        base = (CompositeGroup(base, effects=whole.effects),) if whole.effects else base
        return (CompositeGroup((*base, *cut), whole.opacity, whole.blend),)
    if unit.kept:
        return (replace(whole, is_pass_through=True, kept=unit.kept),)
    if unit.is_pass_through and whole.opacity == 1:
        return whole.parts
    if unit.is_pass_through and whole.needs_backdrop:
        return (replace(whole, is_pass_through=True),)
    return whole.parts if whole.is_plain else (whole,)
