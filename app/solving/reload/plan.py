"""What a changed file of a drawing changes in a document, before anything is changed."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from enum import Enum

from app.document import Document, DrawingFile, FileLayer, Layer, LayerOrigin
from app.errors import LissomError
from app.solving.reload.alignment import PlacedPicture
from app.solving.reload.canvas import find_canvas
from app.solving.reload.file_groups import FileGroups
from app.solving.reload.margin import has_margin_of
from app.solving.reload.matching import match_layers
from app.solving.reload.pictures import PictureChange, compare_pictures, picture_digest
from app.storage import ImportedLayer, LayeredPicture, Picture, run_parallel
from app.texts import N_, _

UNKNOWN_FILE = N_(
    "{name} is none of this project's drawings: {known}. Give the changed file the name of its "
    "drawing."
)
UNCHANGED = PictureChange(is_redrawn=False, shift=0j)
NO_MATCH = N_("none of the layers of {name} is in this project")


class Change(Enum):
    """What happened to a layer in its file."""

    SAME = N_("same")
    REDRAWN = N_("redrawn")
    MOVED = N_("moved")
    REDRAWN_AND_MOVED = N_("redrawn and moved")
    NEW = N_("new")
    GONE = N_("gone")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LayerChange:
    """The change of a layer of the document, or a new layer of the file."""

    name: str  # in the document; of a new layer, in the file
    layer: int | None = None  # id in the document; None for a new layer
    imported: ImportedLayer | None = None  # as it is now; None for a layer that is gone
    index: int = -1  # in the changed file; -1 for a layer that is gone
    change: Change
    shift: complex = 0j  # of the artwork on the canvas
    corner: complex = 0j  # of the new picture on the canvas
    renamed: str = ""  # the new name in the file, if it changed
    regrouped: str | None = None  # the new group in the file, if it changed

    @property
    def is_redrawn(self) -> bool:
        return self.change in {Change.REDRAWN, Change.REDRAWN_AND_MOVED}


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class ReloadPlan:
    """All changes of a file, and where its canvas lies."""

    document: Document
    before: DrawingFile
    now: DrawingFile  # with missing layers at the end
    matches: Mapping[int, int]  # present index of a layer by its former index
    changes: tuple[LayerChange, ...]  # from the front
    pictures: Mapping[int, Picture]  # before, by layer id
    scene_shift: complex = 0j  # of the whole scene, because the canvas changed
    is_whole: bool = True  # whether all layers are reloaded, and not only some

    @property
    def groups(self) -> FileGroups:
        return FileGroups(self.before, self.now, self.matches)

    @property
    def is_empty(self) -> bool:
        """Whether the file's layers and groups are as before."""
        is_same = all(each.change is Change.SAME for each in self.changes)
        was = (self.before.layers, self.before.groups, self.before.size)
        return is_same and was == (self.now.layers, self.now.groups, self.now.size)

    def count(self, *changes: Change) -> int:
        return sum(each.change in changes for each in self.changes)


def find_drawing(document: Document, name: str) -> DrawingFile:
    """Return the drawing of a document that a file with this name replaces.

    A project of an earlier version has no drawings; then all its layers count as one drawing.
    """
    if not document.drawings:
        return DrawingFile(
            id=0,
            name=name,
            sha256="",
            size=document.canvas,
            layers=tuple(
                FileLayer(
                    name=layer.name.removeprefix(f"{layer.group}/"),
                    group=layer.group,
                    opacity=layer.opacity,
                    blend=layer.blend,
                    clipped=layer.clipped,
                    hidden=layer.hidden,
                )
                for layer in document.layers
                if not document.is_deform_group(layer.id)
            ),
            groups=document.groups,
        )
    if len(document.drawings) == 1:
        return document.drawings[0]
    for drawing in document.drawings:
        if drawing.name == name:
            return drawing
    known = ", ".join(drawing.name for drawing in document.drawings)
    raise LissomError(_(UNKNOWN_FILE).format(name=name, known=known))


def with_origins(document: Document, drawing: DrawingFile) -> Document:
    """Return the document with a drawing that was not noted in it, whose layers are all its."""
    if drawing in document.drawings:
        return document
    drawn = [layer for layer in document.layers if not document.is_deform_group(layer.id)]
    origins = {
        layer.id: LayerOrigin(drawing=drawing.id, index=index) for index, layer in enumerate(drawn)
    }
    layers = tuple(replace(layer, origin=origins.get(layer.id)) for layer in document.layers)
    return replace(document, layers=layers, drawings=(drawing,))


def plan_reload(
    document: Document,
    drawing: DrawingFile,
    changed: LayeredPicture,
    pictures: Mapping[int, Picture],
    *,
    only: Collection[int] | None = None,
) -> ReloadPlan:
    """Compare a changed file with the layers that came from it.

    Parameters
    ----------
    pictures : mapping of int to Picture
        The decoded pictures of the document's layers, by layer id.
    only : collection of int, optional
        Ids of the layers to reload; by default all, and new layers of the file are added.

    Raises
    ------
    LissomError
        If the file has none of the layers.
    """
    document = with_origins(document, drawing)
    shown: dict[int, list[Layer]] = {}
    for layer in document.layers:
        if layer.origin is not None and layer.origin.drawing == drawing.id:
            shown.setdefault(layer.origin.index, []).append(layer)
    first = [layers[0].id for layers in shown.values()]
    news = [each.picture.rgba for each in changed.layers]
    olds = [pictures[identity].rgba for identity in first]
    digests = run_parallel(picture_digest, [*olds, *news], ((0, 0),))
    digest_of = dict(zip(shown, digests[: len(olds)], strict=True))
    present = digests[len(olds) :]
    now = changed.drawing_file(drawing.id)
    is_single = len(drawing.layers) == len(now.layers) == 1
    matches = (
        {0: 0}
        if is_single
        else match_layers(
            drawing.layers,
            now.layers,
            lambda one, other: digest_of.get(one) == present[other],
        )
    )
    if not any(index in shown for index in matches):
        raise LissomError(_(NO_MATCH).format(name=changed.file_name))
    missing = [index for index in range(len(drawing.layers)) if index not in matches]
    pairs = [(shown[index][0], other) for index, other in matches.items() if index in shown]
    corner, scene_shift = find_canvas(document, drawing, changed, pictures, pairs)
    if only is not None:
        scene_shift = 0j
    gone = tuple(replace(drawing.layers[index], is_missing=True) for index in missing)
    now = replace(
        now, corner=corner, layers=now.layers + gone, is_merged=drawing.is_merged,
        unknown=drawing.unknown,
    )  # fmt: skip
    found = [
        (layer, index, matches.get(index))
        for index, layers in shown.items()
        for layer in layers
        if (only is None or layer.id in only)
        # A layer that was missing before, and still is, has not changed.
        and not (drawing.layers[index].is_missing and index not in matches)
    ]
    comparison = _Comparison(drawing, changed, pictures, scene_shift, corner)
    changes = run_parallel(
        comparison.change_of,
        found,
        (picture.size for picture in pictures.values()),
    )
    if only is None:
        known = set(matches.values())
        changes += [
            LayerChange(
                name=imported.name,
                imported=imported,
                index=index,
                change=Change.NEW,
                corner=imported.corner + corner,
            )
            for index, imported in enumerate(changed.layers)
            if index not in known
        ]
    order = {layer.id: place for place, layer in enumerate(document.layers)}
    changes.sort(key=lambda each: -order.get(-1 if each.layer is None else each.layer, len(order)))
    return ReloadPlan(
        document=document,
        before=drawing,
        now=now,
        matches=matches,
        changes=tuple(changes),
        pictures=pictures,
        scene_shift=scene_shift,
        is_whole=only is None,
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Comparison:
    """Compares layers with a changed file, whose canvas has this corner after the scene's shift."""

    drawing: DrawingFile
    changed: LayeredPicture
    pictures: Mapping[int, Picture]
    scene_shift: complex
    corner: complex

    def change_of(self, found: tuple[Layer, int, int | None]) -> LayerChange:
        """Return the change of a layer with this former and present index."""
        layer, index, other = found
        if other is None:
            return LayerChange(name=layer.name, layer=layer.id, change=Change.GONE)
        imported, was = self.changed.layers[other], self.drawing.layers[index]
        corner = imported.corner + self.corner
        old = PlacedPicture(self.pictures[layer.id].rgba, layer.corner + self.scene_shift)
        new = PlacedPicture(imported.picture.rgba, corner)
        change = compare_pictures(old, new)
        if change.is_redrawn and has_margin_of(old, new):
            change = UNCHANGED  # the margin was added here
        kinds = {
            (False, False): Change.SAME,
            (False, True): Change.MOVED,
            (True, False): Change.REDRAWN,
            (True, True): Change.REDRAWN_AND_MOVED,
        }
        now = imported.file_layer
        return LayerChange(
            name=layer.name,
            layer=layer.id,
            imported=imported,
            index=other,
            change=kinds[change.is_redrawn, bool(change.shift)],
            shift=change.shift,
            corner=corner,
            renamed=now.name if now.name != was.name else "",
            regrouped=now.group if now.group != was.group else None,
        )
