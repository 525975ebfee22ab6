"""`lissom bench`: the measurements behind the figures of the README."""

import argparse
import importlib
import os
import platform

import numpy as np
import scipy

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


def run(arguments: argparse.Namespace) -> int:
    """Print the tables of each part as they are measured."""
    print(
        f"{platform.machine()}, {os.cpu_count()} cores, {platform.system()}; Python "
        f"{platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}"
    )
    for part in arguments.parts or PARTS:
        for table in importlib.import_module(f"app.cli.bench.{part}").tables():
            print(f"\n{table}", flush=True)
    return 0
