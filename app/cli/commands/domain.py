"""`lissom domain`: picture → outline, cage and triangulation."""

import argparse
from dataclasses import replace
from math import isfinite
from operator import methodcaller

from app.cli.console import print_line, print_notices
from app.cli.options import (
    add_cut_out_options,
    add_meshing_options,
    add_out,
    input_file,
    output_file,
)
from app.texts import _, ngettext

EPILOG = _(
    """\
The picture may be a PNG, JPEG, GIF, WebP, AVIF, TIFF, BMP, TGA, PPM or ICO. It may also be a layer
of an OpenRaster (.ora) or Photoshop (.psd) drawing, which --layer names. Transparent pixels are
outside. From an opaque picture, but not from a layer, a plain background is removed. Other changes
(bridged parts, filled holes, dropped specks) are listed on standard error. Holes stay holes, the
largest first, if a disc of 2.4 % of the drawing's diagonal fits into them; --holes fill fills all.
A knife separates parts that touch, such as boots, or a tail over a flank. It cuts a slit of 0.2 %
of the diagonal along a line, from an edge to a place inside.

DOMAIN.npz holds arrays in pixels of the picture, or of the whole canvas of a layer. The origin is
at the lower left corner, and y is up:
  outline     (p,)    complex128  the domain's boundary, counter-clockwise
  cage        (n,)    complex128  the cage around it, counter-clockwise
  vertices    (v,)    complex128  of the triangulation
  triangles   (m, 3)  int32       counter-clockwise
  uv          (v, 2)  float64     u right, v up; [0, 1] spans the picture
  image_size  (2,)    int64       width, height
  corner      ()      complex128  lower left corner of the picture: 0, or a layer's own
  closed      (m,)    complex128  positions of the vertices of outline and holes with closed slits;
                                  equal to the outline without slits
For the kept holes it also holds, all empty without holes:
  hole_outlines       (a,)  complex128  clockwise, one hole after the other
  hole_cages          (b,)  complex128  the cage in each hole, clockwise
  hole_outline_sizes, hole_cage_sizes  (holes,)  int64  the number of vertices of each hole
  hole_centres        (holes,)  complex128  a point in the cage of each hole

examples:
  lissom domain giraffe.png --out giraffe.npz
  lissom domain giraffe.png --out giraffe.npz --detail fine --preview preview.png
  lissom domain icon.png --out icon.npz --triangles 5000
  lissom domain cup.png --out cup.npz --holes fill
  lissom domain donut.jpg --out donut.npz --enclosed remove
  lissom domain friend.ora --layer "left arm" --out arm.npz
  lissom domain boots.png --out boots.npz --knife 450,1060,450,540
  lissom domain photo.jpg --out photo.npz --background "#8fb0d0" --tolerance 40
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("picture", metavar="PICTURE", type=input_file, help=_("the drawing"))
    add_out(parser, "DOMAIN.npz")
    parser.add_argument(
        "--layer",
        metavar="NAME",
        help=_("the layer of the drawing to use; without this option the command lists the layers"),
    )
    add_meshing_options(parser)
    add_cut_out_options(parser)
    parser.add_argument(
        "--knife",
        metavar="X,Y,X,Y,...",
        type=_line,
        action="append",
        default=[],
        help=_(
            "separate touching parts along a line, from outside to a point inside. Points are "
            "pixels from the picture's upper left corner, y down; may be given several times"
        ),
    )
    parser.add_argument(
        "--preview",
        metavar="PREVIEW.png",
        type=output_file,
        help=_("also draw picture, outline, cage and mesh"),
    )


def run(arguments: argparse.Namespace) -> int:
    import numpy as np

    from app.cli.arrays.hole_arrays import hole_arrays
    from app.cli.drawings import parse_cut_out, read_layer_picture
    from app.cut_out import CutLine, build_picture_domain
    from app.reports import draw_preview
    from app.storage import check_writable, is_layered, write_arrays, write_atomically
    from engine.domain import texture_coordinates

    written, read = (arguments.out, arguments.preview), (arguments.picture, arguments.mask)
    check_writable(*filter(None, written), sources=filter(None, read))
    picture, corner = read_layer_picture(arguments.picture, arguments.layer)
    cut_out = parse_cut_out(arguments)
    if is_layered(arguments.picture) and cut_out.background == "auto" and not picture.is_opaque:
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
        write_atomically(arguments.preview, methodcaller("write", drawn))
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
    summary = ngettext(
        "{path}: {width} × {height} pixels, {vertices} vertices of outline and cage, {holes} hole, "
        "{triangles:,} triangles",
        "{path}: {width} × {height} pixels, {vertices} vertices of outline and cage, {holes} "
        "holes, {triangles:,} triangles",
        len(holes),
    )
    print_line(
        summary.format(
            path=arguments.out,
            width=picture.size[0],
            height=height,
            vertices=sum(map(len, domain.cages)),
            holes=len(holes),
            triangles=len(mesh.triangles),
        )
    )
    return 0


def _line(text: str) -> tuple[complex, ...]:
    """Return the points of a polyline, given as x to the right and y down in turn."""
    try:
        numbers = [float(number) for number in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) < 4 or len(numbers) % 2 or not all(map(isfinite, numbers)):
        raise argparse.ArgumentTypeError(
            _("expected x,y,x,y,... for at least two points in pixels, not {text!r}").format(
                text=text
            )
        )
    return tuple(map(complex, numbers[::2], numbers[1::2]))
