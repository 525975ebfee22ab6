"""`lissom export`: a project's animation as pictures, video or a model."""

import argparse
import re
import textwrap
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from app.cli.console import print_line, print_notices
from app.cli.options import FRAMINGS, add_out, add_project, add_variant_option, output
from app.errors import LissomError
from app.export_formats import EXPORT_FORMATS, STILL_FORMAT, FormatSettings, format_by_suffix
from app.texts import N_, _

if TYPE_CHECKING:
    from app.document import ExportSettings

NO_USE = N_("{name} does not use --{flag}; leave it out")

COLUMN = max(map(len, EXPORT_FORMATS)) + 4
FORMATS = "\n".join(
    textwrap.fill(
        _(format_.about),
        width=98,
        initial_indent=f"  {name}".ljust(COLUMN),
        subsequent_indent=" " * COLUMN,
        break_on_hyphens=False,
    )
    for name, format_ in EXPORT_FORMATS.items()
)
*OTHERS, LAST = format_by_suffix()  # suffixes
EPILOG = _(
    """\
The defaults of options are the project's own export settings.

formats:
{formats}
Without --format, an --out that ends in {suffixes} or {last}
chooses the format. Animations of a project that loops play for ever, others once. PNGs have
straight alpha, and colours are sRGB. An interrupted export to png keeps the finished frames, each
of them whole; other formats write nothing then. Existing files are replaced.

examples:
  lissom export wave.lissom --out frames
  lissom export wave.lissom --out wave.gif --size 480x480 --fps 12
  lissom export wave.lissom --out wave.mp4 --background "#ffffff" --framing fit
  lissom export wave.lissom --out wave.glb --tolerance 0.2
  lissom export wave.lissom --out pose.png --frame 12 --size 4000x3000
"""
).format(formats=FORMATS, suffixes=", ".join(OTHERS), last=LAST)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_project(parser)
    add_out(
        parser,
        "DIR_OR_FILE",
        _("a folder for PNG frames, or a file for every other format"),
        place=output,
    )
    either = parser.add_mutually_exclusive_group()
    either.add_argument(
        "--frames",
        metavar="A:B",
        type=_frames,
        help=_("frames of the timeline, both ends included"),
    )
    either.add_argument(
        "--frame",
        metavar="N",
        type=int,
        help=_("render only this frame; with a name that ends in .png, as one picture"),
    )
    parser.add_argument(
        "--fps", metavar="F", type=float, help=_("frames per second (default: the project's)")
    )
    parser.add_argument(
        "--repeat",
        metavar="N",
        type=int,
        help=_("how often the frames play in the file (default: the project's setting, once)"),
    )
    parser.add_argument(
        "--speed",
        metavar="PERCENT",
        type=float,
        help=_("the speed of the motion; 50 is half as fast (default: the project's, 100)"),
    )
    parser.add_argument(
        "--size",
        metavar="WxH",
        type=_size,
        help=_("the size of a frame in pixels (default: from the framing)"),
    )
    parser.add_argument(
        "--background", metavar="COLOUR", help=_("transparent, or a colour such as #fff or #ffffff")
    )
    parser.add_argument(
        "--framing",
        choices=FRAMINGS,
        help=_("show the canvas, or fit all of the motion; with a camera both show its view"),
    )
    parser.add_argument(
        "--names",
        metavar="PATTERN",
        help=_(
            'names of PNG frames, such as "{name}_####". "#" is a digit of the frame; {name} is '
            "the project's name, which --out may contain too (default: the project's names, "
            "frame_####)"
        ),
    )
    for options in FormatSettings().options().values():
        for name, option in options.option_fields().items():
            usual = getattr(options, name)
            if isinstance(usual, bool):
                how: dict[str, Any] = {"action": argparse.BooleanOptionalAction}
            else:
                is_whole = isinstance(usual, int)
                how = {"metavar": "N" if is_whole else "PX", "type": int if is_whole else float}
            parser.add_argument(f"--{option.flag}", dest=name, help=_(option.description), **how)
    parser.add_argument(
        "--sound",
        choices=("all", "none"),
        help=_("carry the sounds, or leave them out (default: the project's setting, all)"),
    )
    parser.add_argument("--layer", metavar="NAME", help=_("export this layer alone"))
    # Its name in earlier versions.
    parser.add_argument("--figure", dest="layer", metavar="NAME", help=argparse.SUPPRESS)
    add_variant_option(parser)
    parser.add_argument("--format", choices=tuple(EXPORT_FORMATS), help=_("the format to write"))


def run(arguments: argparse.Namespace) -> int:
    from app.cli.project_export import export_project, keep_layer
    from app.document import motion_notices
    from app.export import PROJECT, ExportRequest, check_request
    from app.storage import load_project

    document = load_project(arguments.project)
    print_notices(motion_notices(document))
    if arguments.layer is not None:
        document = keep_layer(document, arguments.layer)
    name = arguments.project.stem
    named: Path = arguments.out.path
    out = named.parent / named.name.replace(PROJECT, name)
    request = ExportRequest(
        out=out,
        settings=_settings(document.export, arguments, out),
        project=name,
        fps=arguments.fps,
        sources=(arguments.project,),
    )
    if EXPORT_FORMATS[request.settings.format].suffixes:
        arguments.out.as_file()
    check_request(document, request)
    _check_options(request.settings.format, arguments)
    print_line(export_project(document, request, arguments.variant))
    return 0


def _settings(own: "ExportSettings", arguments: argparse.Namespace, out: Path) -> "ExportSettings":
    """Return the project's settings, replaced by the given options."""
    from app.document import FrameRange

    one = arguments.frame
    frames = arguments.frames if one is None else (one, one)
    name = arguments.format or _format_of(out, own, is_one=one is not None)
    own = own if name is None else own.in_format(name)
    given = {
        "size": arguments.size,
        "background": arguments.background,
        "framing": arguments.framing,
        "frames": None if frames is None else FrameRange(*frames),
        "names": arguments.names,
        "repeat": arguments.repeat,
        "speed": None if arguments.speed is None else arguments.speed / 100,
        "sound": None if arguments.sound is None else arguments.sound == "all",
    }
    options = {
        group: replace(
            asking, **_known({name: getattr(arguments, name) for name in asking.option_fields()})
        )
        for group, asking in own.options().items()
    }
    return replace(own, **_known(given), **options)


def _check_options(name: str, arguments: argparse.Namespace) -> None:
    """Raise `LissomError` for options that the format does not use."""
    format_ = EXPORT_FORMATS[name]
    framing = () if format_.has_frame else ("size", "background", "framing")
    timing = (
        *(("repeat",) if format_.is_still or not format_.is_drawn else ()),
        *(("speed",) if format_.is_still else ()),
    )
    names = ("names",) if format_.suffixes else ()
    useless = {option: option for option in (*framing, *timing, *names)}
    for group, asking in FormatSettings().options().items():
        if group != format_.options:
            useless |= {each: option.flag for each, option in asking.option_fields().items()}
    for each, flag in useless.items():
        if getattr(arguments, each) is not None:
            raise LissomError(_(NO_USE).format(name=name, flag=flag))


def _known(given: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in given.items() if value is not None}


def _format_of(out: Path, own: "ExportSettings", *, is_one: bool) -> str | None:
    """Return the only format for a file name, or None if the project's format fits.

    For a single frame, pictures come first among several formats.

    Raises `LissomError` if no format or several formats have this suffix.
    """
    suffix = out.suffix.lower()
    if out.is_dir() or not suffix:
        return None
    every = {end: name for name, format_ in EXPORT_FORMATS.items() for end in format_.suffixes}
    if suffix not in every:
        raise LissomError(
            _(
                "no format has the file name ending {suffix}; choose one of {suffixes}, or add "
                "--format"
            ).format(suffix=out.suffix, suffixes=", ".join(every))
        )
    is_own = suffix in EXPORT_FORMATS[own.format].suffixes
    if suffix in format_by_suffix() or (is_own and not is_one):
        return None if is_own else format_by_suffix()[suffix]
    if is_one:
        return STILL_FORMAT
    several = [name for name, format_ in EXPORT_FORMATS.items() if suffix in format_.suffixes]
    raise LissomError(
        _(
            "the name {path} fits several formats ({formats}); add --format, or --frame N for a "
            "picture of one frame"
        ).format(path=out, formats=", ".join(several))
    )


def _frames(text: str) -> tuple[int, int]:
    wanted = _("expected two frames with a colon, such as 0:47, not {text!r}")
    return _two_numbers(text, r"(\d+):(\d+)", wanted)


def _size(text: str) -> tuple[int, int]:
    wanted = _("expected width and height, such as 1920x1080, not {text!r}")
    return _two_numbers(text, r"(\d+)[xX×](\d+)", wanted)


def _two_numbers(text: str, pattern: str, wanted: str) -> tuple[int, int]:
    match = re.fullmatch(pattern, text)
    if match is None:
        raise argparse.ArgumentTypeError(wanted.format(text=text))
    return int(match[1]), int(match[2])
