"""Keys of the camera and of opacity, as they are made, moved and deleted."""

from dataclasses import replace

import pytest
from documents import altered, disc_document

from app.document import (
    HOLD,
    CameraKey,
    FrameRange,
    camera_at,
    filming_commands as filming,
    opacity_at,
)
from app.errors import LissomError

EMPTY = replace(disc_document(), frames=FrameRange(0, 48))
KEY = CameraKey(frame=10, centre=5j, zoom=2.0, easing=HOLD)


def test_the_camera_is_keyed_in_order_and_the_animation_grows_for_it():
    document = filming.key_camera(replace(KEY, frame=60))(filming.key_camera(KEY)(EMPTY))
    assert [key.frame for key in document.camera] == [10, 60]
    assert document.frames == FrameRange(0, 60)
    # What takes a key's place keeps its way on.
    again = filming.key_camera(CameraKey(frame=10, centre=1j))(document)
    assert (again.camera[0].centre, again.camera[0].easing) == (1j, HOLD)
    assert filming.key_camera(again.camera[0])(again) is again


def test_a_camera_key_is_moved_and_deleted():
    document = filming.key_camera(replace(KEY, frame=20))(filming.key_camera(KEY)(EMPTY))
    moved = filming.move_camera_key(10, 30)(document)
    assert [key.frame for key in moved.camera] == [20, 30]
    with pytest.raises(LissomError, match="Two keys would be at frame 20"):
        filming.move_camera_key(10, 20)(document)
    with pytest.raises(LissomError, match="no key at frame 7"):
        filming.delete_camera_key(7)(document)
    gone = filming.delete_camera_key(20)(filming.delete_camera_key(10)(document))
    assert camera_at(gone, 10) is None


def test_opacity_is_keyed_and_the_last_key_leaves_what_it_said():
    faded = filming.key_opacity(0, 10, 0.5)(filming.key_opacity(0, 0, 1.0)(EMPTY))
    assert opacity_at(faded, faded.figures[0], 5) == pytest.approx(0.75)
    assert filming.key_opacity(0, 10, 0.5)(faded) is faded
    left = filming.delete_opacity_key(0, 0)(faded)
    none = filming.delete_opacity_key(0, 10)(left)
    assert (none.figures[0].opacities, none.figures[0].opacity) == ((), 0.5)
    with pytest.raises(LissomError, match="no key at frame 3"):
        filming.delete_opacity_key(0, 3)(altered(faded))
