"""Export formats and their options, one table entry per format.

This module loads no other part, so that the command line can list the formats at once. A new format
is an entry here and a writer in `app.export.writers`. The window, the command line and project
files take its options from this table.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any, Final

from app.errors import Extra, LissomError
from app.texts import _


def expand_colour(text: str) -> str:
    """Return the colour "#rrggbb" for "#rgb"; return any other text unchanged."""
    is_short = re.fullmatch("#[0-9a-fA-F]{3}", text) is not None
    return "#" + "".join(2 * digit for digit in text[1:]) if is_short else text


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """An option that only some formats have."""

    label: str  # in the window
    tip: str = ""  # in the window
    flag: str  # on the command line, without dashes
    description: str
    # Values with labels; numbers, or no choices, allow any number.
    choices: tuple[tuple[bool | float | None, str], ...] = ()
    minimum: float = 0  # of a number
    maximum: float = 1  # of a number


def _option(usual: Any, **option: Any) -> Any:
    """Return a dataclass field with this default and this option."""
    return field(default=usual, metadata={"option": Option(**option)})


@dataclass(frozen=True, slots=True, kw_only=True)
class FormatOptions:
    """Base of the options of one or more formats."""

    def __post_init__(self) -> None:
        for name, option in self.option_fields().items():
            value = getattr(self, name)
            if value is not None and not option.minimum <= value <= option.maximum:
                raise LissomError(
                    _("{option} must be {smallest:,} to {largest:,}, not {value}.").format(
                        option=name.capitalize(),
                        smallest=option.minimum,
                        largest=option.maximum,
                        value=value,
                    )
                )

    @classmethod
    def option_fields(cls) -> dict[str, Option]:
        """Return the options by field name."""
        return {each.name: each.metadata["option"] for each in fields(cls)}


@dataclass(frozen=True, slots=True, kw_only=True)
class SpriteSheetOptions(FormatOptions):
    """Layout of the frames on a sprite sheet."""

    trimmed: bool = _option(
        True,  # noqa: FBT003 - the usual value
        label=_("Frame area"),
        choices=((True, _("Trimmed")), (False, _("Same size"))),
        flag="trim",
        description=_(
            "trim each frame on a sprite sheet to its visible part (default: the project's "
            "setting, yes)"
        ),
    )
    padding: int = _option(
        2,
        label=_("Padding"),
        tip=_("Transparent pixels between frames and at the border"),
        flag="padding",
        description=_("pixels between frames of a sprite sheet"),
        maximum=256,
    )
    power_of_two: bool = _option(
        False,  # noqa: FBT003 - the usual value
        label=_("Sheet sides"),
        choices=((False, _("Any")), (True, _("Powers of two"))),
        flag="power-of-two",
        description=_("make the sides of a sprite sheet powers of two"),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshOptions(FormatOptions):
    """Accuracy and triangle count of an export of meshes.

    Without a tolerance, the accuracy is half a pixel with at most 8 shapes, which every viewer
    shows.
    """

    triangles: int = _option(
        4_000,
        label=_("Triangles"),
        tip=_(
            "The approximate number for each layer. More triangles bend more smoothly, in a "
            "larger file"
        ),
        flag="triangles",
        description=_("approximate number of triangles of each layer in a model (default: 4000)"),
        minimum=100,
        maximum=2_000_000,  # the largest number of triangles of a domain
    )
    tolerance: float | None = _option(
        None,
        label=_("Tolerance"),
        tip=_(
            "The largest distance between the model and the motion, in pixels. By default the "
            "model has at most 8 shapes, which every viewer shows. A custom tolerance uses as "
            "many shapes as it needs"
        ),
        choices=((None, _("½ px, 8 shapes")), (0.5, _("Custom"))),
        flag="tolerance",
        description=_(
            "the largest distance of a model from the motion, in pixels, with as many shapes as "
            "needed (default: 0.5, with at most 8 shapes)"
        ),
        minimum=0.001,
        maximum=100,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FormatSettings:
    """Options of all formats; an export uses the options named by `ExportFormat.options`."""

    sheet: SpriteSheetOptions = SpriteSheetOptions()
    shapes: MeshOptions = MeshOptions()

    def options(self) -> dict[str, Any]:
        """Return the options by field name."""
        return {each.name: getattr(self, each.name) for each in fields(FormatSettings)}


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportFormat:
    """Properties of an export format; `app.export.writers` holds the writers."""

    label: str
    group: str  # heading in lists; formats of one group follow one another
    use: str  # one line: the purpose and the limits of the format
    about: str  # description for the help of the command line
    # Endings of the file name, the default first. Empty if each frame is a file in a folder.
    suffixes: tuple[str, ...] = ()
    data_suffix: str = ""  # ending of the data file beside the picture; empty without one
    is_transparent: bool = True  # otherwise the format needs a background
    is_drawn: bool = True  # whether the file contains pictures; otherwise meshes, for any rate
    has_frame: bool = True  # whether the file shows a frame of the scene before a background
    keeps_order: bool = True  # whether the draw order may change over time
    composites: bool = True  # whether the file shows blend modes, clipping and group opacity
    largest: int | None = None  # side of a picture in pixels
    has_sound: bool = False  # whether the file carries the sounds
    plays_on: bool = False  # whether the file says if it plays once or for ever
    is_still: bool = False  # one frame: at the playhead, or the first
    block: int = 1  # the sides of a picture are multiples of this number of pixels
    fastest: float | None = None  # pictures per second
    extra: Extra | None = None
    options: str = ""  # field of `FormatSettings`; empty without options

    def whole_blocks(self, size: tuple[int, int]) -> tuple[int, int]:
        """Return the smallest size of whole blocks that contains this size."""
        width, height = (side + -side % self.block for side in size)
        return width, height


EXPORT_FORMATS: Final[Mapping[str, ExportFormat]] = MappingProxyType(
    {
        "png": ExportFormat(
            label=_("PNG frames"),
            group=_("Frames"),
            use=_("For compositing and editing: exact, with each frame in its own file."),
            about=_(
                "frame_0000.png, ... in the folder --out, which is created if it is missing. "
                "Frame 0 of the timeline is frame_0000.png. Numbers count up from the first "
                "frame, with --fps too, and have more digits if one needs them. Earlier frames "
                "with the same names are replaced; other files stay."
            ),
        ),
        "picture": ExportFormat(
            label=_("PNG picture"),
            group=_("Frames"),
            use=_("The frame at the playhead, exact, at any size."),
            about=_("only the frame --frame, as a PNG"),
            suffixes=(".png",),
            is_still=True,
        ),
        "apng": ExportFormat(
            label=_("Animated PNG"),
            group=_("Animation"),
            plays_on=True,
            use=_("For web pages and chats: exact colours and soft edges; large files."),
            about=_("an animation with exact colours and transparency"),
            suffixes=(".apng", ".png"),
        ),
        "gif": ExportFormat(
            label=_("GIF"),
            group=_("Animation"),
            plays_on=True,
            use=_("Plays everywhere; hard edges, 255 colours, at most 50 frames a second."),
            about=_(
                "an animation in 255 colours a frame; each pixel is opaque or transparent, so "
                "soft edges become hard"
            ),
            suffixes=(".gif",),
            largest=65_535,
            fastest=50.0,  # programs slow down pictures that last under 2/100 of a second
        ),
        "webp": ExportFormat(
            label=_("WebP"),
            group=_("Animation"),
            plays_on=True,
            use=_(
                "Exact colours as in Animated PNG, in a smaller file; for browsers, as few "
                "editors read it."
            ),
            about=_("an animation with exact colours and transparency, smaller than apng"),
            suffixes=(".webp",),
            largest=16_383,
        ),
        "mp4": ExportFormat(
            label=_("MP4 video"),
            group=_("Video"),
            use=_("Plays everywhere, small; no transparency, even sides only."),
            about=_("H.264 video with the sounds as AAC; needs a background colour"),
            suffixes=(".mp4",),
            has_sound=True,
            is_transparent=False,
            largest=16_384,
            block=2,
            extra="video",
        ),
        "webm": ExportFormat(
            label=_("WebM video"),
            group=_("Video"),
            use=_("For browsers: small, with soft transparency; few editors read it."),
            about=_(
                "VP9 video with the sounds as Opus; transparent unless there is a background colour"
            ),
            suffixes=(".webm",),
            has_sound=True,
            largest=16_384,
            extra="video",
        ),
        "mov": ExportFormat(
            label=_("ProRes video"),
            group=_("Video"),
            use=_("For video editors: nearly exact, with transparency; large files."),
            about=_(
                "ProRes 4444 video with the sounds uncompressed; transparent (straight alpha) "
                "unless there is a background colour"
            ),
            suffixes=(".mov",),
            has_sound=True,
            largest=16_384,
            extra="video",
        ),
        "spritesheet": ExportFormat(
            label=_("Sprite sheet"),
            group=_("Engine and web"),
            use=_(
                "For 2D engines: all frames in one PNG, with a data file; a fixed rate and size."
            ),
            about=_(
                "all frames in one PNG, row by row, with a JSON file of their positions. The "
                "JSON has the form of TexturePacker, with durations and tags as in Aseprite. "
                "The timeline's markers become tags. By default frames are trimmed and 2 pixels "
                "apart"
            ),
            suffixes=(".png",),
            data_suffix=".json",
            largest=16_384,
            options="sheet",
        ),
        "glb": ExportFormat(
            label=_("glTF model"),
            group=_("Engine and web"),
            plays_on=True,
            use=_(
                "For engines and Blender: a moving mesh at any rate and size, in one small file."
            ),
            about=_(
                "a textured mesh with animated morph targets, for engines, Blender and "
                "browsers. Base shape and targets come within --tolerance of the motion. 100 "
                "pixels are a metre, and the origin is the middle of the canvas' lower edge"
            ),
            suffixes=(".glb",),
            is_drawn=False,
            has_frame=False,
            keeps_order=False,
            composites=False,
            options="shapes",
        ),
        "html": ExportFormat(
            label=_("Web page"),
            group=_("Engine and web"),
            plays_on=True,
            use=_("For the web: one file, sharp at any size; needs a browser with WebGL 2."),
            about=_(
                "one page that plays the same shapes as glb with WebGL 2 and needs no other "
                "files. It fills its frame. Drag to scrub, and click to pause. It carries the "
                "sounds, which take much of its size"
            ),
            suffixes=(".html", ".htm"),
            has_sound=True,
            is_drawn=False,
            options="shapes",
        ),
    }
)

# The format of a single frame.
STILL_FORMAT: Final = next(name for name, format_ in EXPORT_FORMATS.items() if format_.is_still)


def format_by_suffix() -> dict[str, str]:
    """Return the format of each unambiguous file name ending; .png is ambiguous."""
    every = [suffix for format_ in EXPORT_FORMATS.values() for suffix in format_.suffixes]
    return {
        suffix: name
        for name, format_ in EXPORT_FORMATS.items()
        for suffix in format_.suffixes
        if every.count(suffix) == 1
    }
