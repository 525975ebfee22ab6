"""What is said to `lissom certify`."""

import argparse

from app.cli.options import add_project, add_variant_option

EPILOG = """\
Keyframes are certified: their k, sigma_a and sigma_b hold at every point of the shape, not only at
samples. For each interval between two keys the extremes of the in-betweens over time and space, as
measured, stand beside the two keys' own; below them what is proven of every moment and every point.
Frames that fold, or that cannot be proven not to, are named. The exit status is 0 if every keyframe
is certified, every in-between is proven not to fold, and every interval is within its keyframes'
bounds, or within the figure's where the motion passes through its keys; 1 if not.

examples:
  lissom certify wave.lissom
  lissom certify wave.lissom --variant nu --json
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom certify`."""
    add_project(parser)
    add_variant_option(parser)
    parser.add_argument("--json", action="store_true", help="print JSON instead of a table")
