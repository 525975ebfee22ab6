"""`lissom pose`: picture + pose script → project."""

import argparse

from app.cli.console import StatusLine, print_line, print_notices
from app.cli.cut_out import parse_cut_out
from app.document import Meshing
from app.solving import load_pose_script, pose_document
from app.storage import (
    check_writable,
    cut_picture,
    draw_thumbnail,
    flatten_layers,
    is_layered,
    open_layered,
    open_picture,
    save_project,
)


def run(arguments: argparse.Namespace) -> int:
    """Solve the keys of a script and write the project."""
    read = arguments.picture, arguments.script, arguments.mask
    check_writable(arguments.out, sources=filter(None, read))
    script = load_pose_script(arguments.script)
    meshing = Meshing(triangles=arguments.triangles, detail=arguments.detail)
    cut_out = parse_cut_out(arguments)
    if is_layered(arguments.picture):
        opened = open_layered(arguments.picture, meshing)
    else:
        opened = open_picture(arguments.picture, meshing, cut_out)
    print_notices((*opened.notices, *opened.document.import_log.lines))
    with StatusLine() as status:
        document, lags = pose_document(opened.document, script, status.show)
    print_notices(lags)
    textures = {
        layer.id: cut_picture(opened.pictures[layer.id], layer.cut_out).texture
        for layer in document.layers
    }
    picture = flatten_layers(document, textures)
    save_project(arguments.out, document, thumbnail=draw_thumbnail(picture))
    posed = [layer for layer in document.layers if not layer.still]
    keys = sum(len(layer.keys) for layer in posed)
    handles = sum(len(layer.handles) for layer in posed)
    layers = "" if len(document.layers) == 1 else f"{len(document.layers)} layers, "
    print_line(f"{arguments.out}: {layers}{keys} keys, {handles} handles")
    return 0
