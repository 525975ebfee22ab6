"""Layers and documents that show footage."""

import re
from dataclasses import replace
from math import ceil
from pathlib import Path

from PIL import Image

from app.document import (
    FOOTAGE_TIME,
    Document,
    ExportSettings,
    FootageTime,
    FrameRange,
    Layer,
    Meshing,
    PictureFile,
    new_layer,
)
from app.errors import display_name
from app.storage.footage.opening import OpenedFootage, inspect_footage
from app.storage.pictures.layered import encode_png
from app.storage.scenes.layers import WHOLE, rectangle_of
from app.storage.scenes.opening import OpenedScene

REFERENCE_OPACITY = 0.5
FASTEST_OWN, USUAL_FPS = 60.0, 24.0  # frames per second
NEARLY = 1e-6  # frames
_NUMBER = re.compile(r"[\s_.-]*\d+$")


def make_footage_layer(
    opened: OpenedFootage, start: int, corner: complex = 0j, *, is_reference: bool = False
) -> Layer:
    """Return a still layer that shows footage from a frame on, with the first picture as its own.

    A reference is dimmed, and locked.
    """
    data = encode_png(Image.fromarray(opened.first.rgba))
    file = PictureFile(data=data, suffix=".png", size=opened.first.size)
    domain = rectangle_of(opened.first).moved(corner)
    stem = display_name(opened.footage.name).rpartition(".")[0]
    name = _NUMBER.sub("", stem) if opened.footage.is_numbered else stem
    return replace(
        new_layer(file, domain, Meshing(), WHOLE),
        name=name.strip() or stem,
        corner=corner,
        still=True,
        footage=opened.footage,
        reference=is_reference,
        locked=is_reference,
        opacity=REFERENCE_OPACITY if is_reference else 1.0,
    ).with_keys_of(FOOTAGE_TIME, [FOOTAGE_TIME.key(start, FootageTime())])


def open_video(path: Path) -> OpenedScene:
    """Read a video, and return the document of it alone."""
    return open_footage_scene(inspect_footage(path, USUAL_FPS))


def open_footage_scene(opened: OpenedFootage) -> OpenedScene:
    """Return the document of footage alone, with the footage's rate and length."""
    layer, footage = make_footage_layer(opened, 0), opened.footage
    # Delays of animated pictures may have a tick of a hundredth of a second.
    fps = footage.fps if footage.fps <= FASTEST_OWN else USUAL_FPS
    last = max(ceil(footage.seconds * fps - NEARLY) - 1, 1)
    document = Document(
        layers=(layer,),
        fps=fps,
        frames=FrameRange(0, last),
        size=footage.size,
        export=ExportSettings(framing="canvas"),
    )
    return OpenedScene(document, {layer.id: opened.first}, opened.notices)
