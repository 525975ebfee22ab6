"""`lissom export`: a project's animation as pictures."""

import argparse
import re
from contextlib import closing
from dataclasses import replace
from pathlib import Path

from app.cli.console import StatusLine, notice
from app.document import (
    EXPORT_FORMATS,
    FRAMINGS,
    VARIANTS,
    ExportFormat,
    ExportSettings,
    FrameRange,
)
from app.export import (
    SUFFIXES,
    ExportPlan,
    ExportRequest,
    check_request,
    export,
    painter,
    plan_export,
    sheet_grid,
)
from app.motion import Animation
from app.render.gpu import create_context
from app.storage import decode_picture, load_project

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
    parser.add_argument("project", metavar="PROJECT", type=Path, help="the .lissom file")
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
    parser.add_argument(
        "--variant", choices=VARIANTS, help="how to blend the keyframes (default: the project's)"
    )
    parser.add_argument("--format", choices=EXPORT_FORMATS, help="what to write")


def run(arguments: argparse.Namespace) -> int:
    """Export a project."""
    document = load_project(arguments.project)
    request = ExportRequest(
        out=arguments.out, settings=_settings(document.export, arguments), fps=arguments.fps
    )
    check_request(document, request)
    picture = decode_picture(document.picture.data, f"the picture of {arguments.project}")
    context = create_context()
    status = StatusLine()
    try:
        status.show("preparing the in-betweens")
        animation = Animation(document, arguments.variant)
        plan = plan_export(document, request, animation)
        with (
            painter(context, document, picture.rgba, animation, plan) as draw,
            closing(export(plan, draw)) as steps,
        ):
            for done in steps:
                status.show(f"{done} of {len(plan.times)} frames")
    finally:
        status.clear()
        context.release()
    for message in plan.notices:
        notice(message)
    print(_summary(plan))
    return 0


def _settings(own: ExportSettings, arguments: argparse.Namespace) -> ExportSettings:
    """Return the project's settings with those that were given in their place."""
    given = {
        "format": arguments.format or _format_of(arguments.out),
        "size": arguments.size,
        "background": arguments.background,
        "framing": arguments.framing,
        "frames": None if arguments.frames is None else FrameRange(*arguments.frames),
    }
    return replace(own, **{name: value for name, value in given.items() if value is not None})


def _format_of(out: Path) -> ExportFormat | None:
    """Return the one format that a name stands for; .png stands for several."""
    suffix = out.suffix.lower()
    formats = [format_ for format_, suffixes in SUFFIXES.items() if suffix in suffixes]
    return formats[0] if len(formats) == 1 and not out.is_dir() else None


def _summary(plan: ExportPlan) -> str:
    width, height = plan.view.size
    count = len(plan.times)
    text = f"{plan.out}: {count} {'frame' if count == 1 else 'frames'} of {width} × {height} pixels"
    if plan.format == "png":
        names = dict.fromkeys((plan.frame_name(0), plan.frame_name(count - 1)))
        return f"{text}, {' to '.join(names)}"
    if plan.format == "spritesheet":
        columns, rows = sheet_grid(plan)
        return f"{text} in {columns} columns and {rows} rows"
    return f"{text}, {plan.fps:g} a second"


def _frames(text: str) -> tuple[int, int]:
    return _two_numbers(text, r"(\d+):(\d+)", "two frames with a colon, such as 0:47")


def _size(text: str) -> tuple[int, int]:
    return _two_numbers(text, r"(\d+)[xX×](\d+)", "width and height, such as 1920x1080")


def _two_numbers(text: str, pattern: str, wanted: str) -> tuple[int, int]:
    match = re.fullmatch(pattern, text)
    if match is None:
        raise argparse.ArgumentTypeError(f"expected {wanted}, not {text!r}")
    return int(match[1]), int(match[2])
