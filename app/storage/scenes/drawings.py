"""New scenes from layered drawings, or from several pictures."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from hashlib import sha256
from pathlib import Path

from PIL import Image

from app.cut_out import CutOut
from app.document import Layer, LayerOrigin, Meshing, PictureFile
from app.errors import EMPTY_IMPORT_LOG, LissomError, NoticeCollector, display_name, shortened
from app.storage.files.reading import read_file
from app.storage.pictures.layer_names import UniqueNames
from app.storage.pictures.layered import ImportedLayer, LayeredPicture, encode_png
from app.storage.pictures.openraster import read_krita, read_openraster
from app.storage.pictures.parallel import require_memory, run_parallel
from app.storage.pictures.photoshop import read_photoshop
from app.storage.pictures.picture import Picture, decode_picture, decode_pictures
from app.storage.scenes.flattening import flatten_layers
from app.storage.scenes.layers import (
    WHOLE,
    document_of_drawing,
    make_posable_layer,
    place_imported_layer,
    rectangle_of,
)
from app.storage.scenes.opening import OpenedScene, build_scene
from app.texts import N_, _
from engine.arrays import Bytes

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


def is_layered(path: Path) -> bool:
    """Return whether a file's name ends as that of a layered drawing."""
    return path.suffix.lower() in READERS


def read_layered(path: Path) -> LayeredPicture:
    """Read a layered drawing with all its layers."""
    data = read_file(path)
    try:
        drawing = READERS[path.suffix.lower()](data)
    except LissomError as error:
        raise LissomError(
            _("cannot open {path}: {error}").format(path=path, error=error)
        ) from error
    return replace(drawing, file_name=path.name, sha256=sha256(data).hexdigest())


def read_drawing(path: Path, *, is_merged: bool = False) -> LayeredPicture:
    """Read a layered drawing, or a picture as a drawing of a single layer.

    The layers may be merged into one picture.
    """
    if is_layered(path):
        drawing = read_layered(path)
        return merge_layers(drawing, path) if is_merged else drawing
    data = read_file(path)
    return single_layer_drawing(path, data, decode_picture(data, str(path)))


def single_layer_drawing(path: Path, data: bytes, picture: Picture) -> LayeredPicture:
    """Return a picture as a drawing of a single layer."""
    layer = ImportedLayer(
        name=display_name(path.stem).strip() or "layer", data=data, picture=picture
    )
    return LayeredPicture(
        size=picture.size,
        layers=(layer,),
        file_name=path.name,
        sha256=sha256(data).hexdigest(),
    )


def merge_layers(drawing: LayeredPicture, path: Path) -> LayeredPicture:
    """Return a drawing with its layers merged: the merged picture of the file, or as they look."""
    require_memory([drawing.size])
    whole = _file_merged(drawing)
    log = EMPTY_IMPORT_LOG if whole is not None else drawing.summary
    pixels = _flattened(drawing) if whole is None else whole
    data = encode_png(Image.fromarray(pixels))
    merged = single_layer_drawing(path, data, decode_picture(data, path.name))
    return replace(merged, summary=log, sha256=drawing.sha256, is_merged=True)


def open_picture(path: Path, meshing: Meshing | None, cut_out: CutOut = CutOut()) -> OpenedScene:
    """Read a picture, find its outline, and return a document that shows it as drawn.

    Raises `LissomError` or `EngineError` if the file is no picture, or has no subject with an
    outline.
    """
    data = read_file(path)
    picture = decode_picture(data, str(path))
    return build_scene(single_layer_drawing(path, data, picture), meshing, cut_out)


def open_layered(
    path: Path,
    meshing: Meshing | None,
    cut_out: CutOut = CutOut(),
    members: Collection[str] = (),
) -> OpenedScene:
    """Read a layered drawing, and make a layer of each of its layers.

    `members` are names of layers that will bend as one: the log omits their own shapes.

    A layer that is fully opaque, or without a shape, becomes a still picture. If this is true of
    all layers, each opens as a picture file does, with the `cut_out`. All layers together have as
    many triangles as one picture.
    """
    return _scene(read_layered(path), meshing, cut_out, is_cut_out=True, members=members)


def open_merged(path: Path, meshing: Meshing | None, cut_out: CutOut = CutOut()) -> OpenedScene:
    """Read a layered drawing as one picture: the merged one in the file, or its visible layers."""
    drawing = read_layered(path)
    merged = merge_layers(drawing, path)
    opened = build_scene(merged, meshing, cut_out)
    count = len(drawing.layers)
    merged_layers = _("the {count} layers of {name} were merged into one drawing").format(
        count=count, name=path.name
    )
    notices = (merged_layers,) if count > 1 else ()
    return opened._replace(notices=notices + opened.notices)


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
        place_imported_layer(imported, index, rectangle_of(imported.picture), Meshing(), WHOLE)
        for index, imported in enumerate(drawing.layers)
    ]
    textures = {index: imported.picture.rgba for index, imported in enumerate(drawing.layers)}
    return flatten_layers(document_of_drawing(drawing, layers), textures, largest=max(drawing.size))


def open_pictures(paths: Sequence[Path], meshing: Meshing | None) -> OpenedScene:
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
    opened = _scene(drawing, meshing, CutOut(), is_cut_out=False)
    sources = [
        single_layer_drawing(path, data, picture).drawing_file(index, imported.corner)
        for index, (path, (data, _name), picture, imported) in enumerate(
            zip(paths, files, pictures, all_imported, strict=True)
        )
    ]
    layers = (
        replace(layer, origin=LayerOrigin(drawing=index, index=0))
        for index, layer in enumerate(opened.document.layers)
    )
    document = replace(opened.document, layers=tuple(layers), drawings=tuple(sources))
    return opened._replace(document=document)


def _scene(
    drawing: LayeredPicture,
    meshing: Meshing | None,
    cut_out: CutOut,
    *,
    is_cut_out: bool,
    members: Collection[str] = (),
) -> OpenedScene:
    count, meshing = len(drawing.layers), meshing or Meshing.of_size(drawing.size)
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
        for notice in notices if layer.name not in members else ():
            collector.add_note(layer.name, notice)
    document = document_of_drawing(drawing, layers)
    document = replace(document, import_log=document.import_log + collector.import_log)
    return OpenedScene(
        document, {index: imported.picture for index, imported in enumerate(drawing.layers)}
    )
