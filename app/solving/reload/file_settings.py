"""Settings, names, groups, order and closed seams of layers that changed in a file."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from PIL import Image

from app.document import Document, DrawingFile, Layer, LayerOrigin, layer_commands
from app.solving.reload.alignment import PlacedPicture
from app.solving.reload.file_groups import FileGroups, group_for
from app.solving.reload.margin import extend_under
from app.solving.reload.plan import LayerChange, ReloadPlan
from app.storage import Picture, encode_png

SETTINGS = ("opacity", "blend", "clipped", "hidden")


def with_file_settings(
    document: Document,
    plan: ReloadPlan,
    groups: FileGroups,
    paths: Mapping[str, str],
    change: LayerChange,
) -> Document:
    """Return the document with the settings of a layer that changed in the file.

    Changes that were made in the document stay. A layer that is gone is hidden, but a switch goes
    on to decide its visibility.
    """
    if change.layer is None:
        return document
    layer = document.layer(change.layer)
    if layer.origin is None:
        return document
    if change.index < 0:
        is_switched = document.switch_group_of(layer.id) is not None
        return document if is_switched else document.with_layer(replace(layer, hidden=True))
    was, now = plan.before.layers[layer.origin.index], plan.now.layers[change.index]
    changes = {
        name: getattr(now, name)
        for name in SETTINGS
        if getattr(now, name) != getattr(was, name) == getattr(layer, name)
    }
    if was.is_missing:
        changes["hidden"] = now.hidden
    if change.renamed and _has_name_of_file(layer, was.name):
        taken = {each.name for each in document.layers if each is not layer}
        changes["name"] = layer_commands.unique_name(change.renamed, taken)
    is_moved = change.regrouped is not None and change.regrouped != groups.present_path(was.group)
    if is_moved and layer.group == paths.get(was.group, ""):
        document, changes["group"] = group_for(document, groups, paths, change.regrouped or "")
    return document.with_layer(replace(layer, **changes)) if changes else document


def _has_name_of_file(layer: Layer, name: str) -> bool:
    """Return whether a layer has the name that it had in its file, maybe with a number."""
    own = layer.name.removeprefix(f"{layer.group}/")
    return own == name or own.removeprefix(f"{name} ").isdecimal()


def with_file_order(document: Document, plan: ReloadPlan) -> Document:
    """Return the document with its layers in the file's order, if that changed only in the file."""
    places = [
        place
        for place, layer in enumerate(document.layers)
        if layer.origin is not None
        and layer.origin.drawing == plan.before.id
        and layer.origin.index in plan.matches
    ]
    before = [document.layers[place].origin.index for place in places]  # type: ignore[union-attr]
    now = [plan.matches[index] for index in before]
    if before != sorted(before) or now == sorted(now):
        return document
    layers = list(document.layers)
    ordered = sorted(zip(now, places, strict=True))
    for place, (_index, source) in zip(places, ordered, strict=True):
        layers[place] = document.layers[source]
    return replace(document, layers=tuple(layers), size=document.canvas)


def with_new_origins(document: Document, plan: ReloadPlan) -> Document:
    """Return the document whose layers refer to the changed file."""
    missing = [index for index in range(len(plan.before.layers)) if index not in plan.matches]
    present = len(plan.now.layers) - len(missing)

    def updated(layer: Layer) -> Layer:
        origin = layer.origin
        if origin is None or origin.drawing != plan.before.id:
            return layer
        index = plan.matches.get(origin.index)
        if index is None:
            index = present + missing.index(origin.index)
        return (
            layer
            if index == origin.index
            else replace(layer, origin=LayerOrigin(drawing=origin.drawing, index=index))
        )

    return with_drawing(replace(document, layers=tuple(map(updated, document.layers))), plan.now)


def with_reloaded_layers(document: Document, plan: ReloadPlan) -> Document:
    """Return the document with a drawing of which only some layers are those of the new file."""
    layers = list(plan.before.layers)
    for change in plan.changes:
        origin = None if change.layer is None else document.layer(change.layer).origin
        if origin is not None and change.index >= 0:
            layers[origin.index] = replace(plan.now.layers[change.index], is_missing=False)
    return with_drawing(document, replace(plan.before, layers=tuple(layers)))


def with_drawing(document: Document, drawing: DrawingFile) -> Document:
    """Return the document with another version of a drawing."""
    drawings = tuple(drawing if each.id == drawing.id else each for each in document.drawings)
    return replace(document, drawings=drawings)


def with_new_layers(
    document: Document,
    plan: ReloadPlan,
    groups: FileGroups,
    paths: Mapping[str, str],
    new: Sequence[tuple[LayerChange, Layer]],
) -> Document:
    """Return the document with the new layers of a file, in the order and groups of the file."""
    for change, made in sorted(new, key=lambda each: each[0].index):
        document, group = group_for(document, groups, paths, plan.now.layers[change.index].group)
        layer = replace(
            made,
            id=layer_commands.next_layer_id(document),
            name=layer_commands.unique_layer_name(document, made.name),
            group=group,
            origin=LayerOrigin(drawing=plan.now.id, index=change.index),
        )
        layers = list(document.layers)
        layers.insert(_place_of(document, plan, change.index), layer)
        document = replace(document, layers=tuple(layers), size=document.canvas)
    return document


def _place_of(document: Document, plan: ReloadPlan, index: int) -> int:
    """Return the place of a new layer: in front of the next layer behind it in the file."""
    origins = [
        (layer.origin.index, place)
        for place, layer in enumerate(document.layers)
        if layer.origin is not None and layer.origin.drawing == plan.now.id
    ]
    behind = [each for each in origins if each[0] < index]
    if behind:
        return max(behind)[1] + 1
    return min((place for _index, place in origins), default=len(document.layers))


def close_seam_again(plan: ReloadPlan, change: LayerChange) -> LayerChange:
    """Return the change of a redrawn layer with its picture extended as the earlier one was."""
    imported = change.imported
    before = None if change.layer is None else plan.document.find_layer(change.layer)
    if not change.is_redrawn or imported is None or before is None or before.closed_seam is None:
        return change
    front = _placed(plan, before.closed_seam)
    own = PlacedPicture(imported.picture.rgba, change.corner)
    grown = None if front is None else extend_under(own, front)
    if grown is None:
        return change
    data = encode_png(Image.fromarray(grown.rgba))
    picture = Picture(rgba=grown.rgba)
    return replace(
        change, imported=replace(imported, data=data, picture=picture), corner=grown.corner
    )


def _placed(plan: ReloadPlan, identity: int) -> PlacedPicture | None:
    """Return a layer's picture as it is after the reload; None if the layer is gone."""
    layer = plan.document.find_layer(identity)
    if layer is None:
        return None
    change = next((each for each in plan.changes if each.layer == identity), None)
    if change is not None and change.is_redrawn and change.imported is not None:
        return PlacedPicture(change.imported.picture.rgba, change.corner)
    shift = 0j if change is None else change.shift
    return PlacedPicture(plan.pictures[identity].rgba, layer.corner + shift)
