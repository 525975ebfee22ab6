"""Arguments of `lissom export`."""

import argparse
import re
import textwrap
from typing import Any

from app.cli.options import FRAMINGS, add_out, add_project, add_variant_option, output
from app.export_formats import EXPORT_FORMATS, FormatSettings, format_by_suffix

COLUMN = max(map(len, EXPORT_FORMATS)) + 4
FORMATS = "\n".join(
    textwrap.fill(
        format_.about,
        width=98,
        initial_indent=f"  {name}".ljust(COLUMN),
        subsequent_indent=" " * COLUMN,
        break_on_hyphens=False,
    )
    for name, format_ in EXPORT_FORMATS.items()
)
*OTHERS, LAST = format_by_suffix()  # suffixes
EPILOG = f"""\
What is not given is as the project's own export settings have it.

formats:
{FORMATS}
Without --format, an --out that ends in {", ".join(OTHERS)} or {LAST} chooses it. Animations
of a project that loops play for ever, others once. PNGs have straight alpha; colours are those of
sRGB. Interrupted, png leaves the frames that are done, each of them whole, and every other format
nothing. Files of before are replaced.

examples:
  lissom export wave.lissom --out frames
  lissom export wave.lissom --out wave.gif --size 480x480 --fps 12
  lissom export wave.lissom --out wave.mp4 --background "#ffffff" --framing fit
  lissom export wave.lissom --out wave.glb --tolerance 0.2
  lissom export wave.lissom --out pose.png --frame 12 --size 4000x3000
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_project(parser)
    add_out(
        parser,
        "DIR_OR_FILE",
        "a folder for PNG frames, a file for every other format",
        place=output,
    )
    either = parser.add_mutually_exclusive_group()
    either.add_argument(
        "--frames", metavar="A:B", type=_frames, help="frames of the timeline, both ends included"
    )
    either.add_argument(
        "--frame", metavar="N", type=int, help="one frame; to a name in .png, as one picture"
    )
    parser.add_argument(
        "--fps", metavar="F", type=float, help="pictures a second (default: the project's)"
    )
    parser.add_argument(
        "--size", metavar="WxH", type=_size, help="in pixels (default: as the framing needs)"
    )
    parser.add_argument(
        "--background", metavar="COLOUR", help="transparent, or a colour such as #fff or #ffffff"
    )
    parser.add_argument(
        "--framing",
        choices=FRAMINGS,
        help="the canvas, or all of the motion; with a camera both are what it shows",
    )
    parser.add_argument(
        "--names",
        metavar="PATTERN",
        help='of the files of PNG frames, such as "{name}_####": "#" for each digit of the number, '
        "{name} for the project's name, here and in --out (default: the project's, frame_####)",
    )
    for options in FormatSettings().options().values():
        for name, option in options.option_fields().items():
            usual = getattr(options, name)
            if isinstance(usual, bool):
                how: dict[str, Any] = {"action": argparse.BooleanOptionalAction}
            else:
                is_whole = isinstance(usual, int)
                how = {"metavar": "N" if is_whole else "PX", "type": int if is_whole else float}
            parser.add_argument(f"--{option.flag}", dest=name, help=option.description, **how)
    parser.add_argument("--layer", metavar="NAME", help="export this layer alone")
    # Its name in earlier versions.
    parser.add_argument("--figure", dest="layer", metavar="NAME", help=argparse.SUPPRESS)
    add_variant_option(parser)
    parser.add_argument("--format", choices=tuple(EXPORT_FORMATS), help="what to write")


def _frames(text: str) -> tuple[int, int]:
    return _two_numbers(text, r"(\d+):(\d+)", "two frames with a colon, such as 0:47")


def _size(text: str) -> tuple[int, int]:
    return _two_numbers(text, r"(\d+)[xX×](\d+)", "width and height, such as 1920x1080")


def _two_numbers(text: str, pattern: str, wanted: str) -> tuple[int, int]:
    match = re.fullmatch(pattern, text)
    if match is None:
        raise argparse.ArgumentTypeError(f"expected {wanted}, not {text!r}")
    return int(match[1]), int(match[2])
