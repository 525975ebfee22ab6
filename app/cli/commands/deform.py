"""`lissom deform`: drag handles of a shape, from file to file."""

import argparse

from app.cli.console import print_line
from app.cli.options import add_out, input_file
from app.texts import _

EPILOG = """\
CASE.npz holds the shape and what is asked of it:
  outline      (p,)   complex128  the domain's boundary, counter-clockwise
  cage         (n,)   complex128  the cage around it, counter-clockwise
  handles      (h,)   complex128  points of the shape that are held
  targets      (h,)   complex128  where they should be
  k_max, sigma_a_max, sigma_b_min  scalars, bounds on the distortion
  phi, psi     (n,)   complex128  optional, the map to start from, with logs (holes,) around holes
  hole_outlines, hole_outline_sizes, hole_cages, hole_cage_sizes, hole_centres
                                  optional, the holes, as lissom domain writes them
  stiffness    (p,)   float64     optional, from 1/30 to 100 at the vertices of outline, then at
                                  those of hole_outlines: a factor of the energy along the boundary
                                  and of what holds and pulls the handles there, 1 without; its
                                  logarithm is linear along edges
  local_limits scalar             optional, 0 or 1: whether limits are tighter where stiffness is
                                  above 1: k, ln sigma_a and ln sigma_b are there those of the
                                  bounds over its square root
  path         (s, h) complex128  optional, positions of the handles on the way to the targets
  pull         (h,) or scalar     optional, the strongest force of each handle over the diameter of
                                  the outline, infinite where it is held, as all are without;
                                  a scalar is for those that are wanted elsewhere than at rest: 10
                                  moves a limb as far as it goes, and nothing else

MAP.npz holds outline, cage, the arrays of the holes, and
  phi, psi     (n,)   complex128  the map: the coefficients of the cage, then those of each hole's
  logs         (holes,) complex128  a_j: 2 a_j ln|z - hole_centre_j| is a part of the map
  handles_mapped (h,) complex128  where the handles are
  k, sigma_a, sigma_b             proven for the whole shape: nowhere beyond
  certified                       whether that is within the bounds, and the map injective
  status                          "converged" at rest; "at the limits" at rest, held back by the
                                  bounds; "unfinished" where neither is proven
  steps                           Newton steps of the search that found the map
  steps_tried                     those of all searches, and along the path

examples:
  lissom deform case.npz --out map.npz
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "case", metavar="CASE.npz", type=input_file, help="shape, handles and targets"
    )
    add_out(parser, "MAP.npz")


def run(arguments: argparse.Namespace) -> int:
    from app.cli.arrays.deform_case import solve_case
    from app.storage import check_writable, write_arrays

    check_writable(arguments.out, sources=[arguments.case])
    results = solve_case(arguments.case)
    write_arrays(arguments.out, results)
    print_line(
        _(
            "{status}: k ≤ {k:.4f}, sigma_a ≤ {sigma_a:.4f}, sigma_b ≥ {sigma_b:.4f}, {steps} "
            "steps of {steps_tried} tried"
        ).format(**results)
    )
    return 0
