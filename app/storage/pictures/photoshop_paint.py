"""What a Photoshop file describes in place of pixels: shapes, fills, effects, adjustments.

Imports psd-tools, which is an extra, only when a file is read.
"""

from itertools import chain
from math import ceil, floor
from typing import Any, Final, NamedTuple

import numpy as np
from PIL import Image, ImageChops

from app.errors import NoticeCollector
from app.storage.pictures.colour import to_srgb
from app.texts import N_, _

Box = tuple[int, int, int, int]  # left, top, right, bottom, on the canvas, y down

SOLID_COLOUR: Final = b"SoCo"
# Of a shape that has an outline, too.
SHAPE_CONTENT: Final = b"vscg"
SHAPE_OUTLINE: Final = b"vstk"
PROFILE: Final = 1039  # number of the colour profile among the file's resources
# Blocks of effects, and the block of them in files of old programs.
EFFECTS: Final = (b"lfx2", b"lmfx", b"lfxs")
OLD_EFFECTS: Final = b"lrFX"
NORMAL: Final = b"Nrml"  # mode of an overlay
COLOUR_OVERLAY: Final = b"SoFi"
EFFECT_NAMES: Final = {
    b"DrSh": N_("drop shadow"),
    b"dsdw": N_("drop shadow"),
    b"IrSh": N_("inner shadow"),
    b"isdw": N_("inner shadow"),
    b"OrGl": N_("outer glow"),
    b"oglw": N_("outer glow"),
    b"IrGl": N_("inner glow"),
    b"iglw": N_("inner glow"),
    b"ebbl": N_("bevel and emboss"),
    b"bevl": N_("bevel and emboss"),
    b"ChFX": N_("satin"),
    COLOUR_OVERLAY: N_("colour overlay"),
    b"sofi": N_("colour overlay"),
    b"GrFl": N_("gradient overlay"),
    b"patternFill": N_("pattern overlay"),
    b"FrFX": N_("stroke"),
}
# Names in psd-tools of layers with pixels. Placed pictures and texts come with pixels.
WITH_PIXELS: Final = {"smartobject", "type"}
DRAWN: Final = {"pixel", "shape", *WITH_PIXELS}
# Blocks of adjustments that psd-tools takes for empty pictures.
OLD_ADJUSTMENTS: Final = {b"brit", b"hue "}
KNOCKOUT: Final = b"knko"
# A layer's blending range of two black and two white levels: all levels, or unspecified.
ALL_LEVELS: Final = {(0, 0xFFFF), (0, 0)}
DRAWN_WITHOUT: Final = N_("drawn without effects ({effects})")
NO_PIXELS: Final = N_("left out, because the file does not contain its pixels")
NOT_PAINTED: Final = N_("left out, because Lissom draws only shapes and fills of one colour")


class ColourOverlay(NamedTuple):
    """A colour over the whole layer."""

    colour: tuple[int, int, int]
    opacity: float  # from 0 to 1


class Effect(NamedTuple):
    """An effect of a layer, by its name in Photoshop."""

    name: str
    overlay: ColourOverlay | None = None  # if it is drawn


def is_described(layer: Any) -> bool:
    """Return whether a layer is a shape or a fill; its pixels, if any, were drawn from that."""
    return bool(layer.kind == "shape" or layer.kind.endswith("fill"))


def fill_colour(layer: Any) -> tuple[int, int, int] | None:
    """Return the colour of a shape or fill layer without pixels; None if it has no single one."""
    blocks = layer.tagged_blocks
    outline = blocks.get_data(SHAPE_OUTLINE)
    if outline is not None and not outline.get(b"fillEnabled", True):
        return None
    content = blocks.get_data(SOLID_COLOUR) or blocks.get_data(SHAPE_CONTENT)
    return None if content is None else _colour(layer, content)


def box_of(layer: Any) -> Box:
    """Return the pixels that a layer covers: its own, or those of its path."""
    if layer.has_pixels() or fill_colour(layer) is None:
        box: Box = layer.bbox
        return box
    width, height = layer._psd.size  # noqa: SLF001 - psd-tools has no other way to the file
    mask = layer.vector_mask
    if mask is None or mask.inverted or mask.initial_fill_rule or not mask.paths:
        return (0, 0, width, height)
    left, top, right, bottom = mask.bbox
    # Shapes end at twice the canvas: each pixel takes memory.
    return (
        floor(max(left, -0.5) * width),
        floor(max(top, -0.5) * height),
        ceil(min(right, 1.5) * width),
        ceil(min(bottom, 1.5) * height),
    )


def draw_path(layer: Any, box: Box) -> Image.Image:
    """Return how much of each pixel of a box the vector mask of a layer covers."""
    from psd_tools.composite.vector import draw_vector_mask  # noqa: PLC0415

    covered = np.rint(255 * draw_vector_mask(layer, box)[..., 0]).astype(np.uint8)
    drawn = Image.fromarray(covered)
    return ImageChops.invert(drawn) if layer.vector_mask.inverted else drawn


def has_outline(layer: Any) -> bool:
    """Return whether the shape of a layer has an outline."""
    outline = layer.tagged_blocks.get_data(SHAPE_OUTLINE)
    return outline is not None and bool(outline.get(b"strokeEnabled", False))


def lay_over(image: Image.Image, fill: float, overlay: ColourOverlay) -> tuple[Image.Image, float]:
    """Return pixels under a colour overlay, and their opacity; `fill` is that without overlay."""
    total = overlay.opacity + (1 - overlay.opacity) * fill
    if total == 0:
        return image, 0.0
    colour = Image.new("RGB", image.size, overlay.colour)
    mixed = Image.blend(image.convert("RGB"), colour, overlay.opacity / total)
    mixed.putalpha(image.getchannel("A"))
    return mixed, total


def effects_of(layer: Any) -> list[Effect]:
    """Return the effects of a layer that are switched on, from below."""
    from psd_tools.psd.descriptor import Descriptor  # noqa: PLC0415

    blocks = layer.tagged_blocks
    found = next((blocks.get_data(key) for key in EFFECTS if blocks.get_data(key)), None)
    if found is None:
        old = blocks.get_data(OLD_EFFECTS) or {}
        return [
            Effect(_(EFFECT_NAMES[bytes(kind)]))
            for kind, effect in old.items()
            if getattr(effect, "enabled", False)
        ]
    if not found.get(b"masterFXSwitch", True):
        return []
    # Newer files have lists of effects of one kind.
    several = (each if isinstance(each, list) else [each] for each in found.values())
    return [
        Effect(_(EFFECT_NAMES[effect.classID]), _overlay(layer, effect))
        for effect in chain.from_iterable(several)
        if isinstance(effect, Descriptor)
        and effect.classID in EFFECT_NAMES
        and effect.get(b"enab", True)
        and effect.get(b"present", True)
    ]


def _overlay(layer: Any, effect: Any) -> ColourOverlay | None:
    """Return a colour overlay that is drawn; None for another effect or mode."""
    mode = effect.get(b"Md  ")
    if effect.classID != COLOUR_OVERLAY or (mode is not None and mode.enum != NORMAL):
        return None
    colour = _colour(layer, effect)
    opacity = float(effect.get(b"Opct", 100.0)) / 100
    return None if colour is None else ColourOverlay(colour, opacity)


def _colour(layer: Any, descriptor: Any) -> tuple[int, int, int] | None:
    """Return the colour of a descriptor in sRGB; None for gradients, patterns, and colour books."""
    from psd_tools.composite.paint import draw_solid_color_fill  # noqa: PLC0415
    from psd_tools.constants import ColorMode  # noqa: PLC0415

    try:
        drawn, _shape = draw_solid_color_fill((0, 0, 1, 1), ColorMode.RGB, descriptor)
    except (AttributeError, LookupError, TypeError, ValueError):
        return None
    pixel = Image.fromarray(np.rint(255 * drawn).astype(np.uint8))
    profile = layer._psd.image_resources.get_data(PROFILE)  # noqa: SLF001 - as above
    red, green, blue = np.asarray(to_srgb(pixel, profile)[0].convert("RGB"))[0, 0].tolist()
    return red, green, blue


def why_left_out(layer: Any) -> str:
    """Return why a layer is not drawn; empty if it is."""
    if not is_described(layer) and (
        layer.kind not in DRAWN or any(key in layer.tagged_blocks for key in OLD_ADJUSTMENTS)
    ):
        return _("left out, because it is an adjustment layer")
    if layer.has_pixels():
        return ""
    if layer.kind in WITH_PIXELS:
        return _(NO_PIXELS)
    return _(NOT_PAINTED) if is_described(layer) and fill_colour(layer) is None else ""


def warn_left_out(layer: Any, name: str, collector: NoticeCollector) -> None:
    """Add notices about unsupported features that change the look of a layer or group."""
    missing = dict.fromkeys(
        effect.name for effect in effects_of(layer) if effect.overlay is None or layer.is_group()
    )
    if missing:
        collector.add_warning(name, _(DRAWN_WITHOUT).format(effects=", ".join(missing)))
    if not layer.is_group() and not layer.has_pixels() and has_outline(layer):
        collector.add_warning(name, _("drawn without the outline of its shape"))
    if layer.kind == "artboard":
        collector.add_warning(name, _("an artboard; its background and edges are not drawn"))
    ranges = layer._record.blending_ranges  # noqa: SLF001 - as of channels
    pairs = [ranges.composite_ranges or [], *(ranges.channel_ranges or [])]
    if any(each not in ALL_LEVELS for pair in pairs for each in pair):
        collector.add_warning(
            name, _("drawn at all brightnesses; its “Blend If” setting is ignored")
        )
    if layer.tagged_blocks.get_data(KNOCKOUT):
        collector.add_warning(name, _("drawn over the layers behind; its knockout is ignored"))
