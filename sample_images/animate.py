"""Make the sample projects: `python sample_images/animate.py [NAME ...] [--out DIR]`.

Each NAME.json beside this script says how NAME.png, or NAME.ora, moves; NAME.lissom is what Lissom
makes of both.
"""

import argparse
from pathlib import Path

from app.cli.main import main

HERE = Path(__file__).resolve().parent
TRIANGLES = 30_000  # fine enough at the pictures' size, and small to ship


def _drawing(name: str) -> Path:
    layered = HERE / f"{name}.ora"
    return layered if layered.exists() else HERE / f"{name}.png"


def animate() -> None:
    """Make the projects that the command line names, or all."""
    names = sorted(path.stem for path in HERE.glob("*.json"))
    parser = argparse.ArgumentParser(description=animate.__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(names))
    parser.add_argument("--out", type=Path, default=HERE, help="folder for the projects")
    arguments = parser.parse_args()
    for name in arguments.names or names:
        main(
            [
                "pose",
                str(_drawing(name)),
                str(HERE / f"{name}.json"),
                f"--out={arguments.out / f'{name}.lissom'}",
                f"--triangles={TRIANGLES}",
            ]
        )


if __name__ == "__main__":
    animate()
