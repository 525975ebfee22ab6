"""Photoshop files, written byte by byte as other programs write them."""

import struct
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from engine.arrays import Bytes

NORMAL, PASS_THROUGH, MULTIPLY, SCREEN, VIVID_LIGHT = b"norm", b"pass", b"mul ", b"scrn", b"vLit"
FOLDER, BELOW_ALL = 1, 3  # kinds of section dividers: a group, and where it begins from below
# Bits of what is said of a mask of pixels, and of a path.
DENSITY, FEATHER, PATH_DENSITY, PATH_FEATHER = 1, 2, 4, 8
ON, OFF = b"bool\1", b"bool\0"  # values in descriptors
UNION, SUBTRACT = 1, 2  # of a path with those before
PIXELS_SAY_NOTHING = 16  # a layer's flag


@dataclass(frozen=True, kw_only=True, eq=False)
class Mask:
    """A mask, uint8 (h, w), which is `outside` around itself."""

    pixels: Bytes
    left: int = 0
    top: int = 0
    outside: int = 0
    disabled: bool = False
    is_path: bool = False  # its pixels were drawn from a path
    density: int | None = None
    feather: float | None = None
    path_density: int | None = None
    path_feather: float | None = None


@dataclass(frozen=True, kw_only=True, eq=False)
class Drawn:
    """A layer with pixels, uint8 (h, w, 4)."""

    name: str
    pixels: Bytes
    left: int = 0
    top: int = 0
    opacity: int = 255
    blend: bytes = NORMAL
    clipped: bool = False
    hidden: bool = False
    mask: Mask | None = None
    blocks: tuple[tuple[bytes, bytes], ...] = ()  # keys of four letters, and what they say
    ranges: tuple[int, int, int, int] = (0, 0, 255, 255)  # of its greys, at which it is seen
    is_described: bool = False  # has no pixels, since its blocks say what it shows


@dataclass(frozen=True, kw_only=True, eq=False)
class Folder:
    """A group of what lies in it, from back to front."""

    name: str
    layers: "Sequence[Drawn | Folder]"
    opacity: int = 255
    blend: bytes = PASS_THROUGH
    clipped: bool = False
    hidden: bool = False
    mask: Mask | None = None
    blocks: tuple[tuple[bytes, bytes], ...] = ()


@dataclass
class _Written:
    padding: int | None = None
    records: list[bytes] = field(default_factory=list)
    channels: list[bytes] = field(default_factory=list)


def photoshop_file(
    size: tuple[int, int],
    layers: Sequence[Drawn | Folder],
    *,
    in_block: bool = False,
    padding: int | None = None,
) -> bytes:
    """Return a file of a canvas of this width and height, and its layers from back to front.

    They stand where layers of 16 bits a channel do, if that is wanted. With a padding, channels
    are packed row by row, and followed by so many bytes.
    """
    width, height = size
    written = _Written(padding)
    for layer in layers:
        _write(written, layer)
    info = struct.pack(">h", len(written.records))
    info += b"".join(written.records) + b"".join(written.channels)
    info += bytes(len(info) % 2)
    section = struct.pack(">I", len(info)) + info + struct.pack(">I", 0)
    if in_block:
        info += bytes(-len(info) % 4)
        section = struct.pack(">II4s4sI", 0, 0, b"8BIM", b"Lr16", len(info)) + info
    header = b"8BPS" + struct.pack(">H6xHIIHH", 1, 3, height, width, 8, 3)
    return b"".join(
        [
            header,
            struct.pack(">II", 0, 0),
            struct.pack(">I", len(section)),
            section,
            struct.pack(">H", 0),
            bytes(3 * width * height),
        ]
    )


def _write(written: _Written, layer: Drawn | Folder) -> None:
    if isinstance(layer, Drawn):
        _record(written, layer, layer.pixels, (layer.left, layer.top), layer.blocks)
        return
    end = Drawn(name="</Layer group>", pixels=np.zeros((0, 0, 4), np.uint8))
    _record(written, end, end.pixels, (0, 0), (_divider(BELOW_ALL),))
    for inner in layer.layers:
        _write(written, inner)
    _record(written, layer, end.pixels, (0, 0), (_divider(FOLDER, layer.blend), *layer.blocks))


def _divider(kind: int, blend: bytes = b"") -> tuple[bytes, bytes]:
    return b"lsct", struct.pack(">I", kind) + (b"8BIM" + blend if blend else b"")


def _record(
    written: _Written,
    layer: Drawn | Folder,
    pixels: Bytes,
    corner: tuple[int, int],
    blocks: Sequence[tuple[bytes, bytes]],
) -> None:
    left, top = corner
    height, width, _ = pixels.shape
    planes = {-1: pixels[..., 3], 0: pixels[..., 0], 1: pixels[..., 1], 2: pixels[..., 2]}
    if layer.mask is not None:
        planes[-2] = layer.mask.pixels
    data = {number: _channel(plane, written.padding) for number, plane in planes.items()}
    if isinstance(layer, Drawn) and layer.is_described:
        data = dict.fromkeys(planes, b"\0\0")
    name = layer.name.encode("latin-1")
    ranges = bytes(layer.ranges) if isinstance(layer, Drawn) else b""
    # Then those of what lies behind.
    ranges += bytes([0, 0, 255, 255]) if ranges else b""
    extra = _mask(layer.mask) + struct.pack(">I", len(ranges)) + ranges + bytes([len(name)]) + name
    extra += bytes(-(1 + len(name)) % 4)
    for key, said in blocks:
        extra += b"8BIM" + key + struct.pack(">I", len(said)) + said
    record = struct.pack(">iiiiH", top, left, top + height, left + width, len(data))
    for number, channel in data.items():
        record += struct.pack(">hI", number, len(channel))
    # A group's own mode is with its divider.
    blend = NORMAL if layer.blend == PASS_THROUGH else layer.blend
    flags = 2 * layer.hidden
    if isinstance(layer, Drawn) and layer.is_described:
        flags |= PIXELS_SAY_NOTHING
    record += b"8BIM" + blend + bytes([layer.opacity, layer.clipped, flags, 0])
    written.records.append(record + struct.pack(">I", len(extra)) + extra)
    written.channels += data.values()


def _channel(plane: Bytes, padding: int | None) -> bytes:
    if padding is None:
        return struct.pack(">H", 0) + plane.tobytes()
    rows = [bytes([len(row) - 1]) + row.tobytes() for row in plane]
    lengths = b"".join(struct.pack(">H", len(row)) for row in rows)
    return struct.pack(">H", 1) + lengths + b"".join(rows) + bytes(padding)


def _mask(mask: Mask | None) -> bytes:
    if mask is None:
        return struct.pack(">I", 0)
    height, width = mask.pixels.shape
    box = (mask.top, mask.left, mask.top + height, mask.left + width)
    said = {
        DENSITY: (">B", mask.density),
        FEATHER: (">d", mask.feather),
        PATH_DENSITY: (">B", mask.path_density),
        PATH_FEATHER: (">d", mask.path_feather),
    }
    settings = {
        bit: struct.pack(form, value) for bit, (form, value) in said.items() if value is not None
    }
    flags = 2 * mask.disabled + 8 * mask.is_path + 16 * bool(settings)
    data = struct.pack(">iiiiBB", *box, mask.outside, flags)
    if settings:
        data += bytes([sum(settings)]) + b"".join(settings.values())
        data += bytes(max(0, 36 - len(data)) if len(data) > 20 else 20 - len(data))
    else:
        data += bytes(2)
    return struct.pack(">I", len(data)) + data


Box = tuple[float, float, float, float]  # left, top, right, bottom, as shares of the canvas


def path_block(*boxes: Box, flags: int = 0) -> tuple[bytes, bytes]:
    """Return the block of a path, of a shape or a mask: a rectangle with rectangular holes."""
    records = struct.pack(">H24x", 6) + struct.pack(">HH22x", 8, 0)
    for number, (left, top, right, bottom) in enumerate(boxes):
        does = SUBTRACT if number else UNION
        records += struct.pack(">HHhHII10x", 0, 4, does, 1, 0, 0)
        for x, y in ((left, top), (right, top), (right, bottom), (left, bottom)):
            records += struct.pack(">H6i", 1, *3 * (round(y * (1 << 24)), round(x * (1 << 24))))
    return b"vmsk", _padded(struct.pack(">II", 3, flags) + records)


def fill_block(colour: tuple[int, int, int], kind: bytes = b"RGBC") -> tuple[bytes, bytes]:
    """Return the block of a fill of one colour."""
    return b"SoCo", _padded(struct.pack(">I", 16) + descriptor(b"null", _colour(colour, kind)))


def effects_block(
    *effects: tuple[bytes, dict[bytes, bytes]], key: bytes = b"lfx2"
) -> tuple[bytes, bytes]:
    """Return the block of effects, each with its kind and what it says."""
    said = {b"masterFXSwitch": ON}
    for kind, values in effects:
        said[kind] = b"Objc" + descriptor(kind, {b"enab": ON, **values})
    return key, _padded(struct.pack(">II", 0, 16) + descriptor(b"null", said))


def overlay(
    colour: tuple[int, int, int], percent: float = 100, mode: bytes = b"Nrml"
) -> tuple[bytes, dict[bytes, bytes]]:
    """Return the effect of a colour over a layer."""
    return b"SoFi", {
        b"Md  ": b"enum" + _key(b"BlnM") + _key(mode),
        b"Opct": b"UntF#Prc" + struct.pack(">d", percent),
        **_colour(colour, b"RGBC"),
    }


def old_effects_block(*kinds: bytes) -> tuple[bytes, bytes]:
    """Return the block of effects as programs before 2000 wrote it, all of them overlays."""
    colour = struct.pack(">H4H", 0, 65535, 0, 0, 0)
    fill = struct.pack(">I4s4s", 2, b"8BIM", NORMAL) + colour + bytes([255, 1]) + colour
    listed = b"".join(b"8BIM" + kind + struct.pack(">I", len(fill)) + fill for kind in kinds)
    return b"lrFX", _padded(struct.pack(">HH", 0, len(kinds)) + listed)


def descriptor(kind: bytes, said: dict[bytes, bytes]) -> bytes:
    """Return values by their keys, each value with its type in front."""
    listed = b"".join(_key(key) + value for key, value in said.items())
    return struct.pack(">IH", 1, 0) + _key(kind) + struct.pack(">I", len(said)) + listed


def _colour(colour: tuple[int, int, int], kind: bytes) -> dict[bytes, bytes]:
    names = (b"Rd  ", b"Grn ", b"Bl  ")
    said = {
        name: b"doub" + struct.pack(">d", level) for name, level in zip(names, colour, strict=True)
    }
    return {b"Clr ": b"Objc" + descriptor(kind, said)}


def _key(key: bytes) -> bytes:
    return struct.pack(">I", 0 if len(key) == 4 else len(key)) + key


def _padded(content: bytes) -> bytes:
    return content + bytes(-len(content) % 4)
