"""`lissom domain`: picture → outline, cage and triangulation."""

import argparse
from pathlib import Path

import numpy as np

from app.cli.console import notice
from app.cli.options import add_meshing_options, meshing_of
from app.reports import draw_preview
from app.storage import check_writable, open_picture, write_arrays, write_atomically
from engine.domain import texture_coordinates

EPILOG = """\
The picture may be a PNG, JPEG, GIF, WebP, AVIF, TIFF, BMP, TGA, PPM or ICO. Transparent pixels are
outside; from an opaque picture a plain background is removed. Whatever else had to be done (parts
bridged, holes filled, specks dropped) is told on standard error.

DOMAIN.npz holds, in pixels of the picture with the origin at its lower left corner and y up:
  outline     (p,)    complex128  the domain's boundary, counter-clockwise
  cage        (n,)    complex128  the cage around it, counter-clockwise
  vertices    (v,)    complex128  of the triangulation
  triangles   (m, 3)  int32       counter-clockwise
  uv          (v, 2)  float64     u right, v up; [0, 1] spans the picture
  image_size  (2,)    int64       width, height

examples:
  lissom domain giraffe.png --out giraffe.npz
  lissom domain giraffe.png --out giraffe.npz --detail fine --preview preview.png
  lissom domain icon.png --out icon.npz --triangles 5000
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom domain`."""
    parser.epilog = EPILOG
    parser.add_argument("picture", metavar="PICTURE", type=Path, help="the drawing")
    parser.add_argument(
        "--out", metavar="DOMAIN.npz", type=Path, required=True, help="where to write"
    )
    add_meshing_options(parser)
    parser.add_argument(
        "--preview",
        metavar="PREVIEW.png",
        type=Path,
        help="also draw picture, outline, cage and mesh",
    )


def run(arguments: argparse.Namespace) -> int:
    """Build the domain of a picture and write it."""
    for path in (arguments.out, arguments.preview):
        if path is not None:
            check_writable(path)
    opened = open_picture(arguments.picture, meshing_of(arguments))
    for message in opened.notices:
        notice(message)
    picture, domain = opened.picture, opened.document.domain
    mesh = domain.mesh
    if arguments.preview is not None:
        drawn = draw_preview(picture, domain)
        write_atomically(arguments.preview, lambda file: file.write(drawn))
    write_arrays(
        arguments.out,
        {
            "outline": domain.outline,
            "cage": domain.cage,
            "vertices": mesh.vertices,
            "triangles": mesh.triangles,
            "uv": texture_coordinates(mesh.vertices, picture.size),
            "image_size": np.array(picture.size),
        },
    )
    print(
        f"{arguments.out}: {picture.size[0]} × {picture.size[1]} pixels, outline and cage of "
        f"{len(domain.cage)} vertices, {len(mesh.triangles):,} triangles"
    )
    return 0
