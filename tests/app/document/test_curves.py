"""Curves of channels and their tangents, against finite differences of the motion itself."""

from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, disc_document
from numpy.testing import assert_allclose

from app.document import (
    CAMERA,
    DEPTH,
    HOLD,
    LINEAR,
    OPACITY,
    PRESETS,
    SLIDER,
    TINT,
    TRANSFORM,
    VISIBILITY,
    Camera,
    Channel,
    Easing,
    Keyframe,
    LibraryPose,
    Quantity,
    Slider,
    SliderPose,
    TangentHandle,
    TangentMode,
    Track,
    TrackKey,
    Transform,
    channel_commands,
    channels_in,
    curve_commands,
    curves_of,
    find_tangent_handle,
    handle_commands,
    keys_in,
    pose_channel,
    sample_curves,
    value_at,
    with_tangent_handle,
)
from app.document.commands.keys.stored_keys import put_keys
from app.document.queries.channel_values.curves import FORMS
from app.document.settings import FrameRange
from app.storage.project.channel_codecs import LAYER_KEYS

MOVED, SHOTS = Channel(TRANSFORM, 0), Channel(CAMERA)
NEAR = 1e-4  # frames beside a key, for slopes
EASINGS = [LINEAR, Easing((0.3, 0.1, 0.6, 0.7)), PRESETS["in"], PRESETS["in-out"]]


def scene(mode=TangentMode.SMOOTH, easing=LINEAR, *, loop=False):
    """A disc with four transform keys, a camera and three equal poses."""
    document = disc_document()
    (layer,) = document.layers
    pose = layer.keys[0].pose
    values = (
        (0, Transform(0j)),
        (8, Transform(40 + 10j, 0.5, 2.0)),
        (20, Transform(30 - 20j, -0.4, 0.5)),
        (32, Transform(0j)),
    )
    keys = tuple(
        TRANSFORM.key(frame, value, easing=easing, tangent_mode=mode) for frame, value in values
    )
    poses = tuple(Keyframe(frame=frame, pose=pose, easing=easing) for frame in (0, 12, 32))
    layer = replace(layer, keys=poses, channels={MOVED.id: keys})
    camera = (CAMERA.key(0, Camera(100j)), CAMERA.key(32, Camera(50 + 20j, 4.0, 1.0)))
    document = replace(document.with_layer(layer), frames=FrameRange(0, 32), camera=camera)
    return replace(document, loop=loop)


def slope_at(document, curve, frame):
    """Return the slope of a curve after a frame, by a difference of second order."""
    times = (frame, frame + NEAR, frame + 2 * NEAR)
    here, near, far = sample_curves(document, curve.channel, times)[curve]
    return (4 * near - far - 3 * here) / (2 * NEAR)


@pytest.mark.parametrize("loop", [False, True])
@pytest.mark.parametrize("mode", [TangentMode.SMOOTH, TangentMode.CORNER, TangentMode.STOP])
@pytest.mark.parametrize("easing", EASINGS)
def test_handle_lies_on_the_tangent_of_the_motion(mode, easing, loop):
    document = scene(mode, easing, loop=loop)
    for channel in (MOVED, pose_channel(0)):
        keys = keys_in(document, channel)
        for curve in curves_of(document, channel):
            for index, key in enumerate(keys[:-1]):
                handle = find_tangent_handle(document, curve, index, 1)
                expected = slope_at(document, curve, key.frame)
                assert handle.frames > 0
                assert_allclose(
                    handle.change / handle.frames, expected, rtol=2e-3, atol=2e-2, err_msg=str(key)
                )


def test_straight_segment_is_the_bezier_curve_of_its_handles():
    document = scene(TangentMode.CORNER, Easing((0.3, 0.1, 0.6, 0.7)))
    x = curves_of(document, MOVED)[0]
    (one, other), ends = (0.0, 8.0), (0.0, 40.0)
    leaving = find_tangent_handle(document, x, 0, 1)
    reaching = find_tangent_handle(document, x, 1, 0)
    t = np.linspace(0, 1, 9)
    blend = np.array([(1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3])
    times = np.array([one, one + leaving.frames, other - reaching.frames, other]) @ blend
    numbers = np.array([ends[0], leaving.change, ends[1] + reaching.change, ends[1]]) @ blend
    assert_allclose(sample_curves(document, MOVED, tuple(times))[x], numbers, atol=1e-9)


@pytest.mark.parametrize("side", [0, 1])
@pytest.mark.parametrize("easing", EASINGS)
def test_dragged_handle_of_a_smooth_key_turns_the_motion_on_both_sides(easing, side):
    document = scene(easing=easing)
    for curve in curves_of(document, MOVED):
        wanted = TangentHandle(3.0, 6.0 if side else -6.0)
        changed = with_tangent_handle(document, curve, 1, side, wanted)
        keys = channel_commands.with_changed_keys(document, MOVED, changed)
        turned = put_keys(document, MOVED, keys)
        for each in (0, 1):
            handle = find_tangent_handle(turned, curve, 1, each)
            assert_allclose(handle.change / handle.frames, 2.0 if each else -2.0, rtol=1e-9)
        assert_allclose(slope_at(turned, curve, 8), 2.0, rtol=1e-3)
        # The other components go on as they did, as far as the easing allows.
        if easing == LINEAR:
            others = [each for each in curves_of(document, MOVED) if each != curve]
            for other in others:
                assert_allclose(slope_at(turned, other, 8), slope_at(document, other, 8), atol=1e-2)


def test_dragged_handle_of_a_corner_is_the_control_point_of_its_easing():
    document = scene(TangentMode.CORNER)
    x = curves_of(document, MOVED)[0]
    ((frame, key),) = with_tangent_handle(document, x, 0, 1, TangentHandle(4.0, 10.0)).items()
    assert frame == 0
    assert key.easing.curve[:2] == (0.5, 0.25)
    beyond = with_tangent_handle(document, x, 0, 1, TangentHandle(99.0, -10.0))
    assert beyond[0].easing.curve[:2] == (1.0, 0.0)


def test_closed_loop_keeps_one_velocity_at_its_ends():
    document = scene(loop=True)
    x = curves_of(document, MOVED)[0]
    changed = with_tangent_handle(document, x, 0, 1, TangentHandle(2.0, 8.0))
    assert set(changed) == {0, 32}
    keys = channel_commands.with_changed_keys(document, MOVED, changed)
    turned = put_keys(document, MOVED, keys)
    assert_allclose(slope_at(turned, x, 0), 4.0, rtol=1e-3)
    before = find_tangent_handle(turned, x, 3, 0)
    assert_allclose(-before.change / before.frames, 4.0, rtol=1e-9)


def test_no_handle_beside_a_hold():
    document = scene(easing=HOLD)
    for curve in curves_of(document, MOVED):
        assert find_tangent_handle(document, curve, 1, 1) is None
        assert not with_tangent_handle(document, curve, 1, 1, TangentHandle(1.0, 1.0))


def test_numbers_are_read_and_set_in_the_units_of_a_person():
    document = scene()
    key = keys_in(document, MOVED)[1]
    numbers = {each.label: each.number_at_key(document, key) for each in curves_of(document, MOVED)}
    assert_allclose(
        [numbers[each] for each in ("X", "Y", "Turn", "Scale")], (40, 10, 28.648, 200), 1e-4
    )
    for curve in curves_of(document, MOVED):
        changed = curve.with_number(key, 70.0)
        assert_allclose(curve.number_at_key(document, changed), 70.0)
        others = [each for each in curves_of(document, MOVED) if each != curve]
        assert all(each.number_of(changed.value) == each.number_of(key.value) for each in others)
        # Beyond its limits a number stops there.
        TRANSFORM.check(curve.with_number(key, 1e12).value)


def test_curve_of_poses_counts_them():
    document = scene(easing=PRESETS["in-out"])
    (curve,) = curves_of(document, pose_channel(0))
    found = sample_curves(document, pose_channel(0), (0.0, 6.0, 12.0, 22.0, 32.0))[curve]
    assert_allclose(found, (1.0, 1.5, 2.0, 2.5, 3.0), atol=1e-9)
    key = document.layers[0].keys[1]
    assert curve.with_number(key, 9.0) is key


@pytest.mark.parametrize(
    ("kind", "names"), [(OPACITY, ["Opacity"]), (TINT, ["Red", "Green", "Blue"])]
)
def test_each_number_of_a_channel_has_a_name(kind, names):
    channel = Channel(kind, 0)
    document = channel_commands.set_key(channel, 4, kind.default)(scene())
    assert [each.label for each in curves_of(document, channel)] == names


def test_own_velocities_scale_with_time_and_come_back_from_files():
    document = scene()
    x = curves_of(document, MOVED)[0]
    changed = with_tangent_handle(document, x, 1, 1, TangentHandle(3.0, 6.0))
    document = put_keys(
        document, MOVED, channel_commands.with_changed_keys(document, MOVED, changed)
    )
    keys = document.layers[0].channels[MOVED.id]
    codec = LAYER_KEYS["transform"]
    assert codec.read(codec.write(keys), "") == keys
    slower = channel_commands.scale_keys({MOVED: {0, 8, 20, 32}}, 2.0)(document)
    for frame in (3, 8, 13):
        assert_allclose(
            value_at(slower, MOVED, 2 * frame).shift, value_at(document, MOVED, frame).shift
        )


def test_each_curve_moves_its_own_number_only_and_stops_at_its_limits():
    handle, up = 0, Channel(SLIDER, 0, "nod")
    document = handle_commands.add_handle(0, CENTRE)(scene())
    layer = document.layers[0]
    library = tuple(LibraryPose(name=name, pose=layer.keys[0].pose) for name in "ab")
    poses = tuple(SliderPose(at=complex(at), pose=name) for at, name in enumerate("ab"))
    track = Track(
        handles=(handle,),
        keys_rotation=True,
        keys=(TrackKey(frame=2, place=3 + 4j, turn=0.5), TrackKey(frame=9, place=1j)),
    )
    layer = replace(
        layer, tracks=(track,), library=library, sliders=(Slider(name="nod", poses=poses),)
    )
    document = document.with_layer(layer)
    own = (Channel(OPACITY, 0), Channel(TINT, 0), Channel(DEPTH, 0, handle), Channel(VISIBILITY, 0))
    for channel in (*own, up):
        value = 0.25 if channel.kind in (DEPTH, SLIDER) else channel.kind.default
        document = channel_commands.set_key(channel, 2, value)(document)
    seen = 0
    for channel in channels_in(document):
        for curve in curves_of(document, channel):
            frame = keys_in(document, channel)[0].frame
            for change in (-0.5, -1e12, 1e12):
                changes = {curve.unit: change}
                command = curve_commands.move_points({}, [(curve, frame)], 0, changes)
                moved = command(document)
                numbers = {
                    each: (
                        each.number_at_key(document, keys_in(document, channel)[0]),
                        each.number_at_key(moved, keys_in(moved, channel)[0]),
                    )
                    for each in curves_of(document, channel)
                }
                before, after = numbers.pop(curve)
                low, high = (s * FORMS[curve.field.quantity].scale for s in curve.field.limits)
                wanted = before if curve.is_timing else min(max(before + change, low), high)
                is_switched = curve.field.quantity is Quantity.FLAG
                assert_allclose(after, wanted >= 0.5 if is_switched else wanted, rtol=1e-9)
                for one, other in numbers.values():
                    assert_allclose(one, other)
                seen += 1
    assert seen == 3 * (1 + 4 + 3 + 1 + 3 + 1 + 1 + 1 + 4)
