"""The formats that animations are exported to: one entry of a table each, and what each asks.

It loads nothing, so that the command line can tell of the formats at once. A new format is an entry
here and a writer in `app.export.writers`; the window and the command line ask for its options, and
project files hold them, by what stands here.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from types import MappingProxyType
from typing import Any, Final

from app.errors import Extra, LissomError


def expand_colour(text: str) -> str:
    """Return a colour as it is kept, "#rrggbb", where "#rgb" is told; else the text as it is."""
    is_short = re.fullmatch("#[0-9a-fA-F]{3}", text) is not None
    return "#" + "".join(2 * digit for digit in text[1:]) if is_short else text


@dataclass(frozen=True, slots=True, kw_only=True)
class Option:
    """Something that only some formats ask.

    Parameters
    ----------
    label, tip : str
        In the window.
    flag, about : str
        On the command line: its name without dashes, and its help.
    words : tuple of (value, str)
        Words to choose from, and the values that they stand for. Where such a value is a number,
        another one may be entered, and always where there are no words.
    least, most : float
        Of numbers.
    """

    label: str
    tip: str = ""
    flag: str
    description: str
    choices: tuple[tuple[bool | float | None, str], ...] = ()
    minimum: float = 0
    maximum: float = 1


def _option(usual: Any, **option: Any) -> Any:
    """Return a field of options, with what is asked for it."""
    return field(default=usual, metadata={"option": Option(**option)})


@dataclass(frozen=True, slots=True, kw_only=True)
class FormatOptions:
    """What some formats ask; the base of all such."""

    def __post_init__(self) -> None:
        for name, option in self.option_fields().items():
            value = getattr(self, name)
            if value is not None and not option.minimum <= value <= option.maximum:
                raise LissomError(
                    f"{name.capitalize()} must be {option.minimum:,} to {option.maximum:,}, not "
                    f"{value}."
                )

    @classmethod
    def option_fields(cls) -> dict[str, Option]:
        """Return what is asked, by the names of the fields."""
        return {each.name: each.metadata["option"] for each in fields(cls)}


@dataclass(frozen=True, slots=True, kw_only=True)
class SpriteSheetOptions(FormatOptions):
    """How the frames lie on a sprite sheet."""

    trimmed: bool = _option(
        True,  # noqa: FBT003 - the usual value
        label="Frames are",
        choices=((True, "Trimmed"), (False, "All alike")),
        flag="trim",
        description="keep only what is seen of a frame on a sprite sheet (default: the project's, yes)",
    )
    padding: int = _option(
        2,
        label="Padding",
        tip="Transparent pixels between frames and at the border",
        flag="padding",
        description="pixels between frames of a sprite sheet",
        maximum=256,
    )
    power_of_two: bool = _option(
        False,  # noqa: FBT003 - the usual value
        label="Sheet sides",
        choices=((False, "Any"), (True, "Powers of two")),
        flag="power-of-two",
        description="let the sides of a sprite sheet be powers of two",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshOptions(FormatOptions):
    """How closely an export of shapes follows the motion, in how many triangles of each layer.

    Without a tolerance it is half a pixel, with no more shapes than every viewer shows.
    """

    triangles: int = _option(
        4_000,
        label="Triangles",
        tip="Of each layer, about: more of them bend more smoothly, in a larger file",
        flag="triangles",
        description="of a model, about (default: 4000)",
        minimum=100,
        maximum=2_000_000,  # as many as a domain may have
    )
    tolerance: float | None = _option(
        None,
        label="Within",
        tip="How far the shapes may be from the motion, in pixels. As usual, it takes at most 8 of "
        "them, which every viewer shows; a tolerance of your own takes as many as it needs",
        choices=((None, "½ px, 8 shapes"), (0.5, "Own")),
        flag="tolerance",
        description="how far a model may be from the motion, in pixels, with as many shapes as that "
        "takes (default: 0.5, with 8 shapes at most)",
        minimum=0.001,
        maximum=100,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class FormatSettings:
    """All options; an export uses those that its format asks, by `ExportFormat.options`."""

    sheet: SpriteSheetOptions = SpriteSheetOptions()
    shapes: MeshOptions = MeshOptions()

    def options(self) -> dict[str, Any]:
        """Return the options by the names of the fields."""
        return {each.name: getattr(self, each.name) for each in fields(FormatSettings)}


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportFormat:
    """What a person should know of a format; `app.export.writers` has what writes it.

    Parameters
    ----------
    label : str
        In lists.
    group : str
        The heading in lists, of which there is one for each run of formats with the same.
    use : str
        In one line, what it is good for and what it cannot do.
    about : str
        What comes out, in the words of the command line's help.
    suffixes : tuple of str
        That its file names end in, the usual one first; none where every frame is a file of its
        own, in a folder.
    data_suffix : str
        That the name of a file of data beside it ends in; empty where there is none.
    is_transparent : bool
        Whether it keeps what is transparent; one that does not needs a background.
    is_drawn : bool
        Whether it holds pictures; else it holds shapes, and plays at any rate.
    has_frame : bool
        Whether it shows a part of the plane, before a background; else it is in the plane itself.
    keeps_order : bool
        Whether what lies in front of what may change in it.
    composites : bool
        Whether layers and groups are blended, clipped and faded in it as they are here.
    largest : int, optional
        Pixels of a picture each way, at most.
    is_still : bool
        Whether it is one frame, at the playhead or the first one.
    block : int
        Pixels of which the sides of its pictures are multiples.
    fastest : float, optional
        Pictures a second, at most.
    extra : Extra, optional
        What it needs beyond what Lissom always has.
    options : str
        The field of `FormatSettings` with what it asks; empty where it asks nothing of its own.
    """

    label: str
    group: str
    use: str
    about: str
    suffixes: tuple[str, ...] = ()
    data_suffix: str = ""
    is_transparent: bool = True
    is_drawn: bool = True
    has_frame: bool = True
    keeps_order: bool = True
    composites: bool = True
    largest: int | None = None
    is_still: bool = False
    block: int = 1
    fastest: float | None = None
    extra: Extra | None = None
    options: str = ""

    def whole_blocks(self, size: tuple[int, int]) -> tuple[int, int]:
        """Return the least size not below another one whose sides the format can have."""
        width, height = (side + -side % self.block for side in size)
        return width, height


EXPORT_FORMATS: Final[Mapping[str, ExportFormat]] = MappingProxyType(
    {
        "png": ExportFormat(
            label="PNG frames",
            group="Frames",
            use="For compositing and editing: exact, each frame a file of its own.",
            about="frame_0000.png, ... in the folder --out, which is made if it is missing. Frame "
            "0 of the timeline is frame_0000.png; numbers go on one by one from that of the first "
            "frame, with --fps too, and have more digits if one needs them. Frames of before with "
            "the same names are replaced, other files stay.",
        ),
        "picture": ExportFormat(
            label="PNG picture",
            group="Frames",
            use="One pose, exact, at any size: the frame at the playhead.",
            about="the frame --frame alone, as a PNG",
            suffixes=(".png",),
            is_still=True,
        ),
        "apng": ExportFormat(
            label="Animated PNG",
            group="Animation",
            use="For web pages and chats: exact colours and soft edges; large files.",
            about="an animation with exact colours and transparency",
            suffixes=(".apng", ".png"),
        ),
        "gif": ExportFormat(
            label="GIF",
            group="Animation",
            use="Plays everywhere; hard edges, 255 colours, at most 50 pictures a second.",
            about="an animation in 255 colours a frame; each pixel is opaque or transparent, so "
            "that soft edges become hard",
            suffixes=(".gif",),
            largest=65_535,
            fastest=50.0,  # programs slow down pictures that last under 2/100 of a second
        ),
        "webp": ExportFormat(
            label="WebP",
            group="Animation",
            use="As exact as Animated PNG and smaller; for browsers, few editors read it.",
            about="an animation with exact colours and transparency, smaller than apng",
            suffixes=(".webp",),
            largest=16_383,
        ),
        "mp4": ExportFormat(
            label="MP4 video",
            group="Video",
            use="Plays everywhere, small; no transparency, even sides only.",
            about="H.264 video; needs a background colour",
            suffixes=(".mp4",),
            is_transparent=False,
            largest=16_384,
            block=2,
            extra="video",
        ),
        "webm": ExportFormat(
            label="WebM video",
            group="Video",
            use="For browsers: small, with soft transparency; few editors read it.",
            about="VP9 video, with its transparency unless there is a background colour",
            suffixes=(".webm",),
            largest=16_384,
            extra="video",
        ),
        "mov": ExportFormat(
            label="ProRes video",
            group="Video",
            use="For video editors: nearly exact, with transparency; large files.",
            about="ProRes 4444 video, with its transparency (straight alpha) unless there is a "
            "background colour",
            suffixes=(".mov",),
            largest=16_384,
            extra="video",
        ),
        "spritesheet": ExportFormat(
            label="Sprite sheet",
            group="Engine and web",
            use="For 2D engines: all frames in one PNG, with data; a fixed rate and size.",
            about="all frames in one PNG, row by row, and beside it a JSON that tells where each "
            "is, as TexturePacker writes it, with durations and tags as in Aseprite; tags are made "
            "of the timeline's markers. Frames are trimmed and 2 pixels apart by default",
            suffixes=(".png",),
            data_suffix=".json",
            largest=16_384,
            options="sheet",
        ),
        "glb": ExportFormat(
            label="glTF model",
            group="Engine and web",
            use="For engines and Blender: a moving mesh at any rate and size, in one small file.",
            about="a textured mesh with morph targets and their weights in time, for engines, "
            "Blender and browsers: base shape and targets come within --tolerance of the motion. "
            "100 pixels are a metre, the middle of the canvas' lower edge is the origin",
            suffixes=(".glb",),
            is_drawn=False,
            has_frame=False,
            keeps_order=False,
            composites=False,
            options="shapes",
        ),
        "html": ExportFormat(
            label="Web page",
            group="Engine and web",
            use="For the web: one file that plays sharp at any size; needs a browser with WebGL 2.",
            about="one page that plays the same shapes as glb by WebGL 2 and needs nothing else; "
            "it fills its frame, is dragged to scrub and clicked to pause",
            suffixes=(".html", ".htm"),
            is_drawn=False,
            options="shapes",
        ),
    }
)

# Of one frame.
STILL_FORMAT: Final = next(name for name, format_ in EXPORT_FORMATS.items() if format_.is_still)


def format_by_suffix() -> dict[str, str]:
    """Return the formats that the end of a name tells by itself; .png stands for several."""
    every = [suffix for format_ in EXPORT_FORMATS.values() for suffix in format_.suffixes]
    return {
        suffix: name
        for name, format_ in EXPORT_FORMATS.items()
        for suffix in format_.suffixes
        if every.count(suffix) == 1
    }
