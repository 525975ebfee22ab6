"""`lissom interpolate`: in-betweens of keyframes at points, from file to file."""

import argparse

from app.cli.options import METHODS, add_out, input_file
from app.texts import N_, _

EPILOG = _(
    """\
KEYFRAMES is one NPZ file, or a mesh for each of q keyframes. Meshes are OBJ files in the plane of x
and y, or NPZ files with vertices (m,) and triangles (t, 3). All have the same triangles, and the
first mesh is the domain. A single NPZ file holds
  outline    (p,)    complex  the domain's boundary, simple, counter-clockwise
  cage       (n,)    complex  the polygon of the Cauchy coordinates around it, counter-clockwise
  phi, psi   (q, n)  complex  coefficients of the keyframes f = Phi + conj(Psi), q >= 2
  boundary   (q, p)  complex  instead of phi and psi: positions of the outline's vertices; edges
                              stay straight, and harmonic coordinates fill the inside
  positions  (q, m)  complex  instead of all of these, with triangles: positions of a mesh's points;
                              the default of points is the first keyframe
  hole_outlines, hole_outline_sizes, hole_cages, hole_cage_sizes, hole_centres
                              optional: the holes, as lissom domain writes them; phi and psi then
                              have the coefficients of the cage first, then of each hole's
  logs       (q, h)  complex  optional: a_j of the holes; the map contains
                              2 a_j ln|z - hole_centre_j|
  points     (m,)    complex  the points of the in-betweens, in the closed domain
  anchor     ()      complex  optional: the point whose position and arg f_z are linear in time;
                              by default the centre of the largest disc in the domain
  triangles  (t, 3)  int      triangles of the points; optional for metric, nu, scaled-eta, eta and
                              linear, which integrate along their edges
  handles    (h,)    complex  for the method handles: the points that go straight
  turns      (q-1,)  int      optional: additional whole turns of the shape between keyframes i and
                              i + 1, counter-clockwise; 0 by default, the shorter way. From no turn
                              to a turn of 200 degrees the shorter way is -160; 1 makes it 200.
                              With --loop (q,): the last one is back to keyframe 0

Keyframe i is at time i. Without --through the motion has a corner at each keyframe, as in the
paper. With --through the velocity is continuous at inner keyframes, and in a loop at all keyframes.
It is the slope of the parabola through three keyframes, reduced if in-betweens would exceed the
limits. For metric the limits are proven to hold everywhere. For nu this holds for k, and for
scaled-eta rho ensures it. A keyframe beyond the limits widens them in the segments beside it.

The paper compares its variants with other methods, which are here too. Meshes suffice for
  arap       rotation angle and stretch of each triangle by itself, then the nearest map
             (Alexa et al. 2000); without --principal angles continue from triangle to triangle
  ffmp       the transformation from each triangle to its neighbours (Kircher and Garland 2008)
  sig13      the squared lengths of edges, then flattened (Chen et al. 2013); no holes
  mesh-eta   scaled-eta in each triangle, then the nearest map (the paper's Figure 11)
Maps are needed for
  conformal  log f_z of holomorphic keyframes (Weber and Gotsman 2010)
  handles    a new pose within --bounds for each time, from handles that go straight

OUT.npz holds times (s,), anchor, and one row for each time of
  positions, fz, fzbar  (s, m)  complex128  f, f_z and the derivative of f by conj(z) at the points
  rho                   (s,)    float64     with scaled-eta and mesh-eta: the scaling of eta, 1 at
                                            keyframes
  tangents              (q,)    float64     with --through: the share of the full velocity that
                                            remains at each keyframe, from 0, a stop, to 1; 1 at
                                            the ends
With the compared methods the anchor is a vertex, by default the one farthest from the border. fz
and fzbar are (s, t), one for each triangle. The file then also holds triangles (t, 3), all
counter-clockwise, and
  poisson_error         (s,)    float64     with arap, ffmp and mesh-eta: the relative difference of
                                            the blend from a map (root mean square)
  angle_defect          (s,)    float64     with sig13: the largest angle, in radians, by which the
                                            flattened mesh is not flat

examples:
  lissom interpolate maps.npz --variant metric --times 0,0.25,0.5,0.75,1 --out frames.npz
  lissom interpolate maps.npz --variant metric --through --loop --times 0,0.5,1,1.5 --out frames.npz
  lissom interpolate first.obj second.obj --variant arap --times 0.25,0.5,0.75 --out frames.npz
"""
)
NOT_NUMBERS = N_("{text!r} is not a list of numbers separated by commas")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "keyframes",
        metavar="KEYFRAMES",
        nargs="+",
        type=input_file,
        help=_("an NPZ file with domain, keyframes and points, or one mesh file for each keyframe"),
    )
    parser.add_argument(
        "--variant",
        required=True,
        choices=METHODS,
        help=_("how to blend the keyframes: {methods}").format(methods=", ".join(METHODS)),
        metavar="V",
    )
    parser.add_argument(
        "--times",
        required=True,
        metavar="T,T,...",
        type=_numbers,
        help=_("times from 0 to q - 1, with --loop from 0 to q, in any order, separated by commas"),
    )
    parser.add_argument(
        "--through",
        action="store_true",
        help=_(
            "pass through keyframes at a continuous velocity, within limits, instead of in a corner"
        ),
    )
    parser.add_argument(
        "--loop",
        action="store_true",
        help=_("let the last keyframe lead back to the first keyframe, at time q"),
    )
    parser.add_argument(
        "--bounds",
        metavar="K,SA,SB",
        type=_bounds,
        help=_(
            "limits for --through and the method handles: the largest k and sigma_a and the "
            "smallest sigma_b (default: as in a new project)"
        ),
    )
    parser.add_argument(
        "--principal",
        action="store_true",
        help=_(
            "with arap and mesh-eta: keep the angle of each triangle between -180 and 180 "
            "degrees, which fails if shapes turn far"
        ),
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
        raise argparse.ArgumentTypeError(_(NOT_NUMBERS).format(text=text)) from None


def _bounds(text: str) -> tuple[float, ...]:
    bounds = _numbers(text)
    if len(bounds) != 3:
        raise argparse.ArgumentTypeError(
            _("expected three numbers separated by commas, such as 0.5,2,0.5, not {text!r}").format(
                text=text
            )
        )
    return bounds
