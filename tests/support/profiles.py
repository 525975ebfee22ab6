"""ICC profiles from their definitions, for the tests of pictures that embed one."""

import struct

import numpy as np

# Chromaticities of red, green and blue, and of the white that both share (D65).
SRGB = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))
DISPLAY_P3 = ((0.68, 0.32), (0.265, 0.69), (0.15, 0.06))
D65 = (0.3127, 0.3290)
D50 = np.array([0.9642, 1.0, 0.8249])  # as ICC profiles write it
BRADFORD = np.array(
    [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]]
)


def to_xyz(primaries: tuple[tuple[float, float], ...]) -> np.ndarray:
    """The matrix from linear RGB to XYZ under D65."""
    columns = np.array([_xyz(*place) for place in primaries]).T
    return columns * np.linalg.solve(columns, _xyz(*D65))


def decoded(levels: np.ndarray) -> np.ndarray:
    """Linear light of the levels 0 … 1 by the curve of sRGB, which Display P3 shares."""
    return np.where(levels <= 0.04045, levels / 12.92, ((levels + 0.055) / 1.055) ** 2.4)


def encoded(light: np.ndarray) -> np.ndarray:
    """The inverse of `decoded`, cut off at 0 and 1."""
    light = np.clip(light, 0, 1)
    return np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def rgb_profile(name: str, primaries: tuple[tuple[float, float], ...]) -> bytes:
    """A profile of a screen with the curve of sRGB."""
    adapted = np.diag(BRADFORD @ D50 / (BRADFORD @ _xyz(*D65)))
    columns = np.linalg.inv(BRADFORD) @ adapted @ BRADFORD @ to_xyz(primaries)
    curve = b"para" + bytes(4) + struct.pack(">HH", 3, 0)
    curve += _fixed(2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045)
    tags = {f"{channel}XYZ": _point(columns[:, i]) for i, channel in enumerate("rgb")}
    tags |= {f"{channel}TRC": curve for channel in "rgb"}
    return _profile(name, b"mntr", b"RGB ", b"XYZ ", tags)


def grey_profile(name: str, gamma: float) -> bytes:
    """A profile of greys."""
    curve = b"para" + bytes(4) + struct.pack(">HH", 0, 0) + _fixed(gamma)
    return _profile(name, b"mntr", b"GRAY", b"XYZ ", {"kTRC": curve})


def press_profile(name: str) -> bytes:
    """A profile of a press with inks that are all grey: L* is 100 without and 0 with all four."""
    inks = np.indices((2, 2, 2, 2)).reshape(4, -1).sum(axis=0)
    table = np.full((16, 3), 128, np.uint8)
    table[:, 0] = np.rint(255 * (1 - inks / 4))
    ramp = bytes(range(256))
    matrix = _fixed(1, 0, 0, 0, 1, 0, 0, 0, 1)
    lut = b"mft1" + bytes(4) + bytes([4, 3, 2, 0]) + matrix + 4 * ramp + table.tobytes() + 3 * ramp
    return _profile(name, b"prtr", b"CMYK", b"Lab ", {"A2B0": lut})


def _profile(name: str, kind: bytes, space: bytes, between: bytes, tags: dict[str, bytes]) -> bytes:
    text = name.encode("utf-16-be")
    words = b"mluc" + bytes(4) + struct.pack(">II2s2sII", 1, 12, b"en", b"US", len(text), 28) + text
    tags = {"desc": words, "wtpt": _point(D50), **tags}
    place = 128 + 4 + 12 * len(tags)
    table, data = struct.pack(">I", len(tags)), b""
    for tag, content in tags.items():
        table += struct.pack(">4sII", tag.encode(), place + len(data), len(content))
        data += content + bytes(-len(content) % 4)
    header = struct.pack(">I4xI", place + len(data), 0x04200000) + kind + space + between
    header += bytes(12) + b"acsp" + bytes(28) + _fixed(*D50)
    return header.ljust(128, b"\0") + table + data


def _xyz(x: float, y: float) -> np.ndarray:
    return np.array([x / y, 1.0, (1 - x - y) / y])


def _point(xyz: np.ndarray) -> bytes:
    return b"XYZ " + bytes(4) + _fixed(*xyz)


def _fixed(*numbers: float) -> bytes:
    return b"".join(struct.pack(">i", round(number * 65536)) for number in numbers)
