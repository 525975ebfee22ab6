"""Files of footage whose colours tell the number of each picture."""

from fractions import Fraction
from pathlib import Path

import numpy as np
from PIL import Image

from engine.arrays import Bytes

SIZE = (32, 24)
STEP = 8  # levels of red from a picture to the next


def numbered_colour(number: int) -> tuple[int, int, int, int]:
    return STEP * number % 256, number // 32 * 50, 255 - number % 256, 255


def numbered_picture(number: int, size: tuple[int, int] = SIZE) -> Image.Image:
    return Image.new("RGBA", size, numbered_colour(number))


def write_numbered(folder: Path, numbers: range | list[int], size: tuple[int, int] = SIZE) -> Path:
    """Write numbered pictures, and return the first one's path."""
    folder.mkdir(exist_ok=True)
    for number in numbers:
        numbered_picture(number, size).save(folder / f"walk_{number:03}.png")
    return folder / f"walk_{numbers[0]:03}.png"


def write_video(
    path: Path, count: int, *, rate: int = 24, group: int = 6, codec: str = "libx264"
) -> Path:
    """Write a video with a key picture every `group` pictures."""
    import av  # noqa: PLC0415 - only videos need it

    formats = {"libx264": "yuv420p", "prores_ks": "yuva444p10le", "libvpx-vp9": "yuva420p"}
    with av.open(str(path), "w") as container:
        options = {"crf": "4", "b": "0", "g": str(group)} if codec != "prores_ks" else {}
        stream = container.add_stream(codec, Fraction(rate), options)
        stream.width, stream.height = SIZE
        stream.pix_fmt = formats[codec]
        for number in range(count):
            pixels = np.asarray(numbered_picture(number)).copy()
            pixels[:, : SIZE[0] // 2, 3] = 0
            frame = av.VideoFrame.from_ndarray(pixels, format="rgba")
            frame.pts = number
            container.mux(stream.encode(frame))
        container.mux(stream.encode(None))
    return path


def number_of(pixels: Bytes) -> int:
    """Return the number of a picture, of up to 32, from the red of its last pixel."""
    return round(int(pixels[-1, -1, 0]) / STEP)
