"""What is said to `lissom domain`."""

import argparse
from pathlib import Path

from app.cli.options import add_meshing_options, input_file

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
    parser.add_argument("picture", metavar="PICTURE", type=input_file, help="the drawing")
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
