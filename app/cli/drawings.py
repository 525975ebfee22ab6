"""Drawings of a command: cut out, opened, and saved as a project."""

import argparse
from collections.abc import Collection
from pathlib import Path

from app.cli.console import print_notices
from app.cut_out import CutOut
from app.document import Document, Meshing
from app.errors import LissomError, join_names
from app.storage import (
    OpenedScene,
    Picture,
    cut_picture,
    decode_mask,
    decode_picture,
    draw_thumbnail,
    flatten_layers,
    is_layered,
    open_layered,
    open_merged,
    open_picture,
    read_file,
    read_layered,
    save_project,
)
from app.texts import N_, _

MANY_LAYERS = N_("{path} has {count} layers; name one with --layer, from the front: {names}")
NO_LAYER = N_("{path} has no layer {layer!r}; its layers are, from the front: {names}")
NO_LAYERS = N_("{path} has no layers; leave out --layer")


def parse_cut_out(arguments: argparse.Namespace) -> CutOut:
    """Return how the subject is separated from a picture's background."""
    path = arguments.mask
    return CutOut(
        tolerance=arguments.tolerance,
        background=arguments.background,
        enclosed=arguments.enclosed,
        mask=None if path is None else decode_mask(read_file(path), str(path)),
        holes=arguments.holes,
    )


def open_drawing(
    arguments: argparse.Namespace, *, merges_layers: bool, members: Collection[str] = ()
) -> OpenedScene:
    """Open the drawing as a scene, and print notices.

    `members` are names of layers that will bend as one.
    """
    meshing = Meshing(triangles=arguments.triangles, detail=arguments.detail)
    cut_out = parse_cut_out(arguments)
    if not is_layered(arguments.picture):
        opened = open_picture(arguments.picture, meshing, cut_out)
    elif merges_layers:
        opened = open_merged(arguments.picture, meshing, cut_out)
    else:
        opened = open_layered(arguments.picture, meshing, cut_out, members)
    print_notices((*opened.notices, *opened.document.import_log.lines))
    return opened


def save_drawing(path: Path, opened: OpenedScene, document: Document) -> None:
    """Write the project of an opened drawing, with its thumbnail."""
    textures = {
        layer.id: cut_picture(opened.pictures[layer.id], layer.cut_out).texture
        for layer in document.layers
        if not document.is_deform_group(layer.id)
    }
    picture = flatten_layers(document, textures)
    save_project(path, document, thumbnail=draw_thumbnail(picture))


def read_layer_picture(path: Path, layer: str | None) -> tuple[Picture, complex]:
    """Return a picture or a layer's picture, and its lower left corner on the canvas."""
    if not is_layered(path):
        if layer is not None:
            raise LissomError(_(NO_LAYERS).format(path=path))
        return decode_picture(read_file(path), str(path)), 0j
    drawing = read_layered(path)
    names = [each.name for each in drawing.layers]
    shown = join_names([repr(name) for name in reversed(names)])
    if layer is None and len(names) > 1:
        raise LissomError(_(MANY_LAYERS).format(path=path, count=len(names), names=shown))
    if layer is not None and layer not in names:
        raise LissomError(_(NO_LAYER).format(path=path, layer=layer, names=shown))
    print_notices(drawing.summary.lines)
    found = drawing.layers[0 if layer is None else names.index(layer)]
    return found.picture, found.corner
