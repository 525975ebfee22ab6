"""Reading Photoshop files with psd-tools, where that is installed."""

import io
import struct
import warnings
import zlib
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from PIL import Image, ImageChops

from app.document import BlendMode, Group
from app.errors import LissomError
from app.storage.pictures.layered import (
    Groups,
    Layer,
    LayeredPicture,
    corner_from_top,
    layered_picture,
    require_room,
)
from app.storage.pictures.picture import decode_picture

MEBIBYTE = 1024 * 1024
SIGNATURE = b"8BPS"
# What is drawn, and by which name psd-tools knows it. Shapes and placed pictures come with pixels.
DRAWN: Final = {"pixel", "shape", "smartobject"}
SKIPPED: Final = {"type": "text"}
# Channels of a layer's colours, numbered from 0, and the one before them.
COLOURS: Final = {"GRAYSCALE": 1, "RGB": 3, "CMYK": 4, "LAB": 3}
TRANSPARENCY: Final = -1
PADDING: Final = 3  # bytes that may follow the picture of all layers
MODES: Final[dict[str, BlendMode]] = {
    "NORMAL": "normal",
    "MULTIPLY": "multiply",
    "SCREEN": "screen",
}
DAMAGE = (
    OSError,
    ValueError,
    KeyError,
    IndexError,
    TypeError,
    AttributeError,
    AssertionError,
    NotImplementedError,
    OverflowError,
    MemoryError,
    RecursionError,
    UserWarning,
    struct.error,
    zlib.error,
)


def read_photoshop(data: bytes) -> LayeredPicture:
    """Read the layers of a Photoshop file.

    Masks are taken into the pixels.

    Raises
    ------
    LissomError
        If psd-tools is not installed, or the file is no Photoshop file, is damaged or too large, or
        nothing is drawn on it.
    """
    if not data.startswith(SIGNATURE):
        raise LissomError("it is not a Photoshop file")
    try:
        import psd_tools  # noqa: PLC0415 - it is an extra
    except ImportError as error:
        raise LissomError(
            "Photoshop files need psd-tools: install Lissom with `pip install 'lissom[psd]'`, or "
            "save the drawing as OpenRaster (.ora)"
        ) from error
    try:
        with warnings.catch_warnings():
            # Where a channel cannot be unpacked, black would take its place.
            warnings.simplefilter("error", psd_tools.PSDDecompressionWarning)
            return _read(psd_tools.PSDImage.open(io.BytesIO(data), max_alloc_bytes=2048 * MEBIBYTE))
    except DAMAGE as error:
        raise LissomError(f"it is not a Photoshop file, or it is damaged ({error})") from error


def _read(drawing: Any) -> LayeredPicture:
    notices: list[str] = []
    groups = Groups()
    found = list(_drawn_layers(drawing, "", groups, notices))
    require_room([(layer.width, layer.height) for _, layer in found])
    layers = []
    for group, layer in found:
        _require_channels(layer, drawing)
        image = _pixels(layer)
        if image is None:
            notices.append(f"left out the empty layer {layer.name!r}")
            continue
        file = _png(image)
        picture = decode_picture(file, layer.name)
        read = Layer(
            name=layer.name.strip() or "layer",
            data=file,
            picture=picture,
            corner=corner_from_top(layer.left, layer.top, picture.size, drawing.height),
            visible=layer.visible,
            opacity=layer.opacity / 255,
            blend=_blend(layer, notices),
            group=group,
        )
        layers.append(read)
    if not found and not notices:
        # Saved without layers: the picture that all programs see.
        whole = drawing._record.image_data  # noqa: SLF001 - as of channels
        rows = drawing.height * drawing.channels
        _require_all_rows(whole, rows, drawing.version, padding=PADDING)
        file = _png(drawing.topil().convert("RGBA"))
        flat = decode_picture(file, "the picture")
        layers = [Layer(name="picture", data=file, picture=flat)]
    return layered_picture((drawing.width, drawing.height), layers, groups, notices)


def _drawn_layers(
    around: Any, path: str, groups: Groups, notices: list[str]
) -> Iterator[tuple[str, Any]]:
    """Go through what is drawn, from the back, each with the path of its group."""
    for layer in around:
        name = layer.name.strip()
        if layer.is_group():
            passes = layer.blend_mode.name == "PASS_THROUGH"
            group = Group(
                name=name or "group",
                opacity=layer.opacity / 255,
                hidden=not layer.visible,
                blend="pass-through" if passes else _blend(layer, notices),
            )
            yield from _drawn_layers(layer, groups.add(path, group), groups, notices)
        elif layer.kind in DRAWN:
            yield path, layer
        else:
            kind = SKIPPED.get(layer.kind, "adjustment")
            notices.append(f"left out the {kind} layer {name!r}: Lissom takes drawn layers only")


def _blend(layer: Any, notices: list[str]) -> BlendMode:
    """Return how a layer is blended; a mode that is not taken over is told."""
    mode = layer.blend_mode.name
    if mode not in MODES:
        told = mode.lower().replace("_", " ")
        notices.append(f"{layer.name.strip()!r} is drawn normally, not in the mode {told!r}")
    return MODES.get(mode, "normal")


def _require_channels(layer: Any, drawing: Any) -> None:
    """Refuse a layer that lacks a channel, or rows of one, in whose place black would be seen.

    Its file tells so by private names only.
    """
    found = {}
    for told, channel in zip(layer._record.channel_info, layer._channels, strict=True):  # noqa: SLF001
        found[int(told.id)] = channel
    colours = COLOURS.get(drawing.color_mode.name, 0)
    if layer.width and layer.height and not set(range(colours)) <= set(found):
        raise LissomError(f"the layer {layer.name!r} lacks a channel of its colours")
    for number, channel in found.items():
        if number >= TRANSPARENCY:
            _require_all_rows(channel, layer.height, drawing.version)


def _require_all_rows(channel: Any, rows: int, version: int, *, padding: int = 0) -> None:
    """Refuse packed rows that are not as long together as they say one by one."""
    if channel.compression.name == "RLE":
        size = 2 * version  # bytes of a length
        lengths = np.frombuffer(channel.data[: size * rows], f">u{size}")
        left = len(channel.data) - size * rows - int(lengths.sum())
        if len(lengths) < rows or not 0 <= left <= padding:
            raise LissomError("the rows of one of its channels are not as long as it says")


def _png(image: Image.Image) -> bytes:
    file = io.BytesIO()
    image.save(file, "PNG", compress_level=1)
    return file.getvalue()


def _pixels(layer: Any) -> Image.Image | None:
    """Return the pixels of a layer with its mask taken in; None where it has none."""
    if layer.width == 0 or layer.height == 0:
        return None
    image = layer.topil()
    if image is None:
        return None
    pixels: Image.Image = image.convert("RGBA")
    mask = layer.mask
    if mask is not None and not mask.disabled:
        seen = Image.new("L", pixels.size, mask.background_color)
        drawn = mask.topil()
        if drawn is not None:
            seen.paste(drawn.convert("L"), (mask.left - layer.left, mask.top - layer.top))
        pixels.putalpha(ImageChops.multiply(pixels.getchannel("A"), seen))
    return pixels
