"""Faded and blended layers and groups, against the formulas of the W3C in double precision.

"Compositing and Blending Level 1", Sections 9.1.4 and 10.
"""

import numpy as np
import pytest
from blend_formulas import BLEND_FORMULAS
from drawings import Easel
from numpy.testing import assert_allclose

from app.document.layers.groups import BLENDS
from app.document.queries.layers.compositing import CompositeGroup
from app.render.gpu.mesh import PosedMesh
from app.render.scene import Backdrop, Ghost, Scene
from app.render.view import canvas_view
from engine.arrays import Bytes, Floats

SIDE = 32


def colours(seed: int) -> Bytes:
    """Pixels of every alpha and colour, some of them opaque or nothing."""
    rng = np.random.default_rng(seed)
    pixels = rng.integers(0, 256, (SIDE, SIDE, 4), dtype=np.uint8)
    pixels[:8, :, 3] = 255
    pixels[:, :8, 3] = 0
    return pixels


def laid(easel: Easel, pixels: Bytes, side: int = SIDE) -> PosedMesh:
    """A picture that fills the frame."""
    corners = side * np.array([0, 1, 1 + 1j, 1j])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    return easel.pose(easel.mesh(pixels, corners, triangles), corners)


def over(
    below: Floats, layer: Floats, opacity: float, blend: str, *, clipped: bool = False
) -> Floats:
    """One straight colour over another."""
    backdrop, source = below[..., :3], layer[..., :3]
    alpha_b, alpha_s = below[..., 3:], layer[..., 3:] * opacity
    if clipped:
        painted = (1 - alpha_s) * backdrop + alpha_s * BLEND_FORMULAS[blend](backdrop, source)
        return np.concatenate([painted, alpha_b], axis=-1)
    mixed = (1 - alpha_b) * source + alpha_b * BLEND_FORMULAS[blend](backdrop, source)
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


CLEAR, PAPER, GLASS = (0.0, 0.0, 0.0, 0.0), (0.8, 0.5, 0.1, 1.0), (0.2, 0.6, 0.9, 0.5)


@pytest.mark.parametrize("blend", BLENDS)
def test_modes_blend_on_every_ground_and_in_every_group(easel, blend):
    pictures = {laid(easel, pixels): pixels for pixels in map(colours, range(4))}
    sky, base, above, side = pictures
    layer = CompositeGroup((above,), 0.6, blend)
    cut = CompositeGroup((above,), 0.6, blend, clipped=True)
    for colour in (CLEAR, PAPER, GLASS):
        for parts in (
            (CompositeGroup((above,), 1.0, blend),),
            (sky, layer),
            (sky, CompositeGroup((base, cut), 0.8)),
            (sky, CompositeGroup((base, layer, side), 0.7, is_pass_through=True)),
            (sky, CompositeGroup((base, CompositeGroup((side,), 0.5)), 0.6, blend)),
            (sky, CompositeGroup((base, CompositeGroup((side,), clipped=True)), 0.8, blend)),
        ):
            check(easel, parts, pictures, colour)


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


@pytest.mark.parametrize("colour", [CLEAR, PAPER])
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


def test_blends_ignore_a_checkerboard_which_is_clear_ground(easel):
    pictures = {laid(easel, pixels): pixels for pixels in map(colours, range(3))}
    below, ghost, above = pictures
    checks = Backdrop(colour=PAPER, checks=PAPER)
    blended = CompositeGroup((above,), 0.6, "difference")
    ghosts = (Ghost(meshes=(ghost,), tint=None, opacity=0.5),)
    scene = Scene(background=checks, meshes=(below, blended), ghosts=ghosts, ghosts_over=1)
    frame = easel.frame(canvas_view((SIDE, SIDE)), scene)
    clear = composited((below, CompositeGroup((ghost,), 0.5), blended), pictures)
    wanted = over(np.broadcast_to(PAPER, clear.shape), clear, 1, "normal")
    assert_allclose(frame / 255, wanted, rtol=0, atol=2.5 / 255)


def test_backdrops_are_finished_before_they_are_read(easel):
    # Software OpenGL draws a large frame for a while, and must not read it too early.
    side, levels = 240, ((250, 40, 90, 200), (30, 200, 120, 220), (90, 130, 210, 180))
    pictures = {
        laid(easel, np.full((side, side, 4), level, np.uint8), side): np.array(level)
        for level in levels
    }
    low, middle, high = pictures
    inner = CompositeGroup((middle, CompositeGroup((high,), 0.6, "multiply")), 1.0, "screen")
    parts = (CompositeGroup((low,), 0.6, "multiply"), inner)
    frame = easel.frame(canvas_view((side, side)), Scene(meshes=parts), oversampling=2)[1:-1, 1:-1]
    wanted = composited(parts, pictures)[0, 0]
    assert_allclose(frame / 255, np.broadcast_to(wanted, frame.shape), rtol=0, atol=1.5 / 255)
