"""Faded and blended layers and groups, against the formulas of the W3C in double precision.

"Compositing and Blending Level 1", Sections 9.1.4 and 10.
"""

import numpy as np
import pytest
from drawings import Easel
from numpy.testing import assert_allclose

from app.document.queries.layers.compositing import CompositeGroup
from app.render.gpu.mesh import PosedMesh
from app.render.scene import Backdrop, Scene
from app.render.view import canvas_view
from engine.arrays import Bytes, Floats

SIDE = 32


def by_pixel(formula):
    """A formula of the W3C for one colour, for an array of colours."""

    def blended(backdrop: Floats, source: Floats) -> Floats:
        pairs = zip(backdrop.reshape(-1, 3).tolist(), source.reshape(-1, 3).tolist(), strict=True)
        return np.reshape([formula(*pair) for pair in pairs], backdrop.shape)

    return blended


def soft_light(b, s):
    if s <= 0.5:
        return b - (1 - 2 * s) * b * (1 - b)
    return b + (2 * s - 1) * ((((16 * b - 12) * b + 4) * b if b <= 0.25 else b**0.5) - b)


def color_dodge(b, s):
    return 0 if b == 0 else 1 if s == 1 else min(1, b / (1 - s))


def color_burn(b, s):
    return 1 if b == 1 else 0 if s == 0 else 1 - min(1, (1 - b) / s)


def hard_light(b, s):
    return b * 2 * s if s <= 0.5 else b + (2 * s - 1) - b * (2 * s - 1)


def luminance(c):
    return 0.3 * c[0] + 0.59 * c[1] + 0.11 * c[2]


def set_luminance(c, lum):
    c = [x + lum - luminance(c) for x in c]
    lum, low, high = luminance(c), min(c), max(c)
    if low < 0:
        c = [lum + (x - lum) * lum / (lum - low) for x in c]
    if high > 1:
        c = [lum + (x - lum) * (1 - lum) / (high - lum) for x in c]
    return c


def saturation(c):
    return max(c) - min(c)


def set_saturation(c, sat):
    least, middle, most = np.argsort(c, kind="stable")
    found = [0.0, 0.0, 0.0]
    if c[most] > c[least]:
        found[middle] = (c[middle] - c[least]) * sat / (c[most] - c[least])
        found[most] = sat
    return found


BLENDS = {
    "normal": lambda _, s: s,
    "darken": np.minimum,
    "multiply": lambda b, s: b * s,
    "color-burn": np.vectorize(color_burn, otypes=[float]),
    "linear-burn": lambda b, s: np.clip(b + s - 1, 0, 1),
    "lighten": np.maximum,
    "screen": lambda b, s: b + s - b * s,
    "color-dodge": np.vectorize(color_dodge, otypes=[float]),
    "linear-dodge": lambda b, s: np.clip(b + s, 0, 1),
    "overlay": np.vectorize(lambda b, s: hard_light(s, b), otypes=[float]),
    "soft-light": np.vectorize(soft_light, otypes=[float]),
    "hard-light": np.vectorize(hard_light, otypes=[float]),
    "difference": lambda b, s: abs(b - s),
    "exclusion": lambda b, s: b + s - 2 * b * s,
    "subtract": lambda b, s: np.clip(b - s, 0, 1),
    "hue": by_pixel(lambda b, s: set_luminance(set_saturation(s, saturation(b)), luminance(b))),
    "saturation": by_pixel(
        lambda b, s: set_luminance(set_saturation(b, saturation(s)), luminance(b))
    ),
    "color": by_pixel(lambda b, s: set_luminance(s, luminance(b))),
    "luminosity": by_pixel(lambda b, s: set_luminance(b, luminance(s))),
}


def colours(seed: int) -> Bytes:
    """Pixels of every alpha and colour, some of them opaque or nothing."""
    rng = np.random.default_rng(seed)
    pixels = rng.integers(0, 256, (SIDE, SIDE, 4), dtype=np.uint8)
    pixels[:8, :, 3] = 255
    pixels[:, :8, 3] = 0
    return pixels


def laid(easel: Easel, pixels: Bytes) -> PosedMesh:
    """A picture that fills the frame."""
    corners = SIDE * np.array([0, 1, 1 + 1j, 1j])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return easel.pose(easel.mesh(pixels, corners, triangles), corners)


def over(
    below: Floats, layer: Floats, opacity: float, blend: str, *, clipped: bool = False
) -> Floats:
    """One straight colour over another."""
    backdrop, source = below[..., :3], layer[..., :3]
    alpha_b, alpha_s = below[..., 3:], layer[..., 3:] * opacity
    if clipped:
        painted = (1 - alpha_s) * backdrop + alpha_s * BLENDS[blend](backdrop, source)
        return np.concatenate([painted, alpha_b], axis=-1)
    mixed = (1 - alpha_b) * source + alpha_b * BLENDS[blend](backdrop, source)
    alpha = alpha_s + alpha_b - alpha_s * alpha_b
    colour = alpha_s * mixed + (1 - alpha_s) * alpha_b * backdrop
    return np.concatenate([colour / np.maximum(alpha, 1e-9), alpha], axis=-1)


def mixed(below: Floats, above: Floats, share: float) -> Floats:
    """Straight colours that are faded into each other."""
    (b, alpha_b), (a, alpha_a) = ((each[..., :3], each[..., 3:]) for each in (below, above))
    alpha = (1 - share) * alpha_b + share * alpha_a
    colour = (1 - share) * alpha_b * b + share * alpha_a * a
    return np.concatenate([colour / np.maximum(alpha, 1e-9), alpha], axis=-1)


def composited(parts: tuple, pictures: dict, below: Floats | None = None) -> Floats:
    flat = np.zeros((SIDE, SIDE, 4)) if below is None else below
    for part in parts:
        if isinstance(part, CompositeGroup) and part.is_pass_through:
            whole = composited(part.parts, pictures, flat)
            flat = mixed(flat, whole, part.opacity)
        elif isinstance(part, CompositeGroup):
            layer = composited(part.parts, pictures)
            layer = layer * (*part.effects.get("layer_tint", (1.0, 1.0, 1.0)), 1.0)
            flat = over(flat, layer, part.opacity, part.blend, clipped=part.clipped)
        else:
            flat = over(flat, pictures[part] / 255, 1, "normal")
    return flat


def check(easel: Easel, parts: tuple, pictures: dict, colour=(0.0, 0.0, 0.0, 0.0)) -> None:
    frame = easel.frame(
        canvas_view((SIDE, SIDE)), Scene(background=Backdrop(colour=colour), meshes=parts)
    )
    wanted = composited(parts, pictures, np.broadcast_to(colour, (SIDE, SIDE, 4)))
    assert_allclose(frame[..., 3] / 255, wanted[..., 3], rtol=0, atol=1.5 / 255)
    # Of faint pixels few levels are left; what counts is what they paint.
    shown, meant = (each[..., :3] * wanted[..., 3:] for each in (frame / 255, wanted))
    assert_allclose(shown, meant, rtol=0, atol=2.5 / 255)


PAPER = (0.8, 0.5, 0.1, 1.0)


@pytest.mark.parametrize("blend", BLENDS)
@pytest.mark.parametrize(
    ("opacity", "colour"),
    [(1.0, (0.0, 0.0, 0.0, 0.0)), (0.4, (0.0, 0.0, 0.0, 0.0)), (0.4, PAPER), (0.0, PAPER)],
)
def test_layers_meet_what_is_behind_them_as_they_are_blended(easel, blend, opacity, colour):
    pictures = {laid(easel, pixels): pixels for pixels in (colours(1), colours(2))}
    below, above = pictures
    check(easel, (below, CompositeGroup((above,), opacity, blend)), pictures, colour)


@pytest.mark.parametrize("colour", [(0.0, 0.0, 0.0, 0.0), PAPER])
def test_tint_multiplies_the_colours_of_a_layer(easel, colour):
    pictures = {laid(easel, pixels): pixels for pixels in (colours(1), colours(2))}
    below, above = pictures
    tinted = CompositeGroup((above,), 0.7, effects={"layer_tint": (1.0, 0.5, 0.0)})
    check(easel, (below, tinted), pictures, colour)


def test_groups_are_composited_as_one_and_then_faded(easel):
    pictures = {laid(easel, pixels): pixels for pixels in map(colours, range(5))}
    sky, one, two, three, four = pictures
    inner = CompositeGroup((two, CompositeGroup((three,), 0.7, "multiply")), 0.5, "screen")
    parts = (sky, CompositeGroup((one, inner), 0.6), CompositeGroup((four,), 1.0, "multiply"))
    check(easel, parts, pictures)


@pytest.mark.parametrize("colour", [(0.0, 0.0, 0.0, 0.0), PAPER])
def test_what_blends_in_a_faded_group_that_passes_through_meets_all_behind(easel, colour):
    pictures = {laid(easel, pixels): pixels for pixels in map(colours, range(5))}
    sky, one, two, three, four = pictures
    inner = CompositeGroup(
        (two, CompositeGroup((three,), 0.7, "screen")), 0.5, is_pass_through=True
    )
    faded = CompositeGroup(
        (CompositeGroup((one,), 1.0, "multiply"), inner), 0.6, is_pass_through=True
    )
    check(easel, (sky, faded, CompositeGroup((four,), 1.0, "multiply")), pictures, colour)


def test_what_overlaps_in_a_faded_group_does_not_shine_through(easel):
    opaque = [
        np.full((SIDE, SIDE, 4), colour, np.uint8)
        for colour in ((255, 0, 0, 255), (0, 0, 255, 255))
    ]
    red, blue = (laid(easel, pixels) for pixels in opaque)
    frame = easel.frame(
        canvas_view((SIDE, SIDE)), Scene(meshes=(CompositeGroup((red, blue), 0.5),))
    )
    assert (frame == (0, 0, 255, 128)).all()


@pytest.mark.parametrize("blend", BLENDS)
def test_what_is_clipped_is_seen_within_what_is_below_it_alone(easel, blend):
    pictures = {laid(easel, pixels): pixels for pixels in map(colours, range(3))}
    sky, base, above = pictures
    cut = CompositeGroup((above,), 0.6, blend, clipped=True)
    check(easel, (sky, CompositeGroup((base, cut), 0.8)), pictures)
