"""How legible the window's texts are: the contrast of each glyph with what lies behind it."""

import ctypes
from typing import NamedTuple

import numpy as np
from harness import Harness
from imgui_bundle import imgui

from engine.arrays import Booleans, Floats, Integers

VERTEX = np.dtype([("position", "f4", 2), ("uv", "f4", 2), ("colour", "u1", 4)])
INDEX = np.dtype(f"u{imgui.INDEX_SIZE}")
LEAST = 4.5  # contrast that WCAG 2.2 asks for (1.4.3); what is disabled is exempt
SEEN = 0.3  # of its ink, that a glyph has somewhere unless it is covered


class Glyph(NamedTuple):
    """A glyph on the screen: its corners, the colour that it has, and the one behind it."""

    box: tuple[int, ...]
    ink: tuple[int, ...]
    ground: tuple[int, ...]
    contrast: float


def luminance(colours: Floats) -> Floats:
    """Return the relative luminance of sRGB colours of 0 to 255, as WCAG defines it."""
    share = np.asarray(colours) / 255
    linear = np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)
    return np.asarray(linear @ [0.2126, 0.7152, 0.0722])


def contrast(ink: Floats, ground: Floats) -> float:
    """Return the contrast of two sRGB colours of 0 to 255, 1 to 21."""
    low, high = sorted((float(luminance(ink)), float(luminance(ground))))
    return (high + 0.05) / (low + 0.05)


def glyphs(window: Harness) -> list[Glyph]:
    """Return the glyphs that are seen in the next frame, without those of disabled items."""
    written = np.asarray(window.picture())
    boxes, inks = [], []
    for commands in imgui.get_draw_data().cmd_lists:
        for box, ink in _take_glyphs(commands):
            boxes.append(box)
            inks.append(ink)
    blank = np.asarray(window.repainted())
    disabled = round(255 * imgui.get_style().disabled_alpha)
    found = []
    for box, (*colour, alpha) in zip(boxes, inks, strict=True):
        x0, y0, x1, y1 = box
        part = np.s_[max(y0, 0) : max(y1, 0), max(x0, 0) : max(x1, 0)]
        behind = blank[part].reshape(-1, 3).astype(int)
        if alpha <= disabled or not behind.size:
            continue
        ground = np.median(behind, axis=0)
        way = alpha / 255 * (np.array(colour) - ground)
        change = (written[part].reshape(-1, 3) - behind) @ way
        if change.max() <= SEEN * (way @ way):
            continue
        ink = ground + way
        levels = [tuple(np.rint(each).astype(int).tolist()) for each in (ink, ground)]
        found.append(Glyph(box, *levels, contrast(ink, ground)))
    return found


def _take_glyphs(commands: imgui.ImDrawList) -> list[tuple[tuple[int, ...], list[int]]]:
    """Return the boxes and colours of a draw list's glyphs, and make them transparent there."""
    if not (commands.vtx_buffer.size() and commands.idx_buffer.size()):
        return []
    vertices = _view(commands.vtx_buffer, VERTEX)
    fonts = {image.tex_id for image in imgui.get_platform_io().textures}
    first = []
    for command in commands.cmd_buffer:
        if command.tex_ref.get_tex_id() in fonts:
            end = command.idx_offset + command.elem_count
            first.append(_quads(_view(commands.idx_buffer, INDEX)[command.idx_offset : end]))
    corners = np.concatenate([np.empty(0, dtype=int), *first])
    corners = corners[_are_glyphs(vertices["uv"], corners)]
    low = np.floor(vertices["position"][corners]).astype(int)
    high = np.ceil(vertices["position"][corners + 2]).astype(int)
    inks = vertices["colour"][corners].tolist()
    for corner in range(4):
        vertices["colour"][corners + corner, 3] = 0
    boxes = map(tuple, np.hstack([low, high]).tolist())
    return list(zip(boxes, inks, strict=True))


def _are_glyphs(uv: Floats, corners: Integers) -> Booleans:
    """Tell which rectangles, by their first vertices, show a part of the atlas that is upright.

    All else that is filled is of the atlas's one white pixel, lines are of a row of it, and rounded
    corners are one picture, followed by the same mirrored.
    """
    low, beside, high, below = (uv[corners + corner] for corner in range(4))
    is_upright = (low < high).all(axis=1) & (low[:, 1] == beside[:, 1]) & (low[:, 0] == below[:, 0])
    following = uv[np.minimum(corners + 4, len(uv) - 1)]
    return is_upright & (following != beside).any(axis=1)


def _quads(indices: Integers) -> Integers:
    """Return the first vertex of each four that two triangles make a rectangle of."""
    triangles = indices.astype(int).reshape(-1, 3)
    first, second = triangles[:-1], triangles[1:]
    is_quad = (first - first[:, :1] == [0, 1, 2]).all(axis=1)
    is_quad &= (second - first[:, :1] == [0, 2, 3]).all(axis=1)
    return first[is_quad, 0]


def _view(buffer: object, kind: np.dtype) -> np.ndarray:
    size = buffer.size() * kind.itemsize
    return np.frombuffer((ctypes.c_char * size).from_address(buffer.data_address()), kind)
