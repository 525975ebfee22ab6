"""Layered drawings as files, written by hand or by the libraries of others."""

import io
import zipfile
from collections.abc import Sequence

import numpy as np
from PIL import Image


def blob(width: int, height: int, colour: tuple[int, int, int] = (200, 60, 30)) -> Image.Image:
    """Return an ellipse that fills a picture of this size, on nothing."""
    y, x = np.mgrid[:height, :width]
    inside = ((x + 0.5) / width * 2 - 1) ** 2 + ((y + 0.5) / height * 2 - 1) ** 2 <= 1
    pixels = np.zeros((height, width, 4), np.uint8)
    pixels[inside] = (*colour, 255)
    return Image.fromarray(pixels)


def png(image: Image.Image) -> bytes:
    """Return a picture as a PNG file."""
    file = io.BytesIO()
    image.save(file, "PNG")
    return file.getvalue()


def openraster(
    size: tuple[int, int],
    stack: str,
    pictures: Sequence[Image.Image],
    *,
    mimetype: bytes = b"image/openraster",
    merged: Image.Image | None = None,
) -> bytes:
    """Return an OpenRaster file.

    Parameters
    ----------
    size : tuple of int
    stack : str
        What lies in the stack, from the front; pictures are called "data/0.png" and so on.
    pictures : sequence of Image
    mimetype : bytes
    merged : Image, optional
        What the file says that all layers look like together.
    """
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("mimetype", mimetype)
        archive.writestr(
            "stack.xml", f'<image w="{size[0]}" h="{size[1]}"><stack>{stack}</stack></image>'
        )
        if merged is not None:
            archive.writestr("mergedimage.png", png(merged))
        for index, picture in enumerate(pictures):
            archive.writestr(f"data/{index}.png", png(picture))
    return file.getvalue()
