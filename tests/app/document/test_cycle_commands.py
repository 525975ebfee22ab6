"""Commands on what repeats: where it begins and ends, and its repeats made into keys."""

from dataclasses import replace

import numpy as np
import pytest
from documents import altered
from key_rows import row
from messages import says
from numpy.testing import assert_allclose

from app.document import (
    DEPTH,
    DRAW_ORDER,
    VISIBILITY,
    Channel,
    DrawOrder,
    channel_commands as channels,
    pose_channel,
    source_frame,
)
from app.document.channels.cycles import Cycle
from app.document.channels.tracks import Track, TrackKey
from app.document.commands import (
    scene_commands,
)
from app.document.commands.keys import (
    cycle_commands,
    track_commands,
)
from app.document.commands.keys.cycle_commands import TWO_POSES_SHOWN
from app.document.commands.layers import layer_commands
from app.document.keyframe import Handle, Target
from app.document.queries.channel_values.tracks_at import track_at
from app.document.queries.channel_values.values_at import draw_order_key_at
from app.document.queries.clips import clip_of
from app.document.queries.layers.depth import depth_points_at
from app.document.queries.layers.visibility import is_visible
from app.document.settings import FrameRange
from app.errors import LissomError
from app.motion.inbetweens.animation import Animation

POSES = pose_channel(0)


def with_keys(*frames, last=100, **changes):
    """Return a document with keys at some frames; the one at 44 is like that at 20."""
    document = row(6)
    poses = [key.pose for key in document.layers[0].keys]
    poses = dict(zip(sorted({*frames} - {44}), poses, strict=False))
    keys = tuple(
        replace(document.layers[0].keys[0], frame=frame, pose=poses[20 if frame == 44 else frame])
        for frame in frames
    )
    return altered(document, keys=keys, frames=FrameRange(0, last), **changes)


def moved(document, frames):
    animation = Animation(clip_of(document, 0), points=document.layers[0].domain.outline)
    return np.array([animation.positions(frame) for frame in frames])


def frames_of(document):
    return [key.frame for key in document.layers[0].keys]


def test_a_stretch_repeats_and_its_last_key_is_its_first():
    document = with_keys(4, 20, 28, 36, 44, 110, last=120)
    layer = document.layers[0]
    assert cycle_commands.end_of_cycle(layer, 20, 44) == 92
    cycling = cycle_commands.set_cycle(0, 20, 44, 92)(document)
    assert cycling.layers[0].cycles == (Cycle(first=20, last=44, until=92),)
    assert frames_of(cycling) == [4, 20, 28, 36, 110]
    again = cycle_commands.set_cycle(0, 20, 44, 68)(cycling)
    assert again.layers[0].cycles == (Cycle(first=20, last=44, until=68),)
    with pytest.raises(LissomError, match=says(TWO_POSES_SHOWN, first=4, last=28)):
        cycle_commands.set_cycle(0, 4, 28)(document)
    with pytest.raises(LissomError, match="Frames 4 to 15 have no room to repeat before frame 20"):
        cycle_commands.end_of_cycle(layer, 4, 15)
    with pytest.raises(LissomError, match="key at frame 110 lies where frames 20 to 44 repeat"):
        cycle_commands.set_cycle(0, 20, 44)(document)


def test_what_stops_repeating_is_there_once_as_it_was():
    document = with_keys(4, 20, 28, 36, 44)
    cycling = cycle_commands.set_cycle(0, 20, 44)(document)
    stopped = cycle_commands.delete_cycle(0, 20)(cycling)
    assert not stopped.layers[0].cycles
    assert frames_of(stopped) == frames_of(document)
    layer = stopped.layers[0]
    assert layer.key(44).pose is layer.key(20).pose
    with pytest.raises(LissomError, match="No cycle of 'layer' begins at frame 20"):
        cycle_commands.delete_cycle(0, 20)(stopped)


@pytest.mark.parametrize("loop", [False, True])
def test_repeats_made_into_keys_move_as_before(loop):
    document = cycle_commands.set_cycle(0, 20, 44, 92)(with_keys(4, 20, 28, 36, 44, 110, last=120))
    document = altered(document, loop=loop)
    keyed = cycle_commands.bake_cycle(0, 20, 120)(document)
    assert not keyed.layers[0].cycles
    assert frames_of(keyed) == [4, 20, 28, 36, 44, 52, 60, 68, 76, 84, 92, 110]
    # Only beside 20 and 92 the motion is another one.
    inside = [28, 31, 36, 43, 44, 50, 60, 66, 68, 75, 84]
    assert_allclose(moved(keyed, inside), moved(document, inside), rtol=0, atol=1e-9)
    assert np.abs(moved(keyed, [24]) - moved(document, [24])).max() > 1e-3


def test_less_than_a_whole_repeat_still_repeats():
    document = cycle_commands.set_cycle(0, 20, 44)(with_keys(20, 28, 36, 44, last=100))
    keyed = cycle_commands.bake_cycle(0, 20, 100)(document)
    assert frames_of(keyed) == [20, 28, 36, 44, 52, 60, 68, 76, 84]
    assert keyed.layers[0].cycles == (Cycle(first=68, last=92),)
    inside = range(28, 101, 3)
    assert_allclose(moved(keyed, inside), moved(document, inside), rtol=0, atol=1e-9)


def with_handle(document, front):
    handle = Handle(id=0, name="tail", position=60 + 45j)

    def keyed(key):
        pose = replace(key.pose, targets={0: Target(position=60 + 45j)})
        return replace(key, pose=pose)

    keys = tuple(map(keyed, document.layers[0].keys))
    depth = {(DEPTH.name, 0): (DEPTH.key(front, 1.0),)}
    return altered(document, handles=(handle,), next_handle=1, keys=keys, channels=depth)


def test_tracks_what_is_in_front_and_visibility_are_made_into_keys():
    document = with_handle(cycle_commands.set_cycle(0, 20, 44)(with_keys(20, 28, 36, last=92)), 28)
    wag = Track(
        handles=(0,),
        keys=(
            TrackKey(frame=24, place=0j),
            TrackKey(frame=30, place=4 + 3j),
            TrackKey(frame=38, place=0j),
        ),
    )
    document = altered(
        document,
        tracks=(wag,),
        channels={
            **document.layers[0].channels,
            (VISIBILITY.name, None): (
                VISIBILITY.key(0, value=True),
                VISIBILITY.key(30, value=False),
            ),
        },
    )
    keyed = cycle_commands.bake_cycle(0, 20, 92)(document)
    before, after = clip_of(document, 0), clip_of(keyed, 0)
    for frame in range(20, 93):
        places = [
            track_at(clip.layer.tracks[0], clip, frame) or (0j, 0.0) for clip in (before, after)
        ]
        assert abs(places[0][0] - places[1][0]) < 1e-12
        assert depth_points_at(before, frame) == depth_points_at(after, frame)
        shown = [is_visible(each, each.layers[0], frame) for each in (document, keyed)]
        assert shown[0] == shown[1]
    key = track_commands.put_track_key(0, 0, 24, 1 + 0j)
    with pytest.raises(LissomError, match="track of 'tail' covers only a part of frames 20 to 44"):
        cycle_commands.bake_cycle(0, 20, 92)(key(document))
    ends = dict(zip((24, 30, 38), (20, 30, 44), strict=True))
    whole = replace(wag, keys=tuple(replace(key, frame=ends[key.frame]) for key in wag.keys))
    document = altered(document, tracks=(whole,))
    keyed = cycle_commands.bake_cycle(0, 20, 92)(document)
    before, after = clip_of(document, 0), clip_of(keyed, 0)
    for frame in range(30, 79):
        one, other = (track_at(clip.layer.tracks[0], clip, frame) for clip in (before, after))
        assert abs(one.place - other.place) < 1e-12


def test_cycles_go_with_all_of_their_keys_in_time():
    document = cycle_commands.set_cycle(0, 20, 44, 68)(with_keys(20, 28, 36, 44, 90))
    later = channels.move_keys({POSES: {20, 28, 36}}, 8)(document).layers[0]
    assert later.cycles == (Cycle(first=28, last=52, until=76),)
    # Moved alone, a key is another part of every repeat.
    alone = channels.move_keys({POSES: {28}}, 3)(document).layers[0]
    assert alone.cycles == document.layers[0].cycles
    with pytest.raises(LissomError, match="key at frame 46 lies where frames 20 to 44 repeat"):
        channels.move_keys({POSES: {36}}, 10)(document)
    slower = channels.scale_keys({POSES: {20, 28, 36}}, 1.25)(document).layers[0]
    assert slower.cycles == (Cycle(first=20, last=50, until=80),)
    twice = scene_commands.scale_time(2.0)(document).layers[0]
    assert twice.cycles == (Cycle(first=40, last=88, until=136),)
    assert not channels.delete_keys({POSES: {20, 28, 36}})(document).layers[0].cycles
    assert channels.delete_keys({POSES: {28, 90}})(document).layers[0].cycles
    with pytest.raises(LissomError, match="frame 68"):
        scene_commands.set_frames(FrameRange(0, 60))(channels.delete_keys({POSES: {90}})(document))


def test_what_a_frame_shows_is_keyed_where_it_repeats():
    layer = cycle_commands.set_cycle(0, 20, 44, 68)(with_keys(20, 28, 36, 44, 68)).layers[0]
    assert [layer.source_of(frame) for frame in (4, 20, 43, 44, 50, 67, 68, 80)] == [
        *(4, 20, 43, 20, 26, 43, 68, 80)
    ]


def deleted(document, kind, frame):
    """Return the document without the key that takes effect at a frame, in repeats too."""
    channel = Channel(kind, 0)
    return channels.delete_keys({channel: {source_frame(document, channel, frame)}})(document)


def switched(document, frame, *, to):
    if to is None:
        return deleted(document, VISIBILITY, frame)
    return layer_commands.key_visibility(0, frame, visible=to)(document)


def placed(document, frame, *, to):
    if to is None:
        return deleted(document, DRAW_ORDER, frame)
    return channels.set_key(Channel(DRAW_ORDER, 0), frame, DrawOrder(None, to))(document)


def is_in_front(document, layer, frame):
    key = draw_order_key_at(document, layer, frame)
    return key is None or key.value.in_front


@pytest.mark.parametrize(
    ("change", "is_on"), [(switched, is_visible), (placed, is_in_front)], ids=["seen", "order"]
)
def test_changes_in_one_repeat_are_made_in_all(change, is_on):
    document = with_keys(0, 20, 28, 36, 44, 80, last=100)
    document = cycle_commands.set_cycle(0, 20, 44, 68)(document)

    def states(document, frames):
        return [is_on(document, document.layers[0], frame) for frame in frames]

    changed = change(change(document, 30, to=False), 40, to=True)
    assert states(changed, (29, 30, 53, 54, 64)) == [True, False, True, False, True]
    earlier = change(changed, 48, to=False)
    assert states(earlier, (23, 24, 47, 48, 64, 68)) == [True, False, True, False, True, True]
    assert states(change(earlier, 48, to=None), (24, 48)) == [True, True]
    # Beside the repeats, and at the frame where they end, a change is made where it is asked for.
    for frame in (10, 68, 90):
        beside = change(changed, frame, to=False)
        assert not is_on(beside, beside.layers[0], frame)
        assert states(beside, (40, 64)) == [True, True]


def test_a_repeat_keeps_a_change_of_its_own_until_it_is_edited():
    switches = tuple(VISIBILITY.key(at, value=at % 4 == 0) for at in (0, 30, 40, 50))
    document = cycle_commands.set_cycle(0, 20, 44, 68)(with_keys(0, 20, 28, 36, 44, 80))
    document = switched(
        altered(document, channels={(VISIBILITY.name, None): switches}), 50, to=None
    )
    assert document.layers[0].keys_of(VISIBILITY) == switches[:3]


def test_cycle_is_refused_in_words_over_another_cycle():
    document = with_keys(0, 10, 15, last=60)
    layer = cycle_commands.set_cycle(0, 10, 20, 40)(document).layers[0]
    with pytest.raises(LissomError, match="they overlap a cycle, frames 10 to 20"):
        cycle_commands.end_of_cycle(layer, 0, 15)
