"""What is said to `lissom bench`."""

import argparse

PARTS = ("domain", "deform", "interpolate", "streaming", "methods", "export", "ui", "scenes")
# Only when they are asked for: they take some minutes.
LONG_PARTS = ("limits",)

EPILOG = """\
Everything is measured side by side in one run; the last column is the ratio to the first row of
each table. Times are those of one processor core unless a row says otherwise.

examples:
  lissom bench
  lissom bench domain
  lissom bench limits
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom bench`."""
    parser.epilog = EPILOG
    parser.add_argument(
        "parts",
        metavar="PART",
        nargs="*",
        choices=[*PARTS, *LONG_PARTS, []],
        help=f"what to measure: {', '.join(PARTS)} (default: all of these), or "
        f"{', '.join(LONG_PARTS)}, which takes about five minutes",
    )
