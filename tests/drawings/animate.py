"""Make the sample projects: `python tests/drawings/animate.py [NAME ...] [--out DIR]`.

Each NAME.json beside this script says how NAME.png, or NAME.ora, moves; NAME.lissom is what Lissom
makes of both, and moving/NAME.webp how it moves, small, for the welcome view.
"""

import argparse
import tempfile
from pathlib import Path

from PIL import Image, ImageSequence

from app.cli.main import main

SAMPLES = Path(__file__).resolve().parents[2] / "sample_images"
TRIANGLES = 30_000  # fine enough at the pictures' size, and small to ship
WIDTH, HEIGHT, FPS = 200, 160, 10  # of what the welcome view shows
QUALITY = 60  # of a hundred


def _drawing(name: str) -> Path:
    layered = SAMPLES / f"{name}.ora"
    return layered if layered.exists() else SAMPLES / f"{name}.png"


def _move(project: Path, out: Path) -> None:
    """Draw a project's motion, small, and write it as small as can be."""
    with tempfile.TemporaryDirectory() as folder:
        exact = Path(folder) / out.name
        size = f"--size={WIDTH}x{HEIGHT}"
        main(["export", str(project), f"--out={exact}", size, f"--fps={FPS}", "--framing=fit"])
        with Image.open(exact) as moving:
            first, *others = (frame.convert("RGBA") for frame in ImageSequence.Iterator(moving))
    out.parent.mkdir(exist_ok=True)
    first.save(
        out,
        save_all=True,
        append_images=others,
        duration=round(1000 / FPS),
        loop=0,
        quality=QUALITY,
        method=6,
    )


def animate() -> None:
    """Make the projects that the command line names, or all."""
    names = sorted(path.stem for path in SAMPLES.glob("*.json"))
    parser = argparse.ArgumentParser(description=animate.__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(names))
    parser.add_argument("--out", type=Path, default=SAMPLES, help="folder for the projects")
    arguments = parser.parse_args()
    for name in arguments.names or names:
        project = arguments.out / f"{name}.lissom"
        main(
            [
                "pose",
                str(_drawing(name)),
                str(SAMPLES / f"{name}.json"),
                f"--out={project}",
                f"--triangles={TRIANGLES}",
            ]
        )
        _move(project, arguments.out / "moving" / f"{name}.webp")


if __name__ == "__main__":
    animate()
