"""Keys of the camera and of opacity, as they are made, moved and deleted."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document
from messages import says

from app.document import (
    CAMERA,
    DRAW_ORDER,
    HOLD,
    OPACITY,
    TRANSFORM,
    Camera,
    Channel,
    DrawOrder,
    FrameRange,
    Transform,
    camera_at,
    channel_commands as channels,
    layer_commands,
    layers_in_draw_order,
    opacity_at,
    transform_at,
)
from app.document.layer import NO_KEY
from app.errors import LissomError

EMPTY = replace(disc_document(), frames=FrameRange(0, 48))
KEY = CAMERA.key(10, Camera(centre=5j, zoom=2.0), easing=HOLD)
KEYED = channels.insert_keys({Channel(CAMERA): [KEY]})(EMPTY)


def test_the_camera_is_keyed_in_order_and_the_animation_grows_for_it():
    document = channels.set_key(Channel(CAMERA), 60, KEY.value)(KEYED)
    assert [key.frame for key in document.camera] == [10, 60]
    assert document.frames == FrameRange(0, 60)
    # What takes a key's place keeps its way on.
    again = channels.set_key(Channel(CAMERA), 10, Camera(centre=1j))(document)
    assert (again.camera[0].value.centre, again.camera[0].easing) == (1j, HOLD)
    assert channels.set_key(Channel(CAMERA), 10, Camera(centre=1j))(again) is again


def test_a_camera_key_is_moved_and_deleted():
    document = channels.set_key(Channel(CAMERA), 20, KEY.value)(KEYED)
    moved = channels.move_keys({Channel(CAMERA): {10}}, 20)(document)
    assert [key.frame for key in moved.camera] == [20, 30]
    with pytest.raises(LissomError, match="Two keys would be at frame 20"):
        channels.move_keys({Channel(CAMERA): {10}}, 10)(document)
    with pytest.raises(LissomError, match=says(NO_KEY, frame=7)):
        channels.delete_keys({Channel(CAMERA): {7}})(document)
    gone = channels.delete_keys({Channel(CAMERA): {20}})(
        channels.delete_keys({Channel(CAMERA): {10}})(document)
    )
    assert camera_at(gone, 10) is None


def test_opacity_is_keyed_and_the_last_key_leaves_what_it_said():
    faded = channels.set_key(Channel(OPACITY, 0), 10, 0.5)(
        channels.set_key(Channel(OPACITY, 0), 0, 1.0)(EMPTY)
    )
    assert opacity_at(faded, faded.layers[0], 5) == pytest.approx(0.75)
    assert channels.set_key(Channel(OPACITY, 0), 10, 0.5)(faded) is faded
    left = channels.delete_keys({Channel(OPACITY, 0): {0}})(faded)
    none = channels.delete_keys({Channel(OPACITY, 0): {10}})(left)
    assert (none.layers[0].keys_of(OPACITY), none.layers[0].opacity) == ((), 0.5)
    with pytest.raises(LissomError, match=says(NO_KEY, frame=3)):
        channels.delete_keys({Channel(OPACITY, 0): {3}})(altered(faded))


def test_a_layer_is_moved_from_key_to_key():
    document = channels.set_key(Channel(TRANSFORM, 0), 24, Transform(30 + 10j, 0.5))(
        channels.set_key(Channel(TRANSFORM, 0), 0, Transform(0j, 0.0))(EMPTY)
    )
    layer = document.layer(0)
    at = transform_at(document, layer, 24)
    assert abs(at.apply(np.array([layer.pivot]))[0] - layer.pivot - 30 - 10j) < 1e-12
    assert abs(at.factor - np.exp(0.5j)) < 1e-12
    # Midway between two keys at rest.
    half = transform_at(document, layer, 12).apply(np.array([layer.pivot]))[0]
    assert abs(half - layer.pivot - 15 - 5j) < 1e-9
    changed = channels.set_key(Channel(TRANSFORM, 0), 24, Transform(8j, 0.5))(document)
    assert [key.value.shift for key in changed.layer(0).keys_of(TRANSFORM)] == [0, 8j]
    assert channels.set_key(Channel(TRANSFORM, 0), 24, Transform(8j, 0.5))(changed) is changed
    gone = channels.delete_keys({Channel(TRANSFORM, 0): {24}})(
        channels.delete_keys({Channel(TRANSFORM, 0): {0}})(changed)
    )
    assert gone.layer(0).keys_of(TRANSFORM) == ()


def test_a_layer_is_painted_beside_another_one_from_a_frame_on():
    document = layer_commands.duplicate_layer(0)(layer_commands.duplicate_layer(0)(EMPTY))
    assert [each.id for each in layers_in_draw_order(document, 0)] == [0, 2, 1]
    placed = channels.set_key(Channel(DRAW_ORDER, 0), 12, DrawOrder(1, in_front=True))(document)
    assert [each.id for each in layers_in_draw_order(placed, 11)] == [0, 2, 1]
    assert [each.id for each in layers_in_draw_order(placed, 12)] == [2, 1, 0]
    behind = channels.set_key(Channel(DRAW_ORDER, 0), 12, DrawOrder(1, in_front=False))(placed)
    assert [each.id for each in layers_in_draw_order(behind, 12)] == [2, 0, 1]
    assert (
        channels.delete_keys({Channel(DRAW_ORDER, 0): {12}})(behind).layer(0).keys_of(DRAW_ORDER)
        == ()
    )
    with pytest.raises(LissomError):
        channels.set_key(Channel(DRAW_ORDER, 0), 12, DrawOrder(0))(document)


def test_layer_placed_beside_what_it_clips_stays_there():
    document = layer_commands.duplicate_layer(0)(EMPTY)
    base, cut = (each.id for each in document.layers)
    clipped = layer_commands.set_clipped(cut, clipped=True)(document)
    placed = channels.set_key(Channel(DRAW_ORDER, base), 12, DrawOrder(cut, in_front=True))(clipped)
    assert layers_in_draw_order(placed, 12) == placed.layers
