"""The measurements behind the figures of the README: `python -m tests.bench [PART ...]`.

Each part runs in a process of its own, so that its memory is its own, and all others are measured
where one fails. The last column of a table is the ratio to its first row. Times are those of one
core of the processor unless a row says otherwise.
"""

import argparse
import os
import platform
import subprocess
import sys
from importlib.metadata import version
from pathlib import Path

ROOT = Path(__file__).parents[2]
# A part is the module of its name, which has an `Extent` (how much is measured), its `BRIEF` one,
# and `tables`, which yields what was measured.
PARTS = {
    "domain": "from a picture to its domain",
    "deform": "certified steps of a drag",
    "rest": "how soon a pull of a drawing comes to rest",
    "interpolate": "in-betweens, worked out directly",
    "streaming": "in-betweens as series in time",
    "methods": "in-betweens by every method of the paper's Figure 9",
    "clocks": "frames in which handles stay, wag on tracks and swing on springs",
    "export": "frames and files",
    "window": "the window: its start, its frames, how soon it follows a hand",
    "scenes": "drawings on many layers",
    "opening": "projects with 1 MB of each kind of thing in them",
    "limits": "hard requests under tight bounds; this one takes five minutes",
}


def main() -> int:
    """Run the parts that are asked for, by default all; the exit status is 1 if one failed."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.bench",
        description=__doc__,
        epilog="parts:\n" + "\n".join(f"  {part:<12} {what}" for part, what in PARTS.items()),
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("parts", metavar="PART", nargs="*", help="what to measure (default: all)")
    parser.add_argument(
        "--brief", action="store_true", help="measure little of everything, to try the bench itself"
    )
    arguments = parser.parse_args()
    unknown = set(arguments.parts) - set(PARTS)
    if unknown:
        parser.error(f"there is no part {', '.join(sorted(unknown))}; choose of {', '.join(PARTS)}")
    print(
        f"{platform.machine()}, {os.cpu_count()} cores, {platform.system()}; Python "
        f"{platform.python_version()}, NumPy {version('numpy')}, SciPy {version('scipy')}",
        flush=True,
    )
    failed = [part for part in arguments.parts or PARTS if _fails(part, brief=arguments.brief)]
    if failed:
        print(f"\nfailed: {', '.join(failed)}", file=sys.stderr)
    return 1 if failed else 0


def _fails(part: str, *, brief: bool) -> bool:
    words = [part, "--brief"] if brief else [part]
    command = [sys.executable, "-m", "tests.bench.part", *words]
    return subprocess.run(command, cwd=ROOT, check=False).returncode != 0


if __name__ == "__main__":
    raise SystemExit(main())
