"""Options that several subcommands share, and the words that they choose from.

Every word stands here once more, so that usage is checked without loading what the words choose; a
test compares them with it.
"""

import argparse
from pathlib import Path

from app.errors import LissomError
from engine.variant import Variant

DETAILS = ("coarse", "normal", "fine")
HOLES = ("fill", "keep")
DEFAULT_DETAIL = "normal"
DEFAULT_TRIANGLES = 100_000
VARIANTS = tuple(Variant)
FRAMINGS = ("canvas", "fit")


def input_file(text: str) -> Path:
    """Return the path of a file that is read; refuse one that is not there before all else.

    Raises
    ------
    LissomError
        Not an error of usage: what was said is right, but nothing is there.
    """
    path = Path(text)
    try:
        path.stat()
    except OSError as error:
        raise LissomError(f"cannot read {text}: {error.strerror}") from error
    return path


def add_meshing_options(parser: argparse.ArgumentParser) -> None:
    """Declare how the domain of a picture is built: `triangles` and `detail`."""
    parser.add_argument(
        "--triangles",
        metavar="N",
        type=int,
        default=DEFAULT_TRIANGLES,
        help="how many triangles to aim at, 1000 to 2000000 (default: %(default)s)",
    )
    parser.add_argument(
        "--detail",
        choices=DETAILS,
        default=DEFAULT_DETAIL,
        help="how closely the outline follows the subject (default: %(default)s)",
    )


def add_variant_option(parser: argparse.ArgumentParser) -> None:
    """Declare how keyframes are blended where it need not be as the project says."""
    parser.add_argument(
        "--variant", choices=VARIANTS, help="how to blend the keyframes (default: the project's)"
    )
