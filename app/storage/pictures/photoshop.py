"""Reading Photoshop files with psd-tools, if it is installed."""

import io
import logging
import re
import struct
import warnings
import zlib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, Final

import numpy as np
from PIL import Image

from app.document import BLENDS, BlendMode, Group
from app.errors import LissomError, NoticeCollector, install_hint, shortened
from app.storage.pictures.layer_names import GroupPaths
from app.storage.pictures.layered import (
    ImportedLayer,
    LayeredPicture,
    build_layered_picture,
    check_memory,
    corner_from_top,
    encode_png,
)
from app.storage.pictures.photoshop_masks import (
    TRANSPARENCY,
    MaskedGroup,
    is_masked,
    masked_pixels,
    to_rgba,
)
from app.storage.pictures.photoshop_paint import (
    box_of,
    effects_of,
    lay_over,
    warn_left_out,
    why_left_out,
)
from app.storage.pictures.picture import Picture
from app.texts import N_, _
from engine.arrays import freeze

MEBIBYTE = 1024 * 1024
SIGNATURE = b"8BPS"
HEADER: Final = 26  # bytes
MOST_RECORDS: Final = 4_000
# Start of the layer list in files of more than 8 bits per channel.
DEEP_LAYERS: Final = re.compile(rb"8B(IM|64)Lr(16|32)")
# Number of colour channels, numbered from 0; the alpha channel has number -1.
COLOURS: Final = {"GRAYSCALE": 1, "RGB": 3, "CMYK": 4, "LAB": 3}
CLEAR_INDEX: Final = 1047  # number of the palette's transparent colour among the file's resources
PADDING: Final = 3  # bytes that may follow the rows of a channel
MODES: Final = {blend.upper().replace("-", "_"): blend for blend in BLENDS}
MERGED_ALONE: Final = N_("the merged picture of the file, because none of its layers can be drawn")
DAMAGED: Final = N_("it is not a Photoshop file, or it is damaged")
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
    """Group and masks of a layer."""

    group: str = ""  # its path
    masks: tuple[MaskedGroup, ...] = ()  # masked groups around the layer, whose masks cut it


def read_photoshop(data: bytes) -> LayeredPicture:
    """Read the layers of a Photoshop file. Masks are applied to the pixels.

    Raises `LissomError` if psd-tools is not installed, or if the file is no Photoshop file, is
    damaged, too large or empty.
    """
    if not data.startswith(SIGNATURE):
        raise LissomError(_("it is not a Photoshop file"))
    try:
        import psd_tools  # noqa: PLC0415 - it is an extra
    except ImportError as error:
        raise LissomError(
            _(
                "Photoshop files need psd-tools: {remedy}; or save the drawing as OpenRaster (.ora)"
            ).format(remedy=install_hint("psd"))
        ) from error
    # Its own messages about skipped content go to standard error, which nobody reads.
    logging.getLogger(psd_tools.__name__).setLevel(logging.CRITICAL)
    try:
        with warnings.catch_warnings():
            # A channel that cannot be unpacked would become black.
            warnings.simplefilter("error", psd_tools.PSDDecompressionWarning)
            _require_few_records(data)
            return _read(psd_tools.PSDImage.open(io.BytesIO(data), max_alloc_bytes=2048 * MEBIBYTE))
    except DAMAGE as error:
        raise LissomError(_(DAMAGED)) from error


def _require_few_records(data: bytes) -> None:
    """Refuse a file with too many layer records, before it is read."""
    (version,) = struct.unpack_from(">H", data, len(SIGNATURE))
    at = HEADER
    for _section in ("palette", "resources"):
        at += 4 + struct.unpack_from(">I", data, at)[0]
    length = ">I" if version == 1 else ">Q"
    # The layer list lies in the layer section. Each is empty in some files.
    has_section = any(struct.unpack_from(length, data, at))
    has_list = has_section and any(struct.unpack_from(length, data, at + 4 * version))
    starts = [at + 2 * 4 * version] if has_list else []
    starts += [block.end() + 4 * version for block in DEEP_LAYERS.finditer(data)]
    count = sum(abs(struct.unpack_from(">h", data, start)[0]) for start in starts)
    if count > MOST_RECORDS:
        raise LissomError(
            _(
                "it has {count:,} layers and group ends; Lissom reads at most {most:,}. Merge "
                "some layers"
            ).format(count=count, most=MOST_RECORDS)
        )


def _read(drawing: Any) -> LayeredPicture:
    collector, groups = NoticeCollector(), GroupPaths()
    found = list(_drawn_layers(drawing, _Place(), groups, collector))
    boxes = [box_of(layer) for _place, layer, _clipped in found]
    check_memory([(right - left, bottom - top) for left, top, right, bottom in boxes])
    layers = []
    for (place, layer, is_clipped), box in zip(found, boxes, strict=True):
        name = layer.name.strip() or "layer"
        if layer.has_pixels() and not layer.is_group():
            _require_channels(layer, drawing)
        # An empty layer still clips as in the file.
        image = masked_pixels(layer, box, place.masks, collector) or Image.new("RGBA", (1, 1))
        fill = layer.fill_opacity / 255
        for effect in effects_of(layer):
            if effect.overlay is not None:
                image, fill = lay_over(image, fill, effect.overlay)
        picture = Picture(rgba=freeze(np.array(image)))
        read = ImportedLayer(
            name=name,
            data=encode_png(image),
            picture=picture,
            corner=corner_from_top(box[0], box[1], picture.size, drawing.height),
            visible=layer.visible,
            opacity=layer.opacity / 255 * fill,
            blend="normal" if layer.is_group() else _blend(layer, collector),
            clipped=is_clipped,
            group=place.group,
            number=max(layer.layer_id, 0),
        )
        layers.append(read)
    is_blank = all(layer.picture.is_blank for layer in layers)
    if is_blank and (drawing.has_preview() or not found):
        merged = _merged(drawing)
        layers = [
            ImportedLayer(
                name="picture", data=encode_png(Image.fromarray(merged.rgba)), picture=merged
            )
        ]
        if found or collector.import_log:
            collector.add_warning(layers[0].name, _(MERGED_ALONE))
    merge = partial(_merged_unless_damaged, drawing)
    return build_layered_picture((drawing.width, drawing.height), layers, groups, collector, merge)


def _merged(drawing: Any) -> Picture:
    """Return the merged picture of a file."""
    whole = drawing._record.image_data  # noqa: SLF001 - as of channels
    _require_all_rows(whole, drawing.height * drawing.channels, drawing.version)
    pixels = to_rgba(drawing.topil())
    clear = drawing.image_resources.get_data(CLEAR_INDEX)
    if drawing.color_mode.name == "INDEXED" and clear is not None:
        indices = np.asarray(drawing.topil(0))
        pixels.putalpha(Image.fromarray(indices != clear).convert("L"))
    return Picture(rgba=freeze(np.array(pixels)))


def _merged_unless_damaged(drawing: Any) -> Picture | None:
    try:
        return _merged(drawing) if drawing.has_preview() else None
    except (LissomError, *DAMAGE):
        return None


def _drawn_layers(
    around: Any, place: _Place, groups: GroupPaths, collector: NoticeCollector
) -> Iterator[tuple[_Place, Any, bool]]:
    """Yield all drawn layers from the back: place, layer, and whether it is clipped.

    An empty group yields itself in its own place.
    """
    # A clipping base may be left out; then its layers are not clipped.
    clips, has_base = True, False
    for layer in around:
        name = layer.name.strip() or "layer"
        is_clipped = _is_clipping(layer) and clips
        # A clipped layer is cut by its base, which is already cut by the masks of their groups.
        masks = () if is_clipped and has_base else place.masks
        if layer.is_group():
            passes = layer.blend_mode.name == "PASS_THROUGH"
            group = Group(
                name=name,
                opacity=layer.opacity / 255 * layer.fill_opacity / 255,
                hidden=not layer.visible,
                blend="pass-through" if passes else _blend(layer, collector),
                clipped=is_clipped,
            )
            warn_left_out(layer, name, collector)
            if is_masked(layer):
                canvas = np.zeros((around._psd.height, around._psd.width), bool)  # noqa: SLF001
                masks = (*masks, MaskedGroup(layer, canvas))
                collector.add_note(
                    name, _("the mask of the group is applied to each of its layers")
                )
            inner = _Place(group=groups.add(place.group, group), masks=masks)
            drawn = list(_drawn_layers(layer, inner, groups, collector))
            yield from drawn or [(inner, layer, False)]
        elif reason := why_left_out(layer):
            collector.add_warning(name, reason)
            clips = clips and _is_clipping(layer)
            continue
        else:
            warn_left_out(layer, name, collector)
            if layer.kind == "type":
                collector.add_note(name, _("drawn as a picture; its text cannot be edited"))
            yield replace(place, masks=masks), layer, is_clipped
        has_base = has_base or not is_clipped
        clips = clips or not _is_clipping(layer)


def _is_clipping(layer: Any) -> bool:
    """Return whether a layer or a group has the clipping flag, which psd-tools does not expose."""
    return bool(layer._record.clipping.name == "NON_BASE")  # noqa: SLF001 - as of channels


def _blend(layer: Any, collector: NoticeCollector) -> BlendMode:
    """Return the blend mode of a layer. An unsupported mode gives a notice."""
    mode = layer.blend_mode.name
    if mode not in MODES:
        what = _("drawn normally, not in the mode {mode!r}").format(
            mode=mode.lower().replace("_", " ")
        )
        collector.add_warning(layer.name.strip() or "layer", what)
    return MODES.get(mode, "normal")


def _require_channels(layer: Any, drawing: Any) -> None:
    """Refuse a layer that lacks a channel or rows of a channel, which would be black.

    psd-tools exposes the channels by private names only.
    """
    found = {}
    for info, channel in zip(layer._record.channel_info, layer._channels, strict=True):  # noqa: SLF001
        found[int(info.id)] = channel
    colours = COLOURS.get(drawing.color_mode.name, 0)
    if layer.width and layer.height and not set(range(colours)) <= set(found):
        raise LissomError(
            _("the layer {layer!r} has no data for one of its colour channels").format(
                layer=shortened(layer.name)
            )
        )
    for number, channel in found.items():
        if number >= TRANSPARENCY:
            _require_all_rows(channel, layer.height, drawing.version)


def _require_all_rows(channel: Any, rows: int, version: int) -> None:
    """Refuse packed rows whose total length differs from the sum of their stated lengths."""
    if channel.compression.name == "RLE":
        size = 2 * version  # bytes of a length
        lengths = np.frombuffer(channel.data[: size * rows], f">u{size}")
        left = len(channel.data) - size * rows - int(lengths.sum())
        if len(lengths) < rows or not 0 <= left <= PADDING:
            raise LissomError(_("one of its channels is damaged: its rows have the wrong length"))
