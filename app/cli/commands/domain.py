"""`lissom domain`: picture → outline, cage and triangulation."""

import argparse
from dataclasses import replace
from pathlib import Path

import numpy as np

from app.cli.console import print_line, print_notices
from app.cli.cut_out import parse_cut_out
from app.cli.hole_arrays import hole_arrays
from app.cut_out import CutLine, build_picture_domain
from app.errors import LissomError, join_names
from app.reports import draw_preview
from app.storage import (
    Picture,
    check_writable,
    decode_picture,
    is_layered,
    read_file,
    read_layered,
    write_arrays,
    write_atomically,
)
from engine.domain import texture_coordinates


def run(arguments: argparse.Namespace) -> int:
    written, read = (arguments.out, arguments.preview), (arguments.picture, arguments.mask)
    check_writable(*filter(None, written), sources=filter(None, read))
    picture, corner = _read(arguments.picture, arguments.layer)
    cut_out = parse_cut_out(arguments)
    if is_layered(arguments.picture) and cut_out.background == "auto":
        # A layer shows exactly its opaque pixels, as in a scene.
        cut_out = replace(cut_out, background="none")
    height = picture.size[1]
    slits = (np.array([complex(z.real, height - z.imag) for z in line]) for line in arguments.knife)
    cut_out = replace(cut_out, cut_lines=tuple(CutLine(points=points) for points in slits))
    domain, remedies = build_picture_domain(
        picture.rgba, triangles=arguments.triangles, detail=arguments.detail, cut_out=cut_out
    )
    print_notices((*picture.notices, *remedies))
    if arguments.preview is not None:
        drawn = draw_preview(picture, domain)
        write_atomically(arguments.preview, lambda file: file.write(drawn))
    coordinates = texture_coordinates(domain.mesh.vertices, picture.size)
    domain = domain.moved(corner)
    mesh, holes = domain.mesh, domain.holes
    write_arrays(
        arguments.out,
        {
            "outline": domain.outline,
            "cage": domain.cage,
            "vertices": mesh.vertices,
            "triangles": mesh.triangles,
            **hole_arrays(holes),
            "uv": coordinates,
            "image_size": np.array(picture.size),
            "corner": np.array(corner),
            "closed": np.concatenate(domain.loops) if domain.closed is None else domain.closed,
        },
    )
    kept = f", {len(holes)} {'hole' if len(holes) == 1 else 'holes'}" if holes else ""
    print_line(
        f"{arguments.out}: {picture.size[0]} × {picture.size[1]} pixels, outline and cage of "
        f"{sum(map(len, domain.cages))} vertices{kept}, {len(mesh.triangles):,} triangles"
    )
    return 0


def _read(path: Path, layer: str | None) -> tuple[Picture, complex]:
    """Return a picture or a layer's picture, and its lower left corner on the canvas."""
    if not is_layered(path):
        if layer is not None:
            raise LissomError(f"{path} has no layers; leave --layer out")
        return decode_picture(read_file(path), str(path)), 0j
    drawing = read_layered(path)
    names = [each.name for each in drawing.layers]
    told = join_names([repr(name) for name in reversed(names)])
    if layer is None and len(names) > 1:
        raise LissomError(
            f"{path} has {len(names)} layers; name one by --layer, from the front: {told}"
        )
    if layer is not None and layer not in names:
        raise LissomError(f"{path} has no layer {layer!r}; its layers are, from the front: {told}")
    print_notices(drawing.summary.lines)
    found = drawing.layers[0 if layer is None else names.index(layer)]
    return found.picture, found.corner
