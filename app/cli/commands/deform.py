"""`lissom deform`: drag handles of a shape, from file to file."""

import argparse

from app.cli.console import print_line
from app.cli.options import add_out, input_file
from app.texts import _, ngettext

EPILOG = _(
    """\
CASE.npz holds the shape and its targets:
  outline      (p,)   complex128  the domain's boundary, counter-clockwise
  cage         (n,)   complex128  the cage around it, counter-clockwise
  handles      (h,)   complex128  points of the shape
  targets      (h,)   complex128  where the handles should be
  k_max, sigma_a_max, sigma_b_min  scalars, limits of the distortion
  phi, psi     (n,)   complex128  optional, the map to start from, with logs (holes,) around holes
  hole_outlines, hole_outline_sizes, hole_cages, hole_cage_sizes, hole_centres
                                  optional, the holes, as lissom domain writes them
  stiffness    (p,)   float64     optional, from 1/30 to 100 at the vertices of outline, then at
                                  those of hole_outlines: a factor of the energy along the boundary,
                                  and of the forces at handles there; 1 by default; its logarithm
                                  is linear along edges
  local_limits scalar             optional, 0 or 1: whether limits are tighter where stiffness is
                                  above 1; k, ln sigma_a and ln sigma_b are divided by its square
                                  root there
  path         (s, h) complex128  optional, positions of the handles on the way to the targets
  pull         (h,) or scalar     optional, the strongest force of each handle over the diameter of
                                  the outline; infinite holds the handle, as by default; a scalar
                                  is for handles whose target is not at rest; with 10 a limb moves
                                  as far as it goes, and nothing else moves

MAP.npz holds outline, cage, the arrays of the holes, and
  phi, psi     (n,)   complex128  the map: the coefficients of the cage, then those of each hole's
  logs         (holes,) complex128  a_j; the map contains 2 a_j ln|z - hole_centre_j|
  handles_mapped (h,) complex128  where the handles are
  k, sigma_a, sigma_b             proven for the whole shape
  certified                       whether these are within the limits, and the map is injective
  status                          "converged" at rest; "at the limits" at rest, stopped by the
                                  limits; "free" without handles; "unfinished" if none is proven
  steps                           Newton steps of the search that found the map
  steps_tried                     steps of all searches, and along the path

examples:
  lissom deform case.npz --out map.npz
"""
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "case", metavar="CASE.npz", type=input_file, help=_("shape, handles and targets")
    )
    add_out(parser, "MAP.npz")


def run(arguments: argparse.Namespace) -> int:
    from app.cli.arrays.deform_case import solve_case
    from app.storage import check_writable, write_arrays

    check_writable(arguments.out, sources=[arguments.case])
    results = solve_case(arguments.case)
    write_arrays(arguments.out, results)
    print_line(
        ngettext(
            "{status}: k ≤ {k:.4f}, sigma_a ≤ {sigma_a:.4f}, sigma_b ≥ {sigma_b:.4f}, {steps} of "
            "{steps_tried} step tried",
            "{status}: k ≤ {k:.4f}, sigma_a ≤ {sigma_a:.4f}, sigma_b ≥ {sigma_b:.4f}, {steps} of "
            "{steps_tried} steps tried",
            int(results["steps_tried"]),
        ).format(**results)
    )
    return 0
