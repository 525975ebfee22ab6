"""Commands on tracks, springs and auto-pins, and what other commands do to them."""

from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, altered, disc_document, random_pose
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    TRACK,
    Channel,
    channel_commands as channels,
    handle_commands,
    key_commands,
    layer_commands,
    pose_channel,
    scene_commands,
    shape_commands,
    track_commands as tracks,
)
from app.document.channels.easing import HOLD, LINEAR, PRESETS, Easing
from app.document.channels.springs import Spring
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.commands.keys.retime import KEYS_COLLIDE, KEYS_MEET
from app.document.commands.scene_commands import KEY_OUTSIDE
from app.document.history.undo_history import History
from app.document.keyframe import Keyframe
from app.document.layer import NO_HANDLE, NO_KEY
from app.document.queries.timeline import changed_ranges, export_frame_range
from app.document.settings import FrameRange
from app.errors import LissomError

OF_TRACK = Channel(TRACK, 0, 0)

NAMES = {"arm.L": -40 + 10j, "arm.R": 35 + 12j, "tail": 5 - 50j}
AXIS = CENTRE.real
SLOW = Easing((0.25, 0.0, 1.0, 1.0))
SPRING = Spring(handle=2, frequency=3.0, damping=0.25)


def row(*frames, handles=(0,), **changes):
    """Return a track whose key at frame t is at t + 2t i."""
    keys = tuple(TrackKey(frame=frame, place=complex(frame, 2 * frame)) for frame in frames)
    return Track(handles=handles, keys=keys, **changes)


def tracked(*made, springs=(), **settings):
    """Return a document of three handles and keys at 0, 20 and 48, with tracks."""
    document = disc_document()
    for name, beside in NAMES.items():
        document = handle_commands.add_handle(0, CENTRE + beside, name=name)(document)
    rng = np.random.default_rng(5)
    keys = tuple(Keyframe(frame=f, pose=random_pose(rng, document)) for f in (0, 20, 48))
    return altered(document, keys=keys, tracks=made, springs=springs, **settings)


def only(document):
    (track,) = document.layers[0].tracks
    return track


def frames(document, handle=0):
    return [key.frame for key in document.layers[0].track_of(handle).keys]


def test_a_handle_is_keyed_by_itself():
    document = tracks.put_track_key(0, 1, 10, 3 + 4j, turn=0.5, easing=PRESETS["in"])(tracked())
    assert only(document) == Track(
        handles=(1,),
        keys=(TrackKey(frame=10, place=3 + 4j, turn=0.5, easing=PRESETS["in"]),),
    )
    later = tracks.put_track_key(0, 1, 20, 5)(document)
    between = tracks.put_track_key(0, 1, 15, 1j)(later)
    # What divides an interval takes its easing; a new last key has none.
    assert [key.easing for key in only(between).keys] == [PRESETS["in"], PRESETS["in"], LINEAR]
    held = channels.set_tangent_mode({Channel(TRACK, 0, 1): {15}}, TangentMode.STOP)(between)
    again = tracks.put_track_key(0, 1, 15, 7)(held)
    assert only(again).keys[1] == replace(only(held).keys[1], place=7)
    assert tracks.put_track_key(0, 1, 10, 9)(again).layers[0].tracks[0].keys[0].turn == 0.5
    assert tracks.put_track_key(0, 1, 15, 7)(again) is again
    planted = tracks.put_track_key(0, 2, 4, 80j, planted=True)(again)
    assert planted.layers[0].track_of(2).is_scene_space


def test_keys_of_a_track_are_moved_about_in_time_as_those_of_poses_are():
    document = tracked(row(4, 10, 16), row(5, handles=(1,)))
    assert frames(channels.move_keys({OF_TRACK: {10, 16}}, 3)(document)) == [4, 13, 19]
    assert frames(channels.copy_keys({OF_TRACK: {4, 10}}, 20)(document)) == [4, 10, 16, 24, 30]
    assert frames(channels.delete_keys({OF_TRACK: {10}})(document)) == [4, 16]
    assert frames(channels.scale_keys({OF_TRACK: {4, 10, 16}}, 1.5)(document)) == [4, 13, 22]
    assert frames(channels.scale_keys({OF_TRACK: {10, 16}}, 0.5, 4)(document)) == [4, 7, 10]
    pasted = channels.insert_keys({OF_TRACK: row(10, 40).keys[1:]})(document)
    assert frames(pasted) == [4, 10, 16, 40]
    for command in (
        channels.move_keys({OF_TRACK: {4}}, 6),
        channels.copy_keys({OF_TRACK: {4}}, 6),
    ):
        with pytest.raises(LissomError, match=KEYS_COLLIDE.format(frame=r"\d+")):
            command(document)
    with pytest.raises(LissomError, match=says(KEYS_MEET, one=4, other=10, frame=4)):
        channels.scale_keys({OF_TRACK: {4, 10, 16}}, 0.01)(document)
    with pytest.raises(LissomError, match=says(NO_KEY, frame=5)):
        channels.move_keys({OF_TRACK: {4, 5}}, 1)(document)
    with pytest.raises(LissomError, match=says(NO_KEY, frame=4)):
        channels.move_keys({Channel(TRACK, 0, 2): {4}}, 1)(document)
    assert channels.move_keys({OF_TRACK: {4}}, 0)(document) is document


def test_a_track_goes_with_its_last_key():
    document = tracked(row(4, 10), row(5, handles=(1,)))
    left = channels.delete_keys({OF_TRACK: {4, 10}})(document)
    assert only(left) == document.layers[0].tracks[1]
    assert tracks.remove_tracks(0, {0, 1})(document).layers[0].tracks == ()


def test_a_track_runs_backwards():
    document = tracked(row(4, 10, 20))
    document = channels.set_easing({OF_TRACK: {4}}, SLOW)(document)
    document = channels.set_easing({OF_TRACK: {10}}, HOLD)(document)
    back = channels.reverse_keys({OF_TRACK: {4, 10, 20}})(document)
    assert [(key.frame, key.place) for key in only(back).keys] == [
        (4, 20 + 40j),
        (14, 10 + 20j),
        (20, 4 + 8j),
    ]
    assert [key.easing for key in only(back).keys] == [HOLD, SLOW.reversed(), LINEAR]
    again = channels.reverse_keys({OF_TRACK: {4, 14, 20}})(back)
    assert only(again) == only(document)


def test_how_time_runs_between_keys_of_a_track_and_how_they_are_passed():
    document = tracked(row(4, 10, 20))
    held = channels.set_tangent_mode({OF_TRACK: {10}}, TangentMode.HOLD)(document)
    assert [key.shown_tangent_mode for key in only(held).keys] == ["through", "hold", "through"]
    stopped = channels.set_tangent_mode({OF_TRACK: {4, 10}}, TangentMode.STOP)(held)
    assert [key.shown_tangent_mode for key in only(stopped).keys] == ["stop", "stop", "through"]
    assert only(stopped).keys[1].easing == LINEAR


def led(*, planted=False):
    """Return a document with a track whose key at frame t is passed at (1, t), but the last."""
    keys = tuple(replace(key, velocity=complex(1, key.frame)) for key in row(4, 10, 20).keys[:2])
    made = row(4, 10, 20, is_scene_space=planted)
    return tracked(replace(made, keys=(*keys, made.keys[2])), mirror=AXIS)


def velocities(document, handle=0):
    return [key.velocity for key in document.layers[0].track_of(handle).keys]


def test_keys_keep_their_velocities_wherever_they_go():
    document = led()
    own = [1 + 4j, 1 + 10j, None]
    assert velocities(channels.move_keys({OF_TRACK: {4, 10, 20}}, 3)(document)) == own
    assert velocities(channels.copy_keys({OF_TRACK: {4, 10}}, 30)(document)) == [*own, *own[:2]]
    assert velocities(tracks.copy_track(0, 0, 2)(document), 2) == own
    assert velocities(tracks.set_delay(0, 0, 5)(document)) == own
    assert velocities(tracks.put_track_key(0, 0, 10, 99)(document)) == own
    assert velocities(handle_commands.move_handle(0, 0, CENTRE)(led(planted=True))) == own
    for planted in (False, True):
        mirrored = tracks.mirror_track(0, 0)(led(planted=planted))
        assert velocities(mirrored, 1) == [-1 + 4j, -1 + 10j, None]
    new = tracks.put_track_key(0, 0, 15, 7j, velocity=2j)(document)
    assert velocities(new) == [*own[:2], 2j, None]


def test_velocities_follow_the_time_that_is_scaled_and_run_backwards():
    document = led()
    assert velocities(channels.scale_keys({OF_TRACK: {4, 10, 20}}, 2)(document)) == [
        0.5 + 2j,
        0.5 + 5j,
        None,
    ]
    assert velocities(channels.scale_keys({OF_TRACK: {10, 20}}, 0.5, 4)(document)) == [
        1 + 4j,
        2 + 20j,
        None,
    ]
    assert velocities(scene_commands.scale_time(0.5)(document)) == [2 + 8j, 2 + 20j, None]
    assert velocities(scene_commands.set_fps(12.0)(document)) == [1 + 4j, 1 + 10j, None]
    back = channels.reverse_keys({OF_TRACK: {4, 10, 20}})(document)
    assert velocities(back) == [None, -1 - 10j, -1 - 4j]
    assert only(channels.reverse_keys({OF_TRACK: {4, 14, 20}})(back)) == only(document)
    # What stays as it is stays the same.
    assert channels.scale_keys({OF_TRACK: {20}}, 3)(document) is document
    assert channels.scale_keys({pose_channel(0): {20}}, 3)(document) is document


def test_who_sets_a_passing_or_an_easing_sets_the_velocity_free():
    document = led()
    for command in (
        channels.set_tangent_mode({OF_TRACK: {10}}, TangentMode.SMOOTH),
        channels.set_tangent_mode({OF_TRACK: {10}}, TangentMode.STOP),
        channels.set_easing({OF_TRACK: {10, 20}}, LINEAR),
        channels.set_easing({OF_TRACK: {10}}, PRESETS["in-out"]),
    ):
        assert velocities(command(document)) == [1 + 4j, None, None]
    assert channels.set_tangent_mode({OF_TRACK: {20}}, TangentMode.SMOOTH)(document) is document


@pytest.mark.parametrize("velocity", [complex(np.nan, 0), complex(0, np.inf), 1e8])
def test_a_velocity_that_is_none_is_refused_in_words(velocity):
    with pytest.raises(LissomError, match="at most 10,000,000 pixels a frame, not"):
        TrackKey(frame=0, place=0, velocity=velocity)


def test_what_a_track_is_like_is_set():
    document = tracked(row(4, 10))
    for command, name, value in (
        (tracks.set_delay(0, 0, 5), "delay", 5),
        (tracks.set_reach(0, 0, 0.25), "reach", 0.25),
        (tracks.set_turning(0, 0, turns=True), "keys_rotation", True),
        (tracks.enable_track(0, 0, enabled=False), "enabled", False),
        (tracks.plant_track(0, 0, [1, 2j], planted=True), "is_scene_space", True),
        (tracks.set_track_handles(0, 0, [2, 0]), "handles", (2, 0)),
    ):
        history = History(document, saved=True)
        history.do(command)
        assert getattr(only(history.document), name) == value
        assert command(history.document) is history.document
        history.undo()
        assert history.document is document
    planted = tracks.plant_track(0, 0, [1, 2j], planted=True)(document)
    assert [key.place for key in only(planted).keys] == [1, 2j]
    passed = tracks.plant_track(0, 0, [1, 2j], [3j, None], planted=True)(document)
    assert velocities(passed) == [3j, None]
    with pytest.raises(LissomError, match="The track has 2 keys, but"):
        tracks.plant_track(0, 0, [1], planted=True)(document)
    with pytest.raises(LissomError, match="at least one handle"):
        tracks.set_track_handles(0, 0, [])(document)
    with pytest.raises(LissomError, match=says(NO_HANDLE, identity=9)):
        tracks.set_track_handles(0, 0, [9])(document)


def test_a_handle_has_one_track():
    document = tracked(row(4, handles=(0, 1)), row(5, handles=(2,)))
    new = row(7, 8, handles=(1, 2))
    layer = tracks.put_track(0, new)(document).layers[0]
    assert layer.tracks == (row(4), new)
    assert layer.track_of(1) is layer.track_of(2)
    # One of the same handles takes the old one's place.
    same = row(9, handles=(0, 1))
    assert tracks.put_track(0, same)(document).layers[0].tracks == (
        same,
        document.layers[0].tracks[1],
    )


def test_a_copied_track_moves_another_handle_alike():
    document = tracked(row(4, 10, handles=(0, 1), delay=3))
    layer = tracks.copy_track(0, 1, 2)(document).layers[0]
    assert layer.tracks == (row(4, 10, handles=(0, 1), delay=3), row(4, 10, handles=(2,), delay=3))
    # To one of its own handles it is that one's alone.
    layer = tracks.copy_track(0, 0, 1)(document).layers[0]
    assert layer.tracks == (row(4, 10, delay=3), row(4, 10, handles=(1,), delay=3))


def reached(layer, frame, handle):
    (place,) = layer.map_of(layer.key(frame).pose)(np.array([layer.handle(handle).position]))
    return complex(place)


def test_a_planted_track_keeps_its_distance_from_what_it_is_of():
    document = tracked(row(2, 19, handles=(0, 1), is_scene_space=True))
    layer = document.layers[0]
    wanted = [
        key.place + reached(layer, at, 1) - reached(layer, at, 0)
        for key, at in zip(layer.tracks[0].keys, (0, 20), strict=True)
    ]
    copied = tracks.copy_track(0, 0, 1)(document).layers[0].track_of(1)
    left = only(handle_commands.remove_handles(0, {0})(document))
    for track in (copied, left):
        assert track.handles == (1,)
        assert_allclose([key.place for key in track.keys], wanted, rtol=0, atol=1e-9)
    assert only(handle_commands.remove_handles(0, {1})(document)).keys == layer.tracks[0].keys
    # So does one whose handle is put elsewhere on the drawing.
    moved = handle_commands.move_handle(0, 0, layer.handle(1).position + 1e-7)(document)
    assert_allclose([key.place for key in only(moved).keys], wanted, rtol=0, atol=1e-5)
    beside = tracked(row(2, 19))
    assert only(handle_commands.move_handle(0, 0, CENTRE)(beside)) == row(2, 19)


@pytest.mark.parametrize("planted", [False, True])
def test_a_mirrored_track_is_that_of_the_other_side(planted):
    document = tracked(row(4, 10, is_scene_space=planted, keys_rotation=True), mirror=AXIS)
    keys = tuple(replace(key, turn=0.1 * key.frame) for key in only(document).keys)
    document = altered(document, tracks=(replace(only(document), keys=keys),))
    layer = tracks.mirror_track(0, 0)(document).layers[0]
    other = layer.track_of(1)
    assert len(layer.tracks) == 2
    assert (other.is_scene_space, other.keys_rotation) == (planted, True)
    assert [key.turn for key in other.keys] == [-key.turn for key in keys]
    places = np.array([key.place for key in keys])
    if planted:
        # Beside its mirror image by as much as the handles are beside each other's.
        places = places - layer.handle(0).position
        found = [key.place - layer.handle(1).position for key in other.keys]
    else:
        found = [key.place for key in other.keys]
    assert_allclose(found, -places.conj(), rtol=0, atol=1e-12)
    back = tracks.mirror_track(0, 1)(
        tracks.remove_tracks(0, {0})(tracks.mirror_track(0, 0)(document))
    )
    assert_allclose(
        [key.place for key in back.layers[0].track_of(0).keys],
        [key.place for key in keys],
        rtol=0,
        atol=1e-12,
    )


def test_a_track_is_mirrored_to_the_handle_on_the_other_side_if_names_tell_nothing():
    document = tracked(row(4, 10, handles=(2,)), mirror=AXIS)
    for beside in (30 + 40j, -29 + 41j, -30 + 38j):
        document = handle_commands.add_handle(0, CENTRE + beside)(document)
    ids = [handle.id for handle in document.layers[0].handles][-3:]
    document = altered(document, tracks=(row(4, 10, handles=(ids[1], ids[2])),))
    layer = tracks.mirror_track(0, ids[1])(document).layers[0]
    assert [track.handles for track in layer.tracks] == [(ids[1], ids[2]), (ids[0],)]
    assert [key.place for key in layer.tracks[1].keys] == [-4 + 8j, -10 + 20j]


def test_a_handle_without_a_partner_does_its_own_mirror_image():
    document = tracked(row(4, handles=(2,)))
    assert only(tracks.mirror_track(0, 2)(document)).keys[0].place == -4 + 8j
    assert only(tracks.mirror_track(0, 2)(document)).handles == (2,)


def test_springs_are_set_and_removed():
    document = tracks.put_spring(0, SPRING)(tracked())
    assert document.layers[0].spring_of(2) == SPRING
    assert tracks.put_spring(0, SPRING)(document) is document
    stiff = replace(SPRING, frequency=5.0)
    assert tracks.put_spring(0, stiff)(document).layers[0].springs == (stiff,)
    assert tracks.remove_springs(0, {2})(document).layers[0].springs == ()
    assert tracks.remove_springs(0, {0})(document) is document
    with pytest.raises(LissomError, match=says(NO_HANDLE, identity=9)):
        tracks.put_spring(0, replace(SPRING, handle=9))(document)


def test_auto_pins_is_switched_for_a_layer_and_for_handles():
    document = tracked()
    assert document.layers[0].has_auto_pins
    loose = shape_commands.set_auto_pins(0, enabled=False)(document)
    assert not loose.layers[0].has_auto_pins
    assert shape_commands.set_auto_pins(0, enabled=False)(loose) is loose
    freed = handle_commands.unpin_handles(0, {0, 2}, free=True)(document)
    assert [handle.is_unpinned for handle in freed.layers[0].handles] == [True, False, True]


def test_a_deleted_handle_takes_its_track_and_spring_along_in_one_step():
    document = tracked(row(4, handles=(0, 1)), row(5, handles=(2,)), springs=(SPRING,))
    history = History(document, saved=True)
    history.do(handle_commands.remove_handles(0, {0, 2}))
    layer = history.document.layers[0]
    assert layer.tracks == (row(4, handles=(1,)),)
    assert layer.springs == ()
    history.undo()
    assert history.document is document
    rooted = tracked(springs=(replace(SPRING, root=1),))
    assert handle_commands.remove_handles(0, {1})(rooted).layers[0].springs == (SPRING,)
    renamed = handle_commands.rename_handle(0, 2, "tuft")(document).layers[0]
    assert (renamed.tracks, renamed.springs) == (document.layers[0].tracks, (SPRING,))


def test_the_animation_grows_for_keys_of_tracks_and_is_not_cut_under_them():
    document = tracked(row(4, 10))
    grown = channels.move_keys({OF_TRACK: {10}}, 60)(document)
    assert grown.frames == FrameRange(0, 70)
    with pytest.raises(LissomError, match=says(KEY_OUTSIDE, frame=70, first=0, last=48)):
        scene_commands.set_frames(FrameRange(0, 48))(grown)
    with pytest.raises(LissomError):
        channels.move_keys({OF_TRACK: {4}}, -5)(document)
    # A delay moves no key.
    assert tracks.set_delay(0, 0, 45)(document).frames == document.frames


def test_tracks_are_stretched_with_the_scene():
    document = tracked(row(4, 10, delay=3), springs=(SPRING,))
    longer = scene_commands.scale_time(2)(document)
    assert frames(longer) == [8, 20]
    assert only(longer).delay == 6
    assert longer.layers[0].springs == (SPRING,)
    with pytest.raises(LissomError, match=says(KEYS_MEET, one=30, other=31)):
        scene_commands.scale_time(0.1)(tracked(row(30, 31)))
    assert only(scene_commands.set_fps(12)(document)) == only(document)


def test_what_does_not_come_round_is_refused_in_a_loop():
    loop = scene_commands.set_loop(loop=True)
    late = tracked(row(4, 10, delay=50))
    with pytest.raises(LissomError, match=r"delayed by 50 frames, longer than the loop of 48"):
        loop(late)
    undamped = tracks.put_spring(0, replace(SPRING, damping=0.0))
    with pytest.raises(LissomError, match="no damping, so its swing never repeats"):
        loop(undamped(tracked()))
    with pytest.raises(LissomError, match="no damping"):
        undamped(loop(tracked()))
    with pytest.raises(LissomError, match="longer than the loop"):
        tracks.set_delay(0, 0, 49)(loop(tracked(row(4))))


def test_a_duplicated_layer_has_tracks_and_springs_of_its_own():
    document = tracked(row(4, 10), springs=(SPRING,))
    document = layer_commands.duplicate_layer(0)(document)
    first, copy = document.layers
    assert (copy.tracks, copy.springs) == (first.tracks, first.springs)
    changed = tracks.set_delay(copy.id, 0, 7)(document)
    assert [layer.tracks[0].delay for layer in changed.layers] == [0, 7]


def test_undo_tells_where_tracks_have_changed():
    document = tracked(row(4, 10, 20, delay=3))

    def changed(command):
        return [span.first for span in changed_ranges(document, command(document))]

    assert changed(tracks.put_track_key(0, 0, 10, 7)) == [13]
    assert changed(channels.move_keys({OF_TRACK: {10}}, 2)) == [13, 15]
    assert changed(tracks.set_delay(0, 0, 5)) == [7, 9, 13, 15, 23, 25]
    assert changed(tracks.set_reach(0, 0, 0.5)) == [7, 13, 23]
    assert changed(tracks.put_track(0, row(46, handles=(1,), delay=9))) == [48]
    assert changed(tracks.remove_tracks(0, {0})) == [7, 13, 23]
    assert changed(scene_commands.set_fps(12)) == []


def test_the_last_frame_of_a_loop_is_exported_where_a_track_has_another_end():
    document = key_commands.match_loop_ends(0)(tracked(row(0, 20, 48), loop=True))
    assert export_frame_range(document) == FrameRange(0, 48)
    for same in (row(0, 20), row(20, 48, delay=4), row(0, 20, 48, enabled=False)):
        assert export_frame_range(altered(document, tracks=(same,))) == FrameRange(0, 47)
    closed = tracks.put_track_key(0, 0, 48, 0)(document)
    assert export_frame_range(closed) == FrameRange(0, 47)
