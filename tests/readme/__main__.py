"""Draw the pictures of the README anew: `python -m tests.readme [NAME ...] [--out DIR]`.

Those of the window are taken from the running window, without a display, and beside each a list is
written of the menus, tabs and tools that it shows. The others are exported from the sample
projects. Look at what was drawn before you keep it.
"""

import argparse
import importlib
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from app.cli.process import use_one_thread

SHOWN = Path(__file__).parents[2] / "sample_images" / "shown"


def run() -> None:
    """Draw the pictures that the command line names, or all."""
    use_one_thread()
    modules = [importlib.import_module(f"tests.readme.{name}") for name in ("motion", "window")]
    known = [name for module in modules for name in module.PICTURES]
    parser = argparse.ArgumentParser(prog="python -m tests.readme", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(known))
    parser.add_argument("--out", type=Path, default=SHOWN, metavar="DIR")
    arguments = parser.parse_args()
    unknown = set(arguments.names) - set(known)
    if unknown:
        parser.error(f"no picture is named {', '.join(sorted(unknown))}: there are {known}")
    arguments.out.mkdir(parents=True, exist_ok=True)
    begun = time.perf_counter()
    wanted = arguments.names or known
    for module in modules:
        module.draw([name for name in module.PICTURES if name in wanted], arguments.out)
    print(f"{len(wanted)} pictures in {time.perf_counter() - begun:.0f} s")


if __name__ == "__main__":
    run()
