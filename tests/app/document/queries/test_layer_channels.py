"""The camera, layers moved as a whole, fades and orders: at keys, between them, around loops."""

from dataclasses import replace
from math import exp, log, pi

import numpy as np
import pytest
from documents import CENTRE, altered, disc_document
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    CAMERA,
    DRAW_ORDER,
    HOLD,
    OPACITY,
    TRANSFORM,
    Camera,
    DrawOrder,
    FrameRange,
    TangentMode,
    Transform,
    camera_at,
    export_frame_range,
    layer_commands,
    layers_in_draw_order,
    opacity_at,
    scene_commands,
    transform_at,
    without_foreign_clips,
)
from app.document.commands.scene_commands import KEY_OUTSIDE
from app.document.layers.groups import Group
from app.document.model import NO_LAYER
from app.errors import LissomError

EMPTY = replace(disc_document(), frames=FrameRange(0, 48))
KEYS = (
    CAMERA.key(4, Camera(centre=100 + 100j)),
    CAMERA.key(10, Camera(centre=130 + 80j, zoom=3.0, turn=pi / 2)),
    CAMERA.key(30, Camera(centre=90 + 160j, zoom=0.4, turn=-pi)),
    CAMERA.key(40, Camera(centre=70 + 10j, zoom=2.0, turn=3 * pi)),
)
STEP = 1e-5  # frames, for slopes


def with_camera(keys=KEYS, *, loop=False):
    return altered(EMPTY, camera=tuple(keys), loop=loop)


def camera_values(document, frame):
    """Return what the camera shows as numbers that are blended evenly."""
    shot = camera_at(document, frame)
    return np.array([shot.centre.real, shot.centre.imag, log(shot.zoom), shot.turn])


def slopes(document, frame):
    before, at, after = (camera_values(document, frame + by) for by in (-STEP, 0, STEP))
    return (at - before) / STEP, (after - at) / STEP


def test_a_key_is_given_to_the_bit_and_held_outside():
    document = with_camera()
    for key in KEYS:
        shot = camera_at(document, key.frame)
        assert (shot.centre, shot.turn) == (key.value.centre, key.value.turn)
        assert shot.zoom == pytest.approx(key.value.zoom, rel=1e-14)
    assert camera_at(document, 0) == camera_at(document, 4)
    assert camera_at(document, 48) == camera_at(document, 40)
    assert camera_at(EMPTY, 7) is None


def test_the_camera_passes_its_keys_and_the_ends_of_its_motion_without_a_jerk():
    for key in KEYS:
        assert_allclose(*slopes(with_camera(), key.frame), rtol=0, atol=1e-3)
    assert np.abs(slopes(with_camera(), 10)).min() > 0.01
    corners = with_camera(replace(key, tangent_mode=TangentMode.CORNER) for key in KEYS)
    assert np.abs(np.subtract(*slopes(corners, 10))).max() > 1


def test_zoom_is_blended_by_its_logarithm():
    two = (CAMERA.key(0, Camera(centre=0j)), CAMERA.key(24, Camera(centre=0j, zoom=4.0)))
    assert camera_at(with_camera(two), 12).zoom == pytest.approx(2.0, rel=1e-12)
    even = with_camera(replace(key, tangent_mode=TangentMode.CORNER) for key in two)
    for frame in (3, 6, 17.5):
        assert camera_at(even, frame).zoom == pytest.approx(exp(log(4) * frame / 24), rel=1e-12)


def test_what_is_seen_is_zoomed_and_turned_counter_clockwise_around_the_centre():
    document = with_camera([CAMERA.key(0, Camera(centre=30 + 40j, zoom=2.0, turn=pi / 2))])
    seen = camera_at(document, 0).canvas_motion((200, 100))
    # What lies to the right of the centre is seen above it.
    places = seen.apply(np.array([30 + 40j, 35 + 40j]))
    assert_allclose(places, [100 + 50j, 100 + 60j], rtol=0, atol=1e-12)
    assert seen.apply_inverse(100 + 60j) == pytest.approx(35 + 40j, abs=1e-12)


def test_in_a_loop_the_camera_comes_round():
    document = with_camera(loop=True)
    for frame in (0, 4, 40, 47.9):
        assert_allclose(*slopes(document, frame), rtol=0, atol=1e-3)
        assert_allclose(
            camera_values(document, frame + 48), camera_values(document, frame), rtol=0, atol=1e-9
        )
    assert camera_at(document, 0).zoom != camera_at(document, 40).zoom
    closed = (replace(KEYS[0], frame=0), KEYS[1], KEYS[2], replace(KEYS[0], frame=48))
    seam = with_camera(closed, loop=True)
    assert_allclose(slopes(seam, 0)[1], slopes(seam, 48)[0], rtol=0, atol=1e-3)
    assert np.abs(slopes(seam, 0)[1]).max() > 0.1
    assert camera_at(with_camera(KEYS[:1], loop=True), 20) == camera_at(with_camera(KEYS[:1]), 20)


def test_the_last_frame_of_a_loop_is_left_out_only_where_all_of_it_is_the_first_again():
    assert export_frame_range(altered(EMPTY, loop=True)).last == 47
    panned = (replace(KEYS[0], frame=0), replace(KEYS[1], frame=48))
    assert export_frame_range(with_camera(panned, loop=True)).last == 48
    # A wheel that has turned round is where it was.
    wheel = (TRANSFORM.key(0, Transform()), TRANSFORM.key(48, Transform(turn=2 * pi)))
    assert (
        export_frame_range(altered(EMPTY, loop=True, channels={(TRANSFORM.name, None): wheel})).last
        == 47
    )
    rolled = (TRANSFORM.key(0, Transform()), TRANSFORM.key(48, Transform(shift=1, turn=2 * pi)))
    assert (
        export_frame_range(
            altered(EMPTY, loop=True, channels={(TRANSFORM.name, None): rolled})
        ).last
        == 48
    )


def test_a_held_camera_jumps():
    held = with_camera([replace(KEYS[0], easing=HOLD), *KEYS[1:]])
    assert camera_at(held, 9.999) == camera_at(held, 4)


def test_a_layer_is_moved_and_turned_around_its_anchor_or_its_middle():
    keys = (TRANSFORM.key(0, Transform()), TRANSFORM.key(8, Transform(shift=10 + 5j, turn=pi / 2)))
    document = altered(EMPTY, channels={(TRANSFORM.name, None): keys})
    layer = document.layers[0]
    motion = transform_at(document, layer, 8)
    assert abs(layer.pivot - CENTRE) < 1e-9
    places = motion.apply(np.array([layer.pivot, layer.pivot + 1]))
    assert_allclose(places, layer.pivot + 10 + 5j + np.array([0, 1j]), rtol=0, atol=1e-9)
    assert abs(transform_at(document, layer, 3.7).factor) == pytest.approx(1, abs=1e-15)
    by_anchor = replace(layer, anchor=80 + 90j)
    assert transform_at(document, by_anchor, 8).apply(np.array([80 + 90j]))[0] == pytest.approx(
        90 + 95j, abs=1e-9
    )


def test_fades_are_even_and_stay_between_nothing_and_all():
    keys = (OPACITY.key(0, 1.0), OPACITY.key(12, 0.2))
    document = altered(EMPTY, opacity=0.5, channels={(OPACITY.name, None): keys})
    layer = document.layers[0]
    assert opacity_at(document, layer, 3) == pytest.approx(0.8, abs=1e-12)
    assert opacity_at(document, layer, 40) == 0.2
    peaks = [0.9, 1.0, 0.1, 0.0, 0.8]
    keys = tuple(
        OPACITY.key(6 * i, each, tangent_mode=TangentMode.SMOOTH) for i, each in enumerate(peaks)
    )
    through = altered(EMPTY, channels={(OPACITY.name, None): keys})
    values = [opacity_at(through, through.layers[0], t) for t in np.arange(0, 30, 0.1)]
    assert max(values) == 1.0
    assert min(values) == 0.0


def stack(**order_keys):
    document = EMPTY
    for name in "abcd"[: 4 - len(document.layers)]:
        copy = replace(EMPTY.layers[0], id=layer_commands.next_layer_id(document), name=f"{name}")
        document = layer_commands.add_layer(copy)(document)
    ids = {layer.name: layer.id for layer in document.layers}
    layers = tuple(
        replace(
            layer,
            channels={
                (DRAW_ORDER.name, None): tuple(
                    DRAW_ORDER.key(frame, DrawOrder(ids.get(beside), in_front))
                    for frame, beside, in_front in order_keys.get(layer.name, ())
                )
            },
        )
        for layer in document.layers
    )
    return replace(document, layers=layers)


def order(document, frame):
    return "".join(each.name[0] for each in layers_in_draw_order(document, frame))


def test_a_layer_lies_in_front_of_another_one_from_a_frame_on():
    document = stack(a=[(8, "c", True), (20, None, True)], c=[(30, "a", False)])
    assert order(document, 0) == order(document, 7.9) == "labc"
    assert order(document, 8) == order(document, 19) == "lbca"
    assert order(document, 20) == "labc"
    assert order(document, 30) == "lcab"
    # What is beside something that is moved itself goes along, and a circle ends somewhere.
    assert order(stack(a=[(0, "c", True)], c=[(9, "layer", False)]), 9) == "calb"
    assert sorted(order(stack(a=[(0, "c", True)], c=[(9, "a", True)]), 9)) == list("abcl")


def test_time_edits_carry_all_of_them_along():
    document = altered(
        EMPTY,
        camera=KEYS,
        channels={
            (TRANSFORM.name, None): (
                TRANSFORM.key(4, Transform()),
                TRANSFORM.key(8, Transform(shift=1j)),
            ),
            (OPACITY.name, None): (OPACITY.key(2, 0.5),),
            (DRAW_ORDER.name, None): (DRAW_ORDER.key(6, DrawOrder(None)),),
        },
    )
    twice = scene_commands.scale_time(2.0)(document)
    layer = twice.layers[0]
    assert [key.frame for key in twice.camera] == [8, 20, 60, 80]
    assert [key.frame for key in layer.keys_of(TRANSFORM)] == [8, 16]
    assert [layer.keys_of(OPACITY)[0].frame, layer.keys_of(DRAW_ORDER)[0].frame] == [4, 12]
    for frame in (3.0, 7.3, 11.0):
        assert_allclose(
            camera_values(twice, 2 * frame), camera_values(document, frame), rtol=0, atol=1e-12
        )


def test_what_cannot_be_is_refused():
    with pytest.raises(LissomError, match="zoom must be from"):
        CAMERA.key(0, Camera(centre=0j, zoom=0.0))
    with pytest.raises(LissomError, match="zoom must be from"):
        CAMERA.key(0, Camera(centre=0j, zoom=float("nan")))
    with pytest.raises(LissomError, match="the keys at frames 10 and 4 are out of order"):
        with_camera([KEYS[1], KEYS[0]])
    with pytest.raises(LissomError, match="key at frame 40 lies outside"):
        altered(EMPTY, frames=FrameRange(0, 39), camera=KEYS)
    with pytest.raises(LissomError, match=says(KEY_OUTSIDE, frame=40)):
        scene_commands.set_frames(FrameRange(0, 39))(with_camera())
    with pytest.raises(LissomError, match="in front of itself"):
        altered(EMPTY, channels={(DRAW_ORDER.name, None): (DRAW_ORDER.key(0, DrawOrder(0)),)})
    with pytest.raises(LissomError, match=says(NO_LAYER, identity=7)):
        altered(EMPTY, channels={(DRAW_ORDER.name, None): (DRAW_ORDER.key(0, DrawOrder(7)),)})
    with pytest.raises(LissomError, match="from 0 to 1"):
        altered(EMPTY, channels={(OPACITY.name, None): (OPACITY.key(0, 1.5),)})
    with pytest.raises(LissomError, match="within"):
        TRANSFORM.key(0, Transform(shift=complex(0, float("inf"))))


def test_a_layer_that_is_removed_leaves_none_that_lies_beside_it():
    document = stack(a=[(8, "c", True)])
    gone = next(each.id for each in document.layers if each.name == "c")
    left = layer_commands.remove_layer(gone)(document)
    assert order(left, 9) == "lab"


def stacked(places=None, **groups):
    """Layers from back to front, of which "stripe" and "dots" are clipped by the body."""
    drawn = {
        "wall": ("", False),
        "ball": ("", False),
        "body": ("trunk", False),
        "stripe": ("trunk", True),
        "dots": ("trunk", True),
        "arm": ("", False),
        "glove": ("", True),
    }
    document = replace(EMPTY, groups=tuple(Group(name=n, **g) for n, g in groups.items()))
    ids = {name: number for number, name in enumerate(drawn)}
    layers = []
    for name, (group, clipped) in drawn.items():
        placed = (places or {}).get(name)
        order_keys = (DRAW_ORDER.key(6, DrawOrder(ids[placed[0]], placed[1])),) if placed else ()
        layers.append(
            replace(
                EMPTY.layers[0],
                id=ids[name],
                name=name,
                group=group if groups else "",
                clipped=clipped,
                channels={(DRAW_ORDER.name, None): order_keys},
            )
        )
    return replace(document, layers=tuple(layers))


@pytest.mark.parametrize(
    ("places", "expected"),
    [
        ({"ball": ("body", True)}, "wall body stripe dots ball arm glove"),
        ({"ball": ("stripe", True)}, "wall body stripe dots ball arm glove"),
        ({"ball": ("dots", False)}, "wall ball body stripe dots arm glove"),
        ({"body": ("arm", True)}, "wall ball arm glove body stripe dots"),
        ({"body": ("wall", False)}, "body stripe dots wall ball arm glove"),
        # What is placed itself goes by itself, and so it does within what it is clipped by.
        ({"body": ("arm", True), "dots": ("wall", True)}, "wall dots ball arm glove body stripe"),
        ({"dots": ("stripe", False)}, "wall ball body dots stripe arm glove"),
        ({"arm": ("ball", False), "ball": ("body", True)}, "wall body stripe dots arm glove ball"),
    ],
)
@pytest.mark.parametrize("groups", [{}, {"trunk": {}}])
def test_nothing_comes_between_what_is_clipped_and_what_clips_it(places, expected, groups):
    document = stacked(places, **groups)
    assert layers_in_draw_order(document, 5) == document.layers
    assert " ".join(each.name for each in layers_in_draw_order(document, 6)) == expected


def test_what_is_clipped_by_a_group_goes_beyond_all_of_it():
    document = stacked({"ball": ("arm", False)}, trunk={})
    clipped = document.with_layer(replace(document.layer(5), clipped=True))
    assert [each.name for each in layers_in_draw_order(clipped, 6)][:2] == ["wall", "ball"]


def test_layers_looked_at_alone_are_clipped_by_nothing_else():
    document = stacked(trunk={"clipped": True})
    alone = without_foreign_clips(document, [3])
    assert not alone.layer(3).clipped
    assert not alone.groups[0].clipped
    assert alone.layer(4).clipped == alone.layer(3).clipped
    assert without_foreign_clips(document, [2, 3]).layer(3).clipped
    assert not without_foreign_clips(document, [2, 3]).groups[0].clipped
    assert without_foreign_clips(document, [each.id for each in document.layers]) is document
