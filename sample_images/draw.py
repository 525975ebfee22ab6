"""Draw the sample pictures: `python sample_images/draw.py [--out DIR] [NAME ...]`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from character import character
from checkers import bar, ring, s
from dragon import dragon
from giraffe import giraffe
from octopus import octopus

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
    """Write the named pictures, or all of them, as PNG files.

    Parameters
    ----------
    words : sequence of str, optional
        Command line; that of the process when missing.
    """
    parser = argparse.ArgumentParser(description="Draw the sample pictures of Lissom.")
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(PICTURES))
    parser.add_argument("--out", type=Path, default=Path(__file__).parent, metavar="DIR")
    arguments = parser.parse_args(words)
    unknown = set(arguments.names) - set(PICTURES)
    if unknown:
        parser.error(
            f"no picture named {', '.join(sorted(unknown))}: choose from {', '.join(PICTURES)}"
        )
    arguments.out.mkdir(parents=True, exist_ok=True)
    for name in arguments.names or PICTURES:
        PICTURES[name]().save(arguments.out / f"{name}.png")


if __name__ == "__main__":
    main()
