"""Layers that lie on each other, like the ink, shadow and colour of one part."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from PIL import Image
from scipy import ndimage

from app.document import Document, Layer, suggest_switch_groups
from app.storage import Picture
from engine.arrays import Booleans

LONGER = 192  # cells of the longer side of the canvas
DRAWN = 16  # of 255: fainter cells do not count
ON_IT = 0.9  # share of the smaller layer's cells on the other one
WITHIN = 0.97  # share of a shadow's cells on the layers that it belongs to
SAME_BOX = 0.7  # overlap of the bounding boxes over their union
AROUND = 2  # cells by which an outline may lie beside its colour
SHEER = 0.85  # mean alpha below which a layer is a shadow or a light
MOST = 200  # layers that are compared


def suggest_deform_groups(
    document: Document, pictures: Mapping[int, Picture]
) -> tuple[tuple[int, ...], ...]:
    """Return sets of layers that may bend as one, by layer id from back to front.

    At least two of a set have about the same box, and the smaller one's pixels lie on the other
    one. Shadows and lights on them belong to them. Hidden layers, layers of switches and layers
    with a group that looks like a switch are left out.
    """
    found = []
    for candidates in _candidates(document):
        masks = {each.id: _mask(document, each, pictures[each.id]) for each in candidates}
        layers = [each for each in candidates if masks[each.id].any()]
        regions = {each.id: _region(masks[each.id]) for each in layers}
        sets: list[set[int]] = []
        for index, one in enumerate(layers):
            for other in layers[index + 1 :]:
                if _lie_on_each_other(masks, regions, one.id, other.id):
                    near = [each for each in sets if each & {one.id, other.id}]
                    sets = [each for each in sets if each not in near]
                    sets.append({one.id, other.id}.union(*near))
        taken = set().union(*sets)
        for each in layers:
            if each.id not in taken and _is_shadow(each, pictures[each.id]):
                for among in sets:
                    region = np.any([regions[other] for other in among], axis=0)
                    if _share(masks[each.id], region) >= WITHIN:
                        among.add(each.id)
                        break
        found += [tuple(each.id for each in layers if each.id in among) for among in sets]
    return tuple(found)


def _candidates(document: Document) -> Iterator[list[Layer]]:
    """Yield layers of the same group that could bend as one."""
    switches = {path for path, _members in suggest_switch_groups(document)}
    together: dict[str, list[Layer]] = {}
    for layer in document.layers:
        is_free = not (layer.still or layer.reference or layer.hidden or layer.attachments)
        if (
            is_free
            and not document.switches_around(layer)
            and layer.group not in switches
            and not document.is_in_hidden(layer)
        ):
            together.setdefault(layer.group, []).append(layer)
    for layers in together.values():
        if 2 <= len(layers) <= MOST:
            yield layers


def _mask(document: Document, layer: Layer, picture: Picture) -> Booleans:
    """Return the cells of the canvas that a layer draws on."""
    width, height = document.canvas
    factor = -(-max(width, height) // LONGER)
    alpha = Image.new("L", (width, height))
    own = Image.fromarray(np.ascontiguousarray(picture.rgba[..., 3]))
    corner = layer.corner
    alpha.paste(own, (round(corner.real), round(height - corner.imag - own.height)))
    drawn: Booleans = np.asarray(alpha.reduce(factor)) >= DRAWN
    return drawn


def _region(mask: Booleans) -> Booleans:
    filled = ndimage.binary_fill_holes(mask)
    region: Booleans = ndimage.binary_dilation(filled, iterations=AROUND)
    return region


def _share(mask: Booleans, region: Booleans) -> float:
    return float((mask & region).sum() / max(mask.sum(), 1))


def _lie_on_each_other(
    masks: Mapping[int, Booleans], regions: Mapping[int, Booleans], one: int, other: int
) -> bool:
    small, large = sorted((one, other), key=lambda each: int(masks[each].sum()))
    if (
        _share(masks[small], regions[large]) < ON_IT
        and _share(masks[large], regions[small]) < ON_IT
    ):
        return False
    (first, second) = (_box(masks[each]) for each in (one, other))
    inside = [min(a[1], b[1]) - max(a[0], b[0]) for a, b in zip(first, second, strict=True)]
    around = [max(a[1], b[1]) - min(a[0], b[0]) for a, b in zip(first, second, strict=True)]
    return min(inside) > 0 and float(np.prod(inside) / np.prod(around)) >= SAME_BOX


def _box(mask: Booleans) -> Sequence[tuple[int, int]]:
    """Return the first and the last row and column of a mask, the last ones excluded."""
    sides = [np.flatnonzero(mask.any(axis=axis)) for axis in (1, 0)]
    return [(int(side[0]), int(side[-1]) + 1) for side in sides]


def _is_shadow(layer: Layer, picture: Picture) -> bool:
    if layer.clipped or layer.blend != "normal" or layer.opacity < SHEER:
        return True
    alpha = picture.rgba[..., 3]
    drawn = alpha[alpha >= DRAWN]
    return bool(len(drawn)) and float(drawn.mean()) / 255 < SHEER
