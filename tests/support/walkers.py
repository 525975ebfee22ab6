"""Somebody on layers, whose limbs have handles of the same names, for poses that travel."""

from dataclasses import replace
from functools import cache

import numpy as np
from animations import still_document, within
from PIL import Image, ImageDraw

from app.document import Document, Layer, handle_commands
from engine.geometry import Similarity

SIZE = (240, 200)
HANDLES = {"hip": 70 + 150j, "knee": 66 + 100j, "foot": 84 + 44j}
FAR = Similarity(1.0 + 0j, 60 - 6j)  # where the far leg is drawn, beside the near one
# Where the leg of the other side is drawn, which is its mirror image.
AXIS = 120.0
LEG = np.array([54 + 28j, 106 + 28j, 106 + 58j, 84 + 58j, 84 + 172j, 54 + 172j])
BODY = np.array([48 + 128j, 152 + 128j, 152 + 192j, 48 + 192j])


@cache
def leg(
    name: str,
    identity: int,
    by: complex = 0j,
    *,
    mirrored: bool = False,
    turned: bool = False,
    traced: bool = True,
) -> Layer:
    """Return a leg with a foot, moved by some whole pixels, mirrored, or turned by a quarter.

    Its outline is traced from its picture, or has few corners.
    """
    picture = Image.new("RGBA", SIZE)
    pen = ImageDraw.Draw(picture)
    x, y, height = int(by.real), int(by.imag), SIZE[1]
    for left, low, right, high in ((56, 40, 82, 170), (56, 30, 104, 56)):
        box = (left + x, height - high - y, right + x - 1, height - low - y - 1)
        pen.rectangle(box, fill=(200, 120, 60, 255))
    pixels = np.array(picture)
    pixels = pixels[:, ::-1].copy() if mirrored else pixels
    document = still_document(np.rot90(pixels).copy() if turned else pixels)
    if not traced:
        document = within(document, LEG + by)
    for handle, place in HANDLES.items():
        at = place + by
        at = 2 * AXIS - at.conjugate() if mirrored else at
        at = 1j * at + SIZE[1] if turned else at
        document = handle_commands.add_handle(0, at, name=handle)(document)
    return replace(document.layers[0], id=identity, name=name)


@cache
def walker(near: str = "near leg", far: str = "far leg") -> Document:
    """A body between two legs: the near one at frame 0 alone, as the far one."""
    picture = Image.new("RGBA", SIZE)
    ImageDraw.Draw(picture).rectangle((50, 10, 150, 70), fill=(60, 90, 200, 255))
    body = within(still_document(np.array(picture)), BODY)
    body = handle_commands.add_handle(0, 100 + 170j, name="chest")(body)
    layers = (
        leg(far, 2, FAR.shift, traced=False),
        replace(body.layers[0], id=1, name="body"),
        leg(near, 0, traced=False),
    )
    return Document(layers=layers, size=SIZE)
