"""What is said to `lissom export`."""

import argparse
import re
from pathlib import Path

from app.cli.options import EXPORT_FORMATS, FRAMINGS, add_variant_option, input_file

EPILOG = """\
What is not given is as the project's own export settings have it.

formats:
  png          frame_0000.png, ... in the folder --out, which is made if it is missing. Frame 0 of
               the timeline is frame_0000.png; numbers go on one by one from that of the first
               frame, with --fps too, and have more digits if one needs them. Frames of before
               with the same names are replaced, other files stay.
  apng, webp   an animation with exact colours and transparency
  gif          an animation in 255 colours a frame; each pixel is opaque or transparent, so that
               soft edges become hard
  spritesheet  all frames in one PNG, row by row; how many is told on standard output
  mp4          H.264 video; needs a background colour and pip install 'lissom[video]'
Without --format, an --out that ends in .apng, .gif, .webp or .mp4 chooses it. Animations of a
project that loops play for ever, others once. PNGs have straight alpha. Interrupted, png leaves
the frames that are done, each of them whole, and every other format nothing.

examples:
  lissom export wave.lissom --out frames
  lissom export wave.lissom --out wave.gif --size 480x480 --fps 12
  lissom export wave.lissom --out wave.mp4 --background "#ffffff" --framing fit
"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the options of `lissom export`."""
    parser.epilog = EPILOG
    parser.add_argument("project", metavar="PROJECT", type=input_file, help="the .lissom file")
    parser.add_argument(
        "--out",
        metavar="DIR_OR_FILE",
        type=Path,
        required=True,
        help="a folder for PNG frames, a file for every other format",
    )
    parser.add_argument(
        "--frames", metavar="A:B", type=_frames, help="frames of the timeline, both ends included"
    )
    parser.add_argument(
        "--fps", metavar="F", type=float, help="pictures a second (default: the project's)"
    )
    parser.add_argument(
        "--size", metavar="WxH", type=_size, help="in pixels (default: as the framing needs)"
    )
    parser.add_argument(
        "--background", metavar="COLOUR", help="transparent, or a colour such as #ffffff"
    )
    parser.add_argument(
        "--framing", choices=FRAMINGS, help="the picture's own canvas, or all of the motion"
    )
    add_variant_option(parser)
    parser.add_argument("--format", choices=EXPORT_FORMATS, help="what to write")


def _frames(text: str) -> tuple[int, int]:
    return _two_numbers(text, r"(\d+):(\d+)", "two frames with a colon, such as 0:47")


def _size(text: str) -> tuple[int, int]:
    return _two_numbers(text, r"(\d+)[xX×](\d+)", "width and height, such as 1920x1080")


def _two_numbers(text: str, pattern: str, wanted: str) -> tuple[int, int]:
    match = re.fullmatch(pattern, text)
    if match is None:
        raise argparse.ArgumentTypeError(f"expected {wanted}, not {text!r}")
    return int(match[1]), int(match[2])
