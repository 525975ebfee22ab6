"""Reading Photoshop files with psd-tools, where that is installed."""

import io
import logging
import re
import struct
import warnings
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np
from PIL import Image

from app.document import BlendMode, Group
from app.errors import LissomError, NoticeCollector, install_hint, shortened
from app.storage.pictures.layered import (
    GroupPaths,
    ImportedLayer,
    LayeredPicture,
    build_layered_picture,
    check_memory,
    corner_from_top,
    encode_png,
)
from app.storage.pictures.photoshop_masks import MaskedGroup, is_masked, masked_pixels
from app.storage.pictures.picture import Picture, decode_picture
from engine.arrays import freeze

MEBIBYTE = 1024 * 1024
SIGNATURE = b"8BPS"
HEADER: Final = 26  # bytes
MOST_RECORDS: Final = 1_000
# Where files of more than 8 bits a channel list their layers.
DEEP_LAYERS: Final = re.compile(rb"8B(IM|64)Lr(16|32)")
# What is drawn, and by which name psd-tools knows it. Shapes, placed pictures and texts come with
# pixels.
DRAWN: Final = {"pixel", "shape", "smartobject", "type"}
# Channels of a layer's colours, numbered from 0, and the one before them.
COLOURS: Final = {"GRAYSCALE": 1, "RGB": 3, "CMYK": 4, "LAB": 3}
TRANSPARENCY: Final = -1
KNOCKOUT: Final = b"knko"
PADDING: Final = 3  # bytes that may follow the picture of all layers
# Of two black levels and two white ones, between which a layer is seen: all of them, or not told.
ALL_LEVELS: Final = {(0, 0xFFFF), (0, 0)}
MODES: Final[dict[str, BlendMode]] = {
    "NORMAL": "normal",
    "MULTIPLY": "multiply",
    "SCREEN": "screen",
}
DAMAGED: Final = "it is not a Photoshop file, or it is damaged"
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


@dataclass(frozen=True, slots=True, kw_only=True)
class _Place:
    """Where a layer is."""

    group: str = ""  # its path
    masks: tuple[MaskedGroup, ...] = ()  # the groups around it by whose masks it is to be cut


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
            f"Photoshop files need psd-tools: {install_hint('psd')}; or save the drawing as "
            "OpenRaster "
            "(.ora)"
        ) from error
    # It says its own words about what it skips, where nobody listens on standard error.
    logging.getLogger(psd_tools.__name__).setLevel(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            # Where a channel cannot be unpacked, black would take its place.
            warnings.simplefilter("error", psd_tools.PSDDecompressionWarning)
            _require_few_records(data)
            return _read(psd_tools.PSDImage.open(io.BytesIO(data), max_alloc_bytes=2048 * MEBIBYTE))
    except DAMAGE as error:
        raise LissomError(DAMAGED) from error


def _require_few_records(data: bytes) -> None:
    """Refuse a file that lists more than there is time for, before it is read."""
    (version,) = struct.unpack_from(">H", data, len(SIGNATURE))
    at = HEADER
    for _ in ("the palette", "the resources"):
        at += 4 + struct.unpack_from(">I", data, at)[0]
    # After the lengths of all that is on layers, and of what is said of them.
    at += 2 * 4 * version
    starts = [at] if at < len(data) else []
    starts += [block.end() + 4 * version for block in DEEP_LAYERS.finditer(data)]
    count = sum(abs(struct.unpack_from(">h", data, start)[0]) for start in starts)
    if count > MOST_RECORDS:
        raise LissomError(
            f"it has {count:,} layers and ends of groups; Lissom takes up to "
            f"{MOST_RECORDS:,}: merge some of them"
        )


def _read(drawing: Any) -> LayeredPicture:
    told, groups = NoticeCollector(), GroupPaths()
    found = list(_drawn_layers(drawing, _Place(), groups, told))
    check_memory([(layer.width, layer.height) for _, layer, _ in found])
    layers = []
    for place, layer, is_clipped in found:
        name = layer.name.strip() or "layer"
        if not layer.is_group():
            _require_channels(layer, drawing)
        # An empty one clips what it does in the file.
        image = masked_pixels(layer, place.masks, told) or Image.new("RGBA", (1, 1))
        picture = Picture(rgba=freeze(np.array(image)))
        read = ImportedLayer(
            name=name,
            data=encode_png(image),
            picture=picture,
            corner=corner_from_top(layer.left, layer.top, picture.size, drawing.height),
            visible=layer.visible,
            opacity=layer.opacity / 255 * layer.fill_opacity / 255,
            blend="normal" if layer.is_group() else _blend(layer, told),
            clipped=is_clipped,
            group=place.group,
        )
        layers.append(read)
    if not found and not told.import_log:
        # Saved without layers: the picture that all programs see.
        whole = drawing._record.image_data  # noqa: SLF001 - as of channels
        rows = drawing.height * drawing.channels
        _require_all_rows(whole, rows, drawing.version, padding=PADDING)
        file = encode_png(drawing.topil().convert("RGBA"))
        flat = decode_picture(file, "the picture")
        layers = [ImportedLayer(name="picture", data=file, picture=flat)]
    return build_layered_picture((drawing.width, drawing.height), layers, groups, told)


def _drawn_layers(
    around: Any, place: _Place, groups: GroupPaths, told: NoticeCollector
) -> Iterator[tuple[_Place, Any, bool]]:
    """Go through what is drawn, from the back: where it is, and whether it is clipped.

    A group on which nothing is drawn stands in its own place.
    """
    # What clips a layer may be left out, and then nothing does.
    clips, has_base = True, False
    for layer in around:
        name = layer.name.strip() or "layer"
        is_clipped = _is_clipping(layer) and clips
        # What clips a layer is cut by the masks of the groups around both.
        masks = () if is_clipped and has_base else place.masks
        if layer.is_group():
            passes = layer.blend_mode.name == "PASS_THROUGH"
            group = Group(
                name=name,
                opacity=layer.opacity / 255 * layer.fill_opacity / 255,
                hidden=not layer.visible,
                blend="pass-through" if passes else _blend(layer, told),
                clipped=is_clipped,
            )
            _warn_left_out(layer, name, told)
            if is_masked(layer, told):
                canvas = np.zeros((around._psd.height, around._psd.width), bool)  # noqa: SLF001
                masks = (*masks, MaskedGroup(layer, canvas))
                told.add_note(
                    name, "its mask is cut into the layers of the group, as they are drawn"
                )
            inner = _Place(group=groups.add(place.group, group), masks=masks)
            drawn = list(_drawn_layers(layer, inner, groups, told))
            yield from drawn or [(inner, layer, False)]
        elif layer.kind in DRAWN:
            _warn_left_out(layer, name, told)
            if layer.kind == "type":
                told.add_note(name, "text, drawn as a picture")
            yield replace(place, masks=masks), layer, is_clipped
        else:
            kind = "a fill" if layer.kind.endswith("fill") else "an adjustment"
            told.add_warning(name, f"left out, since it is {kind} layer")
            clips = clips and _is_clipping(layer)
            continue
        has_base = has_base or not is_clipped
        clips = clips or not _is_clipping(layer)


def _warn_left_out(layer: Any, name: str, told: NoticeCollector) -> None:
    """Tell of what changes how a layer or group looks and is not taken over."""
    if layer.has_effects():
        effects = dict.fromkeys(
            _split_camel_case(type(effect).__name__) for effect in layer.effects if effect.enabled
        )
        told.add_warning(name, f"drawn without effects ({', '.join(effects)})")
    if layer.kind == "artboard":
        told.add_warning(
            name, "an artboard, of which neither the background nor the edges are drawn"
        )
    ranges = layer._record.blending_ranges  # noqa: SLF001 - as of channels
    pairs = [ranges.composite_ranges or [], *(ranges.channel_ranges or [])]
    if any(each not in ALL_LEVELS for pair in pairs for each in pair):
        told.add_warning(name, "drawn at all brightnesses, whatever its “Blend If” says")
    if layer.tagged_blocks.get_data(KNOCKOUT):
        told.add_warning(name, "drawn over what is behind, which it knocks out in the file")


def _is_clipping(layer: Any) -> bool:
    """Tell whether a layer or a group, of which psd-tools does not tell, is to be clipped."""
    return bool(layer._record.clipping.name == "NON_BASE")  # noqa: SLF001 - as of channels


def _split_camel_case(name: str) -> str:
    """Return the name of a class, as "DropShadow", in words."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name).lower()


def _blend(layer: Any, told: NoticeCollector) -> BlendMode:
    """Return how a layer is blended; a mode that is not taken over is told."""
    mode = layer.blend_mode.name
    if mode not in MODES:
        what = f"drawn normally, not in the mode {mode.lower().replace('_', ' ')!r}"
        told.add_warning(layer.name.strip() or "layer", what)
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
        raise LissomError(f"the layer {shortened(layer.name)!r} lacks a channel of its colours")
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
