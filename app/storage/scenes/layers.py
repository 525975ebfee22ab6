"""Layers of one scene, from a layered drawing or from several pictures."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from app.cut_out import CutOut, build_picture_domain
from app.document import (
    Document,
    ExportSettings,
    Framing,
    Layer,
    Meshing,
    PictureFile,
    new_layer,
)
from app.errors import EMPTY_IMPORT_LOG, LissomError, NoticeCollector, display_name, shortened
from app.storage.files.reading import read_file
from app.storage.pictures.layer_names import UniqueNames
from app.storage.pictures.layered import ImportedLayer, LayeredPicture, encode_png
from app.storage.pictures.openraster import read_krita, read_openraster
from app.storage.pictures.parallel import require_memory, run_parallel
from app.storage.pictures.photoshop import read_photoshop
from app.storage.pictures.picture import Picture, decode_pictures
from app.storage.scenes.flattening import flatten_layers
from app.storage.scenes.opening import OpenedScene, build_scene
from app.texts import N_, _, message_of
from engine.arrays import Bytes
from engine.domain import MeshedDomain, rectangle_domain
from engine.errors import EngineError

READERS = {
    ".ora": read_openraster,
    ".psd": read_photoshop,
    ".psb": read_photoshop,
    ".kra": read_krita,
}
LAYERED = tuple(READERS)
# Minimum per layer, however many layers share the triangles, and most of all minima together.
FEWEST_TRIANGLES = 4_000
MOST_TOGETHER = 1_000_000
NO_SHAPE = N_("none of its layers can be posed: {reason}")
WHOLE = CutOut(background="none")  # removes only transparent pixels
# Fields of a layer that belong to its picture, its handles and their motion.
DRAWN = (
    *("picture", "domain", "meshing", "cut_out", "is_stale", "still", "stiffness", "mirror"),
    *("handles", "next_handle", "has_auto_pins", "tracks", "springs", "bones", "library"),
    *("motions", "unread_motions", "variant", "bounds"),
)


def is_layered(path: Path) -> bool:
    """Return whether a file's name ends as that of a layered drawing."""
    return path.suffix.lower() in READERS


def read_layered(path: Path) -> LayeredPicture:
    data = read_file(path)
    try:
        return READERS[path.suffix.lower()](data)
    except LissomError as error:
        raise LissomError(
            _("cannot open {path}: {error}").format(path=path, error=error)
        ) from error


def open_layered(path: Path, meshing: Meshing, cut_out: CutOut = CutOut()) -> OpenedScene:
    """Read a layered drawing, and make a layer of each of its layers.

    A layer that is fully opaque, or without a shape, becomes a still picture. If this is true of
    all layers, each opens as a picture file does, with the `cut_out`. All layers together have as
    many triangles as one picture.
    """
    return _scene(read_layered(path), meshing, cut_out, is_cut_out=True)


def open_merged(path: Path, meshing: Meshing, cut_out: CutOut = CutOut()) -> OpenedScene:
    """Read a layered drawing as one picture: the merged one in the file, or its visible layers."""
    drawing = read_layered(path)
    require_memory([drawing.size])
    whole = _file_merged(drawing)
    import_log = EMPTY_IMPORT_LOG if whole is not None else drawing.summary
    merged = encode_png(Image.fromarray(_flattened(drawing) if whole is None else whole))
    opened = build_scene(merged, path.with_suffix(".png"), meshing, cut_out)
    count = len(drawing.layers)
    merged_layers = _("the {count} layers of {name} were merged into one drawing").format(
        count=count, name=path.name
    )
    notices = (merged_layers,) if count > 1 else ()
    document = replace(opened.document, import_log=import_log)
    return opened._replace(document=document, notices=notices + opened.notices)


def _file_merged(drawing: LayeredPicture) -> Bytes | None:
    """Return the merged picture that a file contains, drawn with all effects of its program.

    None without one: some programs write a picture of one colour in its place.
    """
    merged = drawing.merge()
    if merged is None or merged.size != drawing.size or (merged.rgba == merged.rgba[0, 0]).all():
        return None
    return merged.rgba


def _flattened(drawing: LayeredPicture) -> Bytes:
    layers = [
        _placed_layer(imported, index, _rectangle(imported.picture), Meshing(), WHOLE)
        for index, imported in enumerate(drawing.layers)
    ]
    textures = {index: imported.picture.rgba for index, imported in enumerate(drawing.layers)}
    return flatten_layers(_document(drawing, layers), textures, largest=max(drawing.size))


def open_pictures(paths: Sequence[Path], meshing: Meshing) -> OpenedScene:
    """Read several pictures, and make a layer of each, the first one at the back.

    The canvas has the size of the largest picture; the others are centred.
    """
    all_imported: list[ImportedLayer] = []
    names, collector = UniqueNames(), NoticeCollector()
    files = [(read_file(path), str(path)) for path in paths]
    pictures = decode_pictures(files)
    size = (
        max(picture.size[0] for picture in pictures),
        max(picture.size[1] for picture in pictures),
    )
    for path, (data, _name), picture in zip(paths, files, pictures, strict=True):
        name = names.claim(display_name(path.stem))
        corner = complex((size[0] - picture.size[0]) // 2, (size[1] - picture.size[1]) // 2)
        all_imported.append(ImportedLayer(name=name, data=data, picture=picture, corner=corner))
        for notice in picture.notices:
            collector.add_note(name, notice)
    drawing = LayeredPicture(size=size, layers=tuple(all_imported), summary=collector.import_log)
    return _scene(drawing, meshing, CutOut(), is_cut_out=False)


def make_posable_layer(
    imported: ImportedLayer,
    identity: int,
    meshing: Meshing,
    cut_out: CutOut = CutOut(),
    *,
    is_cut_out: bool,
) -> tuple[Layer, tuple[str, ...]]:
    """Return a posable layer of an imported layer, in its drawn place, with notices.

    With `is_cut_out`, transparency alone separates the subject, and a fully opaque layer becomes a
    still picture. Otherwise the `cut_out` separates it.
    """
    picture = imported.picture
    notices: tuple[str, ...] = (
        _("the picture is opaque everywhere, so there is no shape to pose"),
    )
    if not (is_cut_out and picture.is_opaque):
        cut_out = WHOLE if is_cut_out else cut_out
        try:
            domain, found = build_picture_domain(
                picture.rgba,
                triangles=meshing.triangles,
                detail=meshing.detail,
                cut_out=cut_out,
            )
            made = _placed_layer(imported, identity, domain, meshing, cut_out)
            return replace(made, still=False), tuple(map(message_of, found))
        except EngineError as error:
            notices = (_("cannot be posed: {reason}").format(reason=message_of(error)),)
    return _placed_layer(imported, identity, _rectangle(picture), meshing, WHOLE), notices


def _placed_layer(
    imported: ImportedLayer, identity: int, domain: MeshedDomain, meshing: Meshing, cut_out: CutOut
) -> Layer:
    """Return the still layer of an imported layer, in its drawn place."""
    picture = imported.picture
    file = PictureFile(data=imported.data, suffix=picture.suffix, size=picture.size)
    return replace(
        new_layer(file, domain.moved(imported.corner), meshing, cut_out),
        id=identity,
        name=imported.name,
        corner=imported.corner,
        still=True,
        hidden=not imported.visible,
        opacity=imported.opacity,
        blend=imported.blend,
        clipped=imported.clipped,
        group=imported.group,
    )


def _rectangle(picture: Picture) -> MeshedDomain:
    return rectangle_domain(*picture.size)


def make_still_picture(data: bytes, picture: Picture) -> Layer:
    """Return the layer of a still picture, with its lower left corner at 0."""
    file = PictureFile(data=data, suffix=picture.suffix, size=picture.size)
    made = new_layer(file, rectangle_domain(*picture.size), Meshing(), WHOLE)
    return replace(made, still=True)


def make_still_layer(layer: Layer) -> Layer:
    """Return the layer as a still picture in its drawn place, with the same cut-out.

    All channels but the poses stay, such as parent, transform and opacity, and the cycles.
    """
    domain = rectangle_domain(*layer.picture.size).moved(layer.corner)
    rest = new_layer(layer.picture, domain, layer.meshing, layer.cut_out)
    return place_as_layer(replace(rest, still=True), layer)


def place_as_layer(layer: Layer, replaced: Layer) -> Layer:
    """Return a layer, posable or still, as drawn, in the place of another layer.

    The channels of the other layer's handles are left out.
    """
    anchor = replaced.anchor
    if anchor is not None:
        anchor = complex(layer.domain.nearest(np.array([anchor]))[0])
    return replace(
        replaced,
        **{name: getattr(layer, name) for name in DRAWN},
        anchor=anchor,
        keys=(replace(layer.keys[0], frame=replaced.keys[0].frame),),
        channels={name: keys for name, keys in replaced.channels.items() if name[1] is None},
    )


def _scene(
    drawing: LayeredPicture, meshing: Meshing, cut_out: CutOut, *, is_cut_out: bool
) -> OpenedScene:
    count = len(drawing.layers)
    share = max(min(FEWEST_TRIANGLES, MOST_TOGETHER // count), meshing.triangles // count)
    each = replace(meshing, triangles=min(meshing.triangles, share))

    def shaped(*, is_cut_out: bool) -> list[tuple[Layer, tuple[str, ...]]]:
        return run_parallel(
            lambda numbered: make_posable_layer(
                numbered[1], numbered[0], each, cut_out, is_cut_out=is_cut_out
            ),
            enumerate(drawing.layers),
            (imported.picture.size for imported in drawing.layers),
        )

    made = shaped(is_cut_out=is_cut_out)
    if is_cut_out and all(layer.still for layer, _notices in made):
        made = shaped(is_cut_out=False)
    if all(layer.still for layer, _notices in made):
        reason = "; ".join(dict.fromkeys(notice for _layer, notices in made for notice in notices))
        raise LissomError(_(NO_SHAPE).format(reason=shortened(reason)))
    # Layers with the same picture share its file.
    files: dict[int, PictureFile] = {}
    layers = [
        replace(layer, picture=files.setdefault(id(imported.picture), layer.picture))
        for imported, (layer, _notices) in zip(drawing.layers, made, strict=True)
    ]
    collector = NoticeCollector()
    for layer, notices in made:
        for notice in notices:
            collector.add_note(layer.name, notice)
    document = _document(drawing, layers)
    document = replace(document, import_log=document.import_log + collector.import_log)
    return OpenedScene(
        document, {index: imported.picture for index, imported in enumerate(drawing.layers)}
    )


def _document(drawing: LayeredPicture, layers: Sequence[Layer]) -> Document:
    # A drawing with a background defines its own frame.
    framing: Framing = "canvas" if layers[0].still else "fit"
    return Document(
        layers=tuple(layers),
        size=drawing.size,
        export=ExportSettings(framing=framing),
        groups=drawing.groups,
        import_log=drawing.summary,
    )
