"""Pictures (h, w, 4) uint8, drawn for the tests of masks, outlines and everything after them."""

import struct
import zlib
from collections.abc import Callable, Sequence

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from engine.arrays import Booleans, Bytes, Floats

INK = (40, 90, 160)
Drawing = Callable[[ImageDraw.ImageDraw], None]


def blank_png(width: int, height: int) -> bytes:
    """A black PNG file, the same to the last byte whatever compresses it elsewhere."""

    def chunk(name: bytes, content: bytes) -> bytes:
        checksum = struct.pack(">I", zlib.crc32(name + content))
        return struct.pack(">I", len(content)) + name + content + checksum

    rows = bytes((1 + (width + 7) // 8) * height)
    block = b"\x01" + struct.pack("<HH", len(rows), len(rows) ^ 0xFFFF) + rows
    packed = b"\x78\x01" + block + struct.pack(">I", zlib.adler32(rows))
    header = struct.pack(">IIBBBBB", width, height, 1, 0, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")
    )


def painted(mask: Booleans, colour: tuple[int, int, int] = INK) -> Bytes:
    """A picture that is opaque on the mask and transparent elsewhere."""
    rgba = np.zeros((*mask.shape, 4), dtype=np.uint8)
    rgba[mask] = (*colour, 255)
    return rgba


def seen(rgba: Bytes) -> Booleans:
    """The mask of the pixels that are not nearly transparent."""
    return np.asarray(rgba[..., 3] > 8)


def drawn(width: int, height: int, drawing: Drawing, *, smooth: int = 4) -> Bytes:
    """What `drawing` fills with 255 on a canvas of `smooth` times the size, antialiased."""
    canvas = Image.new("L", (width * smooth, height * smooth))
    drawing(ImageDraw.Draw(canvas))
    rgba = np.zeros((height, width, 4), dtype=np.uint8)
    rgba[..., :3] = INK
    rgba[..., 3] = np.asarray(canvas.resize((width, height), Image.Resampling.BOX))
    return rgba


def on_plain(rgba: Bytes, background: tuple[int, int, int], *, noise: float = 0.0) -> Bytes:
    """The picture on an opaque background, with Gaussian noise of that many levels."""
    alpha = rgba[..., 3:] / 255.0
    rgb = rgba[..., :3] * alpha + np.array(background) * (1 - alpha)
    rgb += np.random.default_rng(0).normal(0, noise, rgb.shape)
    opaque = np.full((*rgba.shape[:2], 4), 255, dtype=np.uint8)
    opaque[..., :3] = np.clip(np.round(rgb), 0, 255)
    return opaque


def plane(width: int, height: int) -> tuple[Floats, Floats]:
    """x and y (h, w) of the pixel centres."""
    y, x = np.mgrid[:height, :width] + 0.5
    return x, y


def blob(size: int = 300, waves: int = 5, depth: float = 0.2) -> Bytes:
    x, y = plane(size, size)
    z = x - size / 2 + 1j * (y - size / 2)
    return painted(np.abs(z) < size * (0.35 + depth / 2 * np.sin(waves * np.angle(z))))


def letter(text: str, size: int) -> Bytes:
    font = ImageFont.load_default(size=size)
    left, top, right, bottom = (int(side) for side in font.getbbox(text))

    def drawing(draw: ImageDraw.ImageDraw) -> None:
        draw.text((2 - left, 2 - top), text, fill=255, font=font)

    return drawn(right - left + 4, bottom - top + 4, drawing, smooth=1)


def stick_figure(size: int = 400, line: int = 1) -> Bytes:
    """Head, body, arms and legs in lines of `line` pixels, not antialiased."""
    s = size / 100
    strokes = [
        (50, 30, 50, 62),
        (20, 32, 50, 42),
        (80, 32, 50, 42),
        (50, 62, 28, 96),
        (50, 62, 72, 96),
    ]

    def drawing(draw: ImageDraw.ImageDraw) -> None:
        draw.ellipse((40 * s, 8 * s, 60 * s, 30 * s), outline=255, width=line)
        for stroke in strokes:
            draw.line([s * value for value in stroke], fill=255, width=line)

    return drawn(size, size, drawing, smooth=1)


def limbs(gap: int, size: int = 400) -> Bytes:
    """Two upright limbs, `gap` pixels apart, on one body."""
    mask = np.zeros((size, size), dtype=np.bool_)
    low, high, middle = size // 10, size - size // 10, size // 2
    mask[low : size // 3, low:high] = True
    mask[size // 3 : high, middle - size // 8 : middle + size // 8 + gap] = True
    mask[size // 3 : high, middle : middle + gap] = False
    return painted(mask)


def star(points: int, size: int = 400, inner: float = 0.35) -> Bytes:
    turns = np.arange(2 * points) * np.pi / points
    radii = np.where(np.arange(2 * points) % 2 == 0, 0.48, 0.48 * inner)
    corners = 4 * size * (0.5 + 0.5j + radii * np.exp(1j * turns))

    def drawing(draw: ImageDraw.ImageDraw) -> None:
        draw.polygon([(z.real, z.imag) for z in corners], fill=255)

    return drawn(size, size, drawing)


def ring(size: int = 300, mouth: float = 0.0) -> Bytes:
    """A ring, with an opening of `mouth` pixels on its right side: nearly a C."""
    x, y = plane(size, size)
    radius = np.hypot(x - size / 2, y - size / 2)
    closed = (radius < 0.45 * size) & (radius > 0.25 * size)
    return painted(closed & ((x < size / 2) | (np.abs(y - size / 2) >= mouth / 2)))


def spiral(size: int, turns: float, share: float = 0.5) -> Bytes:
    """An arm that winds around the centre; of the way from turn to turn it fills `share`."""
    x, y = plane(size, size)
    z = x - size / 2 + 1j * (y - size / 2)
    radius = 0.48 * size
    phase = (np.abs(z) / radius * turns - np.angle(z) / (2 * np.pi)) % 1
    return painted((phase < share) & (np.abs(z) < radius))


def dots(count: int, size: int = 400, radius: float = 8.0, seed: int = 0) -> Bytes:
    rng = np.random.default_rng(seed)
    x, y = plane(size, size)
    mask = np.zeros((size, size), dtype=np.bool_)
    for cx, cy in rng.uniform(0.1 * size, 0.9 * size, (count, 2)):
        mask |= np.hypot(x - cx, y - cy) < radius
    return painted(mask)


def glow(size: int = 300, width: float = 0.15) -> Bytes:
    """A Gaussian glow whose standard deviation is `width` of the picture."""
    x, y = plane(size, size)
    square = (x - size / 2) ** 2 + (y - size / 2) ** 2
    rgba = np.full((size, size, 4), 200, dtype=np.uint8)
    rgba[..., 3] = np.round(255 * np.exp(-square / (2 * (width * size) ** 2)))
    return rgba


def noise(density: float, size: int = 200, seed: int = 0) -> Bytes:
    return painted(np.random.default_rng(seed).random((size, size)) < density)


def cloud(size: int = 300, seed: int = 0) -> Bytes:
    """Ragged lumps: smoothed noise above a level."""
    spectrum = np.fft.fft2(np.random.default_rng(seed).normal(size=(size, size)))
    frequency = np.hypot(np.fft.fftfreq(size)[:, None], np.fft.fftfreq(size))
    lumps = np.fft.ifft2(spectrum / (frequency + 3 / size) ** 2).real
    x, y = plane(size, size)
    fall = np.hypot(x - size / 2, y - size / 2) / (size / 2)
    return painted(lumps / lumps.std() + 2 - 4 * fall > 0)


def capsules(size: int, ends: Sequence[tuple[float, float, float, float, float]]) -> Bytes:
    """The union of strokes with round ends: x0, y0, x1, y1 and radius, all in shares of `size`."""
    x, y = plane(size, size)
    z = (x + 1j * y) / size
    mask = np.zeros((size, size), dtype=np.bool_)
    for x0, y0, x1, y1, radius in ends:
        start, along = complex(x0, y0), complex(x1 - x0, y1 - y0)
        place = np.clip(((z - start) * np.conj(along)).real / max(abs(along) ** 2, 1e-12), 0, 1)
        mask |= np.abs(z - start - place * along) < radius
    return painted(mask)
