"""The layers of a document as one flat picture."""

from collections.abc import Mapping, Sequence

import numpy as np
from PIL import Image

from app.document import CompositeGroup, Document, Layer, composite_layers, is_visible
from app.storage.pictures.blending import blend_pictures
from engine.arrays import Bytes, readonly

LARGEST_FLAT = 1_024  # pixels


def flatten_layers(
    document: Document, textures: Mapping[int, Bytes], *, largest: int = LARGEST_FLAT
) -> Bytes:
    """Return the initially visible layers as one picture, as drawn; a large one is reduced.

    Parameters
    ----------
    textures : mapping of int to uint8, shape (h, w, 4)
        The cut-out pictures by layer id.
    largest : int
        A picture of at least twice as many pixels across is reduced.

    Returns
    -------
    uint8, shape (h, w, 4)
        Straight alpha.
    """
    factor = max(1, max(document.canvas) // largest)
    if len(document.layers) == 1:
        return np.asarray(_reduced(textures[document.layers[0].id], factor))
    size = -(-document.canvas[0] // factor), -(-document.canvas[1] // factor)

    def draw(layer: Layer, flat: Image.Image) -> None:
        part, corner = _reduced(textures[layer.id], factor), layer.corner / factor
        left, top = round(corner.real), round(size[1] - corner.imag - part.height)
        beyond = min(max(0, -left), part.width), min(max(0, -top), part.height)
        flat.alpha_composite(part, (max(left, 0), max(top, 0)), beyond)

    def over(flat: Image.Image, parts: Sequence[Layer | CompositeGroup[Layer]]) -> Image.Image:
        flat = flat.copy()
        for part in parts:
            if isinstance(part, CompositeGroup) and part.is_pass_through:
                faded = Image.blend(
                    flat.convert("RGBa"), over(flat, part.parts).convert("RGBa"), part.opacity
                )
                flat = faded.convert("RGBA")
            elif isinstance(part, CompositeGroup):
                flat = _blended(flat, over(Image.new("RGBA", size), part.parts), part)
            else:
                draw(part, flat)
        return flat

    first = document.frames.first
    seen = {each.id: each for each in document.exported_layers if is_visible(document, each, first)}
    painted = over(Image.new("RGBA", size), composite_layers(document, seen, first))
    return readonly(np.asarray(painted))


def _blended(below: Image.Image, above: Image.Image, how: CompositeGroup[Layer]) -> Image.Image:
    """Return a layer over its backdrop ("Compositing and Blending Level 1", Section 10)."""
    alpha = above.getchannel("A").point(lambda a: round(how.opacity * a))
    covered = below.getchannel("A")
    # A clipped layer meets its backdrop as if the backdrop were opaque.
    solid = below.convert("RGB").convert("RGBA") if how.clipped else below
    if how.blend != "normal":
        own = above.convert("RGB")
        mixed = blend_pictures(below.convert("RGB"), own, how.blend)
        # Over an empty backdrop the layer keeps its colours.
        above = Image.composite(mixed, own, solid.getchannel("A")).convert("RGBA")
    above.putalpha(alpha)
    flat = Image.alpha_composite(solid, above)
    if how.clipped:
        flat.putalpha(covered)
    return flat


def _reduced(rgba: Bytes, factor: int) -> Image.Image:
    """Return a picture in which one pixel stands for `factor` × `factor` pixels."""
    # Process a few rows at a time: a whole copy would double the memory.
    rows = (rgba[top : top + factor] for top in range(0, len(rgba), factor))
    return Image.fromarray(np.concatenate([Image.fromarray(row).reduce(factor) for row in rows]))
