"""What is said to `lissom interpolate`."""

import argparse
from pathlib import Path

from app.cli.options import VARIANTS, input_file

EPILOG = """\
MAPS.npz holds
  outline    (p,)    complex  the domain's boundary, simple, counter-clockwise
  cage       (n,)    complex  the polygon of the Cauchy coordinates around it, counter-clockwise
  phi, psi   (q, n)  complex  coefficients of the keyframes f = Phi + conj(Psi), q >= 2
  hole_outlines, hole_outline_sizes, hole_cages, hole_cage_sizes, hole_centres
                              optional: the holes, as lissom domain writes them; phi and psi then
                              have the coefficients of the cage first, then of each hole's
  logs       (q, h)  complex  optional: a_j of the holes; 2 a_j ln|z - hole_centre_j| is in the map
  points     (m,)    complex  where the in-betweens are wanted, in the closed domain
  anchor     ()      complex  optional: the point whose position and arg f_z are linear in time;
                              by default the centre of the largest disc in the domain
  triangles  (t, 3)  int      optional: triangles of the points; integration follows their edges
  turns      (q-1,)  int      optional: whole turns that the shape makes between keyframes i and
                              i + 1 beyond the shorter way, counter-clockwise; by default 0. From
                              no turn to one of 200 degrees the shorter way is -160: 1 makes it 200

Keyframe i is at time i. OUT.npz gets times (s,), anchor, and one row for each time of
  positions, fz, fzbar  (s, m)  complex128  f, f_z and the derivative of f by conj(z) at the points
  rho                   (s,)    float64     with scaled-eta: the scaling of eta, 1 at keyframes

examples:
  lissom interpolate maps.npz --variant metric --times 0,0.25,0.5,0.75,1 --out frames.npz
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom interpolate`."""
    parser.epilog = EPILOG
    parser.add_argument(
        "maps", metavar="MAPS.npz", type=input_file, help="domain, keyframes and points"
    )
    parser.add_argument(
        "--variant",
        required=True,
        choices=VARIANTS,
        help="how the keyframes are blended",
    )
    parser.add_argument(
        "--times",
        required=True,
        metavar="T,T,...",
        type=_times,
        help="in [0, q - 1], in any order, separated by commas",
    )
    parser.add_argument("--out", metavar="OUT.npz", type=Path, required=True, help="where to write")


def _times(text: str) -> tuple[float, ...]:
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise argparse.ArgumentTypeError(
            f"{text!r} is not a list of numbers separated by commas"
        ) from None
