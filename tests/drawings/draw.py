"""Draw the sample pictures: `python tests/drawings/draw.py [--out DIR] [NAME ...]`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

import friend
from character import character
from checkers import bar, ring, s
from dragon import dragon
from giraffe import giraffe
from octopus import octopus

SAMPLES = Path(__file__).resolve().parents[2] / "sample_images"
# Drawings on layers, by their own scripts.
LAYERED = {"friend": friend.save}
PICTURES = {
    "bar": bar,
    "character": character,
    "dragon": dragon,
    "giraffe": giraffe,
    "octopus": octopus,
    "ring": ring,
    "s": s,
}


def main(words: Sequence[str] | None = None) -> None:
    """Write the named pictures, or all of them, as PNG or OpenRaster files.

    Parameters
    ----------
    words : sequence of str, optional
        Command line; that of the process when missing.
    """
    parser = argparse.ArgumentParser(description="Draw the sample pictures of Lissom.")
    known = [*PICTURES, *LAYERED]
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(known))
    parser.add_argument("--out", type=Path, default=SAMPLES, metavar="DIR")
    arguments = parser.parse_args(words)
    unknown = set(arguments.names) - set(known)
    if unknown:
        parser.error(
            f"no picture named {', '.join(sorted(unknown))}: choose from {', '.join(known)}"
        )
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name in arguments.names or known:
        if name in LAYERED:
            LAYERED[name](arguments.out / f"{name}.ora")
        else:
            PICTURES[name]().save(arguments.out / f"{name}.png")


if __name__ == "__main__":
    main()
