"""The formats that animations are exported to: one entry of a table each.

It loads nothing, so that the command line can tell of the formats at once.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportFormat:
    """What a person should know of a format; `app.export.writers` has what writes it.

    Parameters
    ----------
    label : str
        In lists.
    about : str
        What comes out, in the words of the command line's help.
    suffixes : tuple of str
        That its file names end in, the usual one first; none where every frame is a file of its
        own, in a folder.
    is_transparent : bool
        Whether it keeps what is transparent; one that does not needs a background.
    library, remedy : str
        The module of Python that it needs beyond what Lissom always has, and how to install it;
        both empty where there is none.
    """

    label: str
    about: str
    suffixes: tuple[str, ...] = ()
    is_transparent: bool = True
    library: str = ""
    remedy: str = ""


EXPORT_FORMATS: Final[Mapping[str, ExportFormat]] = MappingProxyType(
    {
        "png": ExportFormat(
            label="PNG frames",
            about="frame_0000.png, ... in the folder --out, which is made if it is missing. Frame "
            "0 of the timeline is frame_0000.png; numbers go on one by one from that of the first "
            "frame, with --fps too, and have more digits if one needs them. Frames of before with "
            "the same names are replaced, other files stay.",
        ),
        "apng": ExportFormat(
            label="Animated PNG",
            about="an animation with exact colours and transparency",
            suffixes=(".apng", ".png"),
        ),
        "gif": ExportFormat(
            label="GIF",
            about="an animation in 255 colours a frame; each pixel is opaque or transparent, so "
            "that soft edges become hard",
            suffixes=(".gif",),
        ),
        "webp": ExportFormat(
            label="WebP",
            about="an animation with exact colours and transparency, smaller than apng",
            suffixes=(".webp",),
        ),
        "spritesheet": ExportFormat(
            label="Sprite sheet",
            about="all frames in one PNG, row by row; how many is told on standard output",
            suffixes=(".png",),
        ),
        "mp4": ExportFormat(
            label="MP4 video",
            about="H.264 video; needs a background colour and pip install 'lissom[video]'",
            suffixes=(".mp4",),
            is_transparent=False,
            library="av",
            remedy="pip install 'lissom[video]'",
        ),
    }
)


def format_by_suffix() -> dict[str, str]:
    """Return the formats that the end of a name tells by itself; .png stands for several."""
    every = [suffix for format_ in EXPORT_FORMATS.values() for suffix in format_.suffixes]
    return {
        suffix: name
        for name, format_ in EXPORT_FORMATS.items()
        for suffix in format_.suffixes
        if every.count(suffix) == 1
    }
