"""What is said to `lissom bench`."""

import argparse

PARTS = ("domain", "deform", "interpolate", "streaming", "export", "ui")

EPILOG = """\
Everything is measured side by side in one run; the last column is the ratio to the first row of
each table. Times are those of one processor core unless a row says otherwise.

examples:
  lissom bench
  lissom bench domain
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom bench`."""
    parser.epilog = EPILOG
    parser.add_argument(
        "parts",
        metavar="PART",
        nargs="*",
        choices=[*PARTS, []],
        help=f"what to measure: {', '.join(PARTS)} (default: all)",
    )
