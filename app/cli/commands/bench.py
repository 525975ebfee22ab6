"""`lissom bench`: the measurements behind the figures of the README."""

import argparse
import importlib
import os
import platform

import numpy as np
import scipy

from app.cli.usage.bench import PARTS


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
