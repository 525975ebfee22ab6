"""`lissom interpolate`: in-betweens of keyframes at points, from file to file."""

import argparse

from app.cli.options import METHODS, add_out, input_file

EPILOG = """\
KEYFRAMES is one NPZ file, or a mesh for each of q keyframes: OBJ files in the plane of x and y, or
NPZ files with vertices (m,) and triangles (t, 3); all have the same triangles, and the first is the
domain. The one NPZ file holds
  outline    (p,)    complex  the domain's boundary, simple, counter-clockwise
  cage       (n,)    complex  the polygon of the Cauchy coordinates around it, counter-clockwise
  phi, psi   (q, n)  complex  coefficients of the keyframes f = Phi + conj(Psi), q >= 2
  boundary   (q, p)  complex  instead: where the outline's vertices go, its edges straight, and the
                              inside by harmonic coordinates
  positions  (q, m)  complex  instead of all these, with triangles: where the points of a mesh go;
                              points are then those of the first keyframe unless they are there
  hole_outlines, hole_outline_sizes, hole_cages, hole_cage_sizes, hole_centres
                              optional: the holes, as lissom domain writes them; phi and psi then
                              have the coefficients of the cage first, then of each hole's
  logs       (q, h)  complex  optional: a_j of the holes; 2 a_j ln|z - hole_centre_j| is in the map
  points     (m,)    complex  where the in-betweens are wanted, in the closed domain
  anchor     ()      complex  optional: the point whose position and arg f_z are linear in time;
                              by default the centre of the largest disc in the domain
  triangles  (t, 3)  int      triangles of the points; optional for metric, nu, scaled-eta, eta and
                              linear, whose integration follows their edges
  handles    (h,)    complex  for handles: the points of the domain that are led straight
  turns      (q-1,)  int      optional: whole turns that the shape makes between keyframes i and
                              i + 1 beyond the shorter way, counter-clockwise; by default 0. From
                              no turn to one of 200 degrees the shorter way is -160: 1 makes it 200;
                              with --loop (q,), the last one back to keyframe 0

Keyframe i is at time i. Without --through the motion has a corner at each, as in the paper. With
it the velocity is continuous at keyframes between two others, in a loop at all: the slope of the
parabola through three, shortened where the in-betweens would leave the bounds. That they keep them
everywhere is proven with metric; with nu for k, and with scaled-eta rho sees to it. A keyframe that
is itself beyond the bounds widens them for the intervals around it.

Besides the paper's variants there are the methods that it compares them with. Meshes do for
  arap       rotation angle and stretch of each triangle, each by itself, then the nearest map
             (Alexa et al. 2000); angles are continued from triangle to triangle without --principal
  ffmp       what leads from a triangle to its neighbours (Kircher and Garland 2008)
  sig13      the squared lengths of edges, then flattened (Chen et al. 2013); no holes
  mesh-eta   scaled-eta in each triangle, then the nearest map (the paper's Figure 11)
and maps are needed for
  conformal  log f_z of holomorphic keyframes (Weber and Gotsman 2010)
  handles    a new pose within --bounds for each time, by handles that are led straight

OUT.npz gets times (s,), anchor, and one row for each time of
  positions, fz, fzbar  (s, m)  complex128  f, f_z and the derivative of f by conj(z) at the points
  rho                   (s,)    float64     with scaled-eta and mesh-eta: the scaling of eta, 1 at
                                            keyframes
  tangents              (q,)    float64     with --through: how much of the full velocity is left
                                            at each keyframe, from 0, a stop, to 1; 1 at ends
With any of these methods the anchor is a vertex, by default the one farthest from the border; fz
and fzbar are (s, t), of the triangles (t, 3) that are written as well, all counter-clockwise; and
there are
  poisson_error         (s,)    float64     with arap, ffmp and mesh-eta: by how much, relative to
                                            it, the blend is no map's (root mean square)
  angle_defect          (s,)    float64     with sig13: the largest angle, in radians, by which the
                                            flattened mesh is not flat

examples:
  lissom interpolate maps.npz --variant metric --times 0,0.25,0.5,0.75,1 --out frames.npz
  lissom interpolate maps.npz --variant metric --through --loop --times 0,0.5,1,1.5 --out frames.npz
  lissom interpolate first.obj second.obj --variant arap --times 0.25,0.5,0.75 --out frames.npz
"""
NOT_NUMBERS = "{text!r} is not a list of numbers separated by commas"


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "keyframes",
        metavar="KEYFRAMES",
        nargs="+",
        type=input_file,
        help="an NPZ file with domain, keyframes and points, or a mesh for each keyframe",
    )
    parser.add_argument(
        "--variant",
        required=True,
        choices=METHODS,
        help=f"how the keyframes are blended: {', '.join(METHODS)}",
        metavar="V",
    )
    parser.add_argument(
        "--times",
        required=True,
        metavar="T,T,...",
        type=_numbers,
        help="in [0, q - 1], with --loop in [0, q], in any order, separated by commas",
    )
    parser.add_argument(
        "--through",
        action="store_true",
        help="pass keyframes at one velocity, within bounds, instead of in a corner",
    )
    parser.add_argument(
        "--loop", action="store_true", help="the last keyframe leads on to the first, at time q"
    )
    parser.add_argument(
        "--bounds",
        metavar="K,SA,SB",
        type=_bounds,
        help="what --through and handles keep: the largest k and sigma_a and the smallest sigma_b "
        "(default: those of a new project)",
    )
    parser.add_argument(
        "--principal",
        action="store_true",
        help="with arap and mesh-eta: angles of each triangle between -180 and 180 degrees by "
        "itself, which fails where shapes turn far",
    )
    add_out(parser, "OUT.npz")


def run(arguments: argparse.Namespace) -> int:
    from app.cli.arrays.keyframe_blend import BlendOptions, blend_keyframes
    from app.cli.arrays.keyframes import read_keyframes
    from app.storage import check_writable, write_arrays

    check_writable(arguments.out, sources=arguments.keyframes)
    given = read_keyframes(arguments.keyframes)
    options = BlendOptions(*(getattr(arguments, name) for name in BlendOptions._fields))
    write_arrays(arguments.out, blend_keyframes(given, options))
    return 0


def _numbers(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(NOT_NUMBERS.format(text=text)) from None


def _bounds(text: str) -> tuple[float, ...]:
    bounds = _numbers(text)
    if len(bounds) != 3:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not three numbers separated by commas, such as 0.5,2,0.5"
        )
    return bounds
