"""Keys of the camera and of opacity, as they are made, moved and deleted."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered, disc_document
from messages import says

from app.document import (
    HOLD,
    CameraKey,
    DrawOrderKey,
    FrameRange,
    camera_at,
    filming_commands as channels,
    layer_commands,
    layers_in_draw_order,
    opacity_at,
    transform_at,
)
from app.document.layer import NO_KEY
from app.errors import LissomError

EMPTY = replace(disc_document(), frames=FrameRange(0, 48))
KEY = CameraKey(frame=10, centre=5j, zoom=2.0, easing=HOLD)


def test_the_camera_is_keyed_in_order_and_the_animation_grows_for_it():
    document = channels.key_camera(replace(KEY, frame=60))(channels.key_camera(KEY)(EMPTY))
    assert [key.frame for key in document.camera] == [10, 60]
    assert document.frames == FrameRange(0, 60)
    # What takes a key's place keeps its way on.
    again = channels.key_camera(CameraKey(frame=10, centre=1j))(document)
    assert (again.camera[0].centre, again.camera[0].easing) == (1j, HOLD)
    assert channels.key_camera(again.camera[0])(again) is again


def test_a_camera_key_is_moved_and_deleted():
    document = channels.key_camera(replace(KEY, frame=20))(channels.key_camera(KEY)(EMPTY))
    moved = channels.move_camera_key(10, 30)(document)
    assert [key.frame for key in moved.camera] == [20, 30]
    with pytest.raises(LissomError, match="Two keys would be at frame 20"):
        channels.move_camera_key(10, 20)(document)
    with pytest.raises(LissomError, match=says(NO_KEY, frame=7)):
        channels.delete_camera_key(7)(document)
    gone = channels.delete_camera_key(20)(channels.delete_camera_key(10)(document))
    assert camera_at(gone, 10) is None


def test_opacity_is_keyed_and_the_last_key_leaves_what_it_said():
    faded = channels.key_opacity(0, 10, 0.5)(channels.key_opacity(0, 0, 1.0)(EMPTY))
    assert opacity_at(faded, faded.layers[0], 5) == pytest.approx(0.75)
    assert channels.key_opacity(0, 10, 0.5)(faded) is faded
    left = channels.delete_opacity_key(0, 0)(faded)
    none = channels.delete_opacity_key(0, 10)(left)
    assert (none.layers[0].opacity_keys, none.layers[0].opacity) == ((), 0.5)
    with pytest.raises(LissomError, match=says(NO_KEY, frame=3)):
        channels.delete_opacity_key(0, 3)(altered(faded))


def test_a_layer_is_moved_from_key_to_key():
    document = channels.key_movement(0, 24, 30 + 10j, 0.5)(
        channels.key_movement(0, 0, 0j, 0.0)(EMPTY)
    )
    layer = document.layer(0)
    at = transform_at(document, layer, 24)
    assert abs(at.apply(np.array([layer.pivot]))[0] - layer.pivot - 30 - 10j) < 1e-12
    assert abs(at.factor - np.exp(0.5j)) < 1e-12
    # Midway between two keys at rest.
    half = transform_at(document, layer, 12).apply(np.array([layer.pivot]))[0]
    assert abs(half - layer.pivot - 15 - 5j) < 1e-9
    changed = channels.key_movement(0, 24, 8j, 0.5)(document)
    assert [key.shift for key in changed.layer(0).transform_keys] == [0, 8j]
    assert channels.key_movement(0, 24, 8j, 0.5)(changed) is changed
    gone = channels.delete_movement_key(0, 24)(channels.delete_movement_key(0, 0)(changed))
    assert gone.layer(0).transform_keys == ()


def test_a_layer_is_painted_beside_another_one_from_a_frame_on():
    document = layer_commands.duplicate_layer(0)(layer_commands.duplicate_layer(0)(EMPTY))
    assert [each.id for each in layers_in_draw_order(document, 0)] == [0, 2, 1]
    placed = channels.place_at(0, DrawOrderKey(12, 1, in_front=True))(document)
    assert [each.id for each in layers_in_draw_order(placed, 11)] == [0, 2, 1]
    assert [each.id for each in layers_in_draw_order(placed, 12)] == [2, 1, 0]
    behind = channels.place_at(0, DrawOrderKey(12, 1, in_front=False))(placed)
    assert [each.id for each in layers_in_draw_order(behind, 12)] == [2, 0, 1]
    assert channels.unplace_at(0, 12)(behind).layer(0).draw_order_keys == ()
    with pytest.raises(LissomError):
        channels.place_at(0, DrawOrderKey(12, 0))(document)


def test_layer_placed_beside_what_it_clips_stays_there():
    document = layer_commands.duplicate_layer(0)(EMPTY)
    base, cut = (each.id for each in document.layers)
    clipped = layer_commands.set_clipped(cut, clipped=True)(document)
    placed = channels.place_at(base, DrawOrderKey(12, cut, in_front=True))(clipped)
    assert layers_in_draw_order(placed, 12) == placed.layers
