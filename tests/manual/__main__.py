"""Draw the manual's pictures anew and build its pages: `python -m tests.manual [NAME ...]`.

The window's pictures and clips are taken from the running window, without a display; the others are
exported from the sample projects. Look at what was drawn before you keep it. `--pages` draws
nothing, and builds the pages alone.
"""

import argparse
import importlib
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "support"))

from app.cli.process import use_one_thread
from tests.manual.build import PICTURES, write


def run() -> None:
    """Draw the pictures that the command line names, or all, and build the pages."""
    use_one_thread()
    modules = [importlib.import_module(f"tests.manual.{name}") for name in ("motion", "window")]
    known = [name for module in modules for name in module.DRAWN]
    parser = argparse.ArgumentParser(prog="python -m tests.manual", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(known))
    parser.add_argument("--pages", action="store_true", help="build the pages alone")
    arguments = parser.parse_args()
    unknown = set(arguments.names) - set(known)
    if unknown:
        parser.error(f"no picture is named {', '.join(sorted(unknown))}: there are {known}")
    begun = time.perf_counter()
    wanted = [] if arguments.pages else arguments.names or known
    for module in modules:
        module.draw([name for name in module.DRAWN if name in wanted], PICTURES)
    write()
    print(f"{len(wanted)} pictures, and the pages, in {time.perf_counter() - begun:.0f} s")


if __name__ == "__main__":
    run()
