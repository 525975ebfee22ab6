"""Options shared by several subcommands, and their choices.

Choices and defaults are repeated here if their own module loads slowly, so that help comes at once.
A test compares them with the original.
"""

import argparse
import os
import re
import sys
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from app.baseline import Baseline
from app.errors import LissomError
from app.export_formats import expand_colour
from app.texts import N_, _
from engine.variant import Variant

DETAILS = ("coarse", "normal", "fine")
HOLES = ("keep", "fill")
ENCLOSED = ("auto", "keep", "remove")
DEFAULT_DETAIL = "normal"
DEFAULT_TRIANGLES = 100_000
DEFAULT_TOLERANCE = 18
VARIANTS = tuple(variant.value for variant in Variant)
METHODS = (*VARIANTS, *(method.value for method in Baseline))
FRAMINGS = ("canvas", "fit")
NAMED_LIKE_FOLDER = N_("cannot write {name}: this is a folder; name a file")
NO_STANDARD_OUTPUT = N_("Lissom cannot write to standard output; name a file instead of -")


def input_file(text: str) -> Path:
    """Return the path of an input file; refuse a missing one before anything else.

    Raises
    ------
    LissomError
        Not a usage error: the option is correct, but the file is missing.
    """
    path = Path(_named(text))
    try:
        path.stat()
    except OSError as error:
        raise LissomError(
            _("cannot read {path}: {reason}").format(path=text, reason=error.strerror)
        ) from error
    return path


class Output(NamedTuple):
    path: Path
    text: str  # as typed

    def as_file(self) -> Path:
        """Return the path of a file; raise a `LissomError` if the text can only name a folder."""
        if os.path.basename(self.text) in {"", "."}:  # noqa: PTH119 - paths end without a slash
            raise LissomError(_(NAMED_LIKE_FOLDER).format(name=self.text))
        return self.path


def output(text: str) -> Output:
    """Return the path of an output file or folder, which need not exist.

    Raises `LissomError` if the path is empty or a dash, which stands for standard output elsewhere.
    """
    if text == "-":
        raise LissomError(_(NO_STANDARD_OUTPUT))
    return Output(Path(_named(text)), text)


def output_file(text: str) -> Path:
    """Return the path of an output file, as `output`."""
    return output(text).as_file()


def _named(text: str) -> str:
    """Return the name of a file; refuse an empty one, which Python takes for the current folder."""
    if not text:
        raise LissomError(_("the file name is empty; give a name"))
    return text


def whole_number(least: int, most: int = sys.maxsize) -> Callable[[str], int]:
    """Return a parser of whole numbers in a range, both ends included."""
    wanted = (
        _("expected a whole number, at least {least:,}, not {text!r}")
        if most == sys.maxsize
        else _("expected a whole number between {least:,} and {most:,}, not {text!r}")
    )

    def read(text: str) -> int:
        if not text.isdecimal() or not least <= int(text) <= most:
            message = wanted.format(least=least, most=most, text=text)
            raise argparse.ArgumentTypeError(message)
        return int(text)

    return read


def add_project(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("project", metavar="PROJECT", type=input_file, help=_("the .lissom file"))


def add_out(
    parser: argparse.ArgumentParser,
    metavar: str,
    about: str = _("the file to write"),
    *,
    place: Callable[[str], Path | Output] = output_file,
    is_required: bool = True,
) -> None:
    parser.add_argument("--out", metavar=metavar, type=place, required=is_required, help=about)


def add_meshing_options(parser: argparse.ArgumentParser) -> None:
    """Declare how the domain of a picture is built: `triangles` and `detail`."""
    parser.add_argument(
        "--triangles",
        metavar="N",
        type=int,
        default=DEFAULT_TRIANGLES,
        help=_("approximate number of triangles, 1000 to 2000000 (default: %(default)s)"),
    )
    parser.add_argument(
        "--detail",
        choices=DETAILS,
        default=DEFAULT_DETAIL,
        help=_("how closely the outline follows the subject (default: %(default)s)"),
    )


def add_cut_out_options(parser: argparse.ArgumentParser) -> None:
    either = parser.add_mutually_exclusive_group()
    either.add_argument(
        "--background",
        metavar="WHICH",
        type=_background,
        default="auto",
        help=_(
            "the background to remove from an opaque picture: auto, none, or a colour such as "
            "#fff that reaches the border (default: %(default)s)"
        ),
    )
    either.add_argument(
        "--mask",
        metavar="MASK.png",
        type=input_file,
        help=_("a picture of the same size, in which white parts are kept and black parts removed"),
    )
    parser.add_argument(
        "--tolerance",
        metavar="N",
        type=int,
        default=DEFAULT_TOLERANCE,
        help=_("how many levels the background's colour may vary, 0 to 255 (default: %(default)s)"),
    )
    parser.add_argument(
        "--enclosed",
        choices=ENCLOSED,
        default=ENCLOSED[0],
        help=_(
            "treatment of enclosed parts of the background's colour, such as the gap between an "
            "arm and the body; auto removes vivid colours, and keeps white, grey and black "
            "(default: %(default)s)"
        ),
    )
    parser.add_argument(
        "--holes",
        choices=HOLES,
        default=HOLES[0],
        help=_("keep or fill large holes (default: %(default)s)"),
    )


def _background(text: str) -> str | tuple[int, int, int]:
    if text in {"auto", "none"}:
        return text
    colour = expand_colour(text)
    if re.fullmatch("#[0-9a-fA-F]{6}", colour) is None:
        raise argparse.ArgumentTypeError(
            _("expected auto, none, or a colour such as #fff or #ffffff, not {text!r}").format(
                text=text
            )
        )
    red, green, blue = bytes.fromhex(colour[1:])
    return red, green, blue


def add_variant_option(parser: argparse.ArgumentParser) -> None:
    """Declare the variant, by default the project's."""
    parser.add_argument(
        "--variant",
        choices=VARIANTS,
        help=_("how to blend the keyframes (default: the project's variant)"),
    )
