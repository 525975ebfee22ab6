"""Stretches that repeat: each repeat is the same motion, closed as a loop is."""

from dataclasses import replace
from itertools import cycle as alternate

import numpy as np
import pytest
from documents import altered
from key_rows import jump, prepared, row
from numpy.testing import assert_allclose

from app.document.channels.cycles import Cycle
from app.document.channels.kind import Channel
from app.document.channels.kinds import DEPTH, DRAW_ORDER, OPACITY, POSE, TRANSFORM, VISIBILITY
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import Track, TrackKey
from app.document.channels.values import DrawOrder, Transform
from app.document.commands.keys import (
    channel_commands,
    cycle_commands,
)
from app.document.keyframe import Handle, Target
from app.document.queries.channel_values.values_at import (
    layers_in_draw_order,
    opacity_at,
    transform_at,
)
from app.document.queries.clips import clip_of
from app.document.queries.key_segments import segment_keys
from app.document.queries.layers.depth import depth_points_at
from app.document.queries.layers.visibility import is_visible
from app.document.queries.timeline import export_frame_range, segment_time_at
from app.document.settings import FrameRange
from app.errors import LissomError
from app.motion.inbetweens.animation import Animation
from engine.variant import Variant


def cycling(*frames, cycle, last=100, loop=False, **settings):
    """Return a document with different keys at some frames, of which a stretch repeats."""
    document = row(len(frames))
    keys = tuple(
        replace(key, frame=frame)
        for key, frame in zip(document.layers[0].keys, frames, strict=True)
    )
    return altered(
        document, keys=keys, cycles=(cycle,), frames=FrameRange(0, last), loop=loop, **settings
    )


def moving(document):
    return Animation(clip_of(document, 0), points=document.layers[0].domain.outline)


WALK = Cycle(first=20, last=44, until=92)
KEYS = (4, 20, 28, 34, 40)


def unlike(animation, cycle, frames, until=None):
    """Return by how much repeats differ at most, at some frames of a stretch."""
    period, worst = cycle.period, 0.0
    for frame in frames:
        first = animation.positions(frame)
        for again in range(frame + period, (until or cycle.until) + 1, period):
            worst = max(worst, np.abs(animation.positions(again) - first).max())
    return worst


# Of each variant the one or the other: whether a key follows the repeats.
@pytest.mark.parametrize(
    ("variant", "after"), [*zip(Variant, alternate([(), (110,)]), strict=False)]
)
def test_every_repeat_is_the_same_motion(variant, after):
    document = cycling(*KEYS, *after, cycle=WALK, last=120, variant=variant)
    assert unlike(moving(document), WALK, range(20, 44, 3)) < 1e-9


@pytest.mark.parametrize("passing", TangentMode)
def test_it_is_so_however_keys_are_passed(passing):
    document = cycling(*KEYS, 110, cycle=WALK, last=120)
    document = channel_commands.set_tangent_mode({Channel(POSE, 0): {20, 34}}, passing)(document)
    animation = moving(document)
    assert unlike(animation, WALK, [20, 21, 30, 33, 34, 35, 43]) < 1e-9
    if passing is TangentMode.HOLD:
        assert_allclose(animation.positions(91), animation.positions(43), rtol=0, atol=1e-9)
        assert_allclose(animation.positions(70), animation.positions(68), rtol=0, atol=1e-9)


@pytest.mark.parametrize("variant", ["nu", "eta", "metric"])
def test_it_is_led_to_gone_through_and_gone_on_from_at_one_velocity(variant):
    document = cycling(*KEYS, 110, cycle=WALK, last=120, variant=variant)
    animation = moving(document)
    speeds = [jump(animation, frame) for frame in (20.0, 28.0, 44.0, 68.0, 92.0)]
    largest = max(speed for _, speed in speeds)
    assert max(change for change, _ in speeds) < 1e-5 * largest
    assert min(speed for _, speed in speeds) > 1e-2 * largest


def test_a_cycle_whose_end_is_keyed_alike_goes_on_through_it():
    document = cycling(*KEYS, 92, 110, cycle=WALK, last=120)
    keys = document.layers[0].keys
    end = replace(keys[5], pose=keys[1].pose)
    document = altered(document, keys=(*keys[:5], end, keys[6]))
    change, speed = jump(moving(document), 92.0)
    assert change < 1e-5 * speed


def test_a_key_where_the_repeats_end_takes_over():
    document = cycling(*KEYS, 92, cycle=WALK, last=120)
    animation, keys = moving(document), document.layers[0].keys
    posed = document.layers[0].map_of(keys[-1].pose)(document.layers[0].domain.outline)
    for frame in (92, 100, 120):
        assert_allclose(animation.positions(frame), posed, rtol=0, atol=1e-9)
    assert unlike(animation, WALK, [21, 40, 43], until=91) < 1e-9


def test_it_can_begin_and_end_between_keys_where_none_are_beyond():
    cycle = Cycle(first=10, last=34, until=80)
    animation = moving(cycling(16, 20, 28, cycle=cycle))
    assert unlike(animation, cycle, range(10, 34, 4)) < 1e-9
    # 80 is frame 32 of the stretch, from where it leads on to 16, eight frames later.
    for frame in (81, 100):
        assert_allclose(animation.positions(frame), animation.positions(32), rtol=0, atol=1e-9)
    assert_allclose(animation.positions(3), animation.positions(10), rtol=0, atol=1e-9)


def test_what_ends_right_after_its_stretch_stands_still_there():
    # The way round, from 17 to 24, goes on beyond the end at 19.
    animation = moving(cycling(6, 7, 17, cycle=Cycle(first=0, last=18, until=19), last=40))
    for frame in (20, 22, 25, 40):
        assert_allclose(animation.positions(frame), animation.positions(19), rtol=0, atol=1e-9)


def test_it_is_reported_where_repeats_may_end_before_a_key():
    with pytest.raises(LissomError, match="End the repeats at frame 20 instead"):
        cycling(6, 7, 17, 20, cycle=Cycle(first=0, last=18, until=19))
    with pytest.raises(LissomError, match="End the repeats at frame 24 instead"):
        cycling(6, 7, 17, 30, cycle=Cycle(first=0, last=18, until=22))


def test_in_a_loop_keys_elsewhere_lead_through_a_stretch_without_one():
    with pytest.raises(LissomError, match="No key of 'layer' in frames 0 to 4 could repeat"):
        cycling(35, 42, cycle=Cycle(first=0, last=4, until=20), loop=True)


def test_without_an_end_it_repeats_to_the_end_of_the_scene():
    cycle = Cycle(first=0, last=24)
    animation = moving(cycling(0, 8, 16, cycle=cycle, last=101))
    assert unlike(animation, cycle, range(24), until=101) < 1e-9


def test_two_keys_swing_to_and_fro():
    cycle = Cycle(first=0, last=24)
    animation = moving(cycling(0, 12, cycle=cycle, last=96))
    assert unlike(animation, cycle, range(24), until=96) < 1e-9
    assert_allclose(animation.positions(30), animation.positions(18), rtol=0, atol=1e-9)
    assert jump(animation, 24.0)[0] < 1e-3


def test_repeats_are_prepared_once():
    document = cycling(*KEYS, 110, cycle=replace(WALK, until=92), last=120)
    store, count = prepared(document)
    assert count == len(segment_keys(clip_of(document, 0))) == 6
    assert all(store.is_exact(clip_of(document, 0), frame) for frame in range(121))
    longer = altered(document, cycles=(replace(WALK, until=44),))
    # What goes on from it does so in other time.
    assert prepared(longer, store)[1] == 1


def test_a_loop_of_whole_repeats_has_no_seam():
    cycle = Cycle(first=0, last=24)
    document = cycling(0, 8, 16, cycle=cycle, last=72, loop=True)
    assert export_frame_range(document) == FrameRange(0, 71)
    change, speed = jump(moving(document), 72.0)
    assert change < 1e-5 * speed
    document = cycling(0, 8, 16, 60, cycle=replace(cycle, until=48), last=72, loop=True)
    assert export_frame_range(document) == FrameRange(0, 71)
    animation = moving(document)
    assert unlike(animation, cycle, range(24), until=48) < 1e-9
    speeds = [jump(animation, frame) for frame in (0.0, 24.0, 48.0, 60.0, 72.0)]
    assert max(change for change, _ in speeds) < 1e-5 * max(speed for _, speed in speeds)


def test_two_cycles_follow_each_other():
    document = cycling(0, 6, 40, 46, cycle=Cycle(first=0, last=12, until=36))
    second = Cycle(first=40, last=52)
    document = altered(document, cycles=(*document.layers[0].cycles, second))
    animation = moving(document)
    assert unlike(animation, document.layers[0].cycles[0], range(12), until=36) < 1e-9
    assert unlike(animation, second, range(40, 52), until=100) < 1e-9
    for frame in (12.0, 36.0, 40.0, 52.0):
        assert jump(animation, frame)[0] < 1e-3


def test_a_single_key_stands_until_the_repeats_end():
    document = cycling(0, 20, 60, cycle=Cycle(first=20, last=30, until=50))
    clip = clip_of(document, 0)
    assert [segment_time_at(clip, frame)[1] for frame in (20, 33, 50)] == [1.0, 1.0, 1.0]
    assert 0.0 < segment_time_at(clip, 55).weight < 1.0
    assert 0.0 < segment_time_at(clip, 10).weight < 1.0


def with_handles(document, *, free=False):
    """Return it with two handles, which the second and third of its keys have at one place."""
    layer = document.layers[0]
    handles = tuple(
        Handle(id=number, name=str(number), position=place, is_unpinned=free)
        for number, place in enumerate((30 + 45j, 90 + 45j))
    )

    def targets(pose):
        places = layer.map_of(pose)(np.array([handle.position for handle in handles]))
        return {i: Target(position=complex(place)) for i, place in enumerate(places)}

    keys = [replace(k, pose=replace(k.pose, targets=targets(k.pose))) for k in layer.keys]
    still = dict(keys[2].pose.targets) | {0: keys[1].pose.targets[0]}
    keys[2] = replace(keys[2], pose=replace(keys[2].pose, targets=still))
    return altered(document, keys=tuple(keys), handles=handles, next_handle=2)


def test_handles_that_stay_and_tracks_repeat_with_it():
    document = with_handles(cycling(*KEYS, 110, cycle=WALK, last=120))
    wag = Track(
        handles=(1,),
        keys=(
            TrackKey(frame=24, place=0j),
            TrackKey(frame=30, place=4 + 3j),
            TrackKey(frame=38, place=0j),
        ),
        delay=10,
    )
    document = altered(document, tracks=(wag,))
    animation = moving(document)
    assert animation.corrections is not None
    found = [animation.corrections.correction_at(frame) for frame in (22, 41)]
    again = [animation.corrections.correction_at(frame) for frame in (46, 89)]
    assert all(one is other and one is not None for one, other in zip(found, again, strict=True))
    assert unlike(animation, WALK, [22, 26, 29, 41]) < 1e-9


def test_what_is_in_front_and_seen_repeats_with_it():
    document = with_handles(cycling(*KEYS, 110, cycle=WALK, last=120))
    ahead = document.layers[0].with_keys_of(DEPTH, [DEPTH.key(34, 1.0)], 1)
    document = document.with_layer(ahead)
    clip = clip_of(document, 0)
    ahead = [bool(depth_points_at(clip, frame)) for frame in (33, 34, 43, 44, 57, 58, 91, 92, 110)]
    assert ahead == [False, True, True, False, False, True, True, False, False]
    switches = (VISIBILITY.key(0, value=True), VISIBILITY.key(30, value=False))
    layer = document.layers[0].with_keys_of(VISIBILITY, switches)
    document = document.with_layer(layer)
    shown = [is_visible(document, layer, frame) for frame in (29, 30, 43, 44, 53, 54, 91, 92, 120)]
    assert shown == [True, False, False, True, True, False, False, True, True]


def test_what_moves_fades_and_is_ordered_repeats_with_it():
    wait, end = 2.5, WALK.until
    bob = tuple(TRANSFORM.key(f, Transform(s)) for f, s in ((20, 0j), (30, 9j), (44, 0j)))
    blink = tuple(OPACITY.key(f, o) for f, o in ((22, 1.0), (28, 0.2), (40, 1.0)))
    channels = {(TRANSFORM.name, None): bob, (OPACITY.name, None): blink}
    document = cycling(*KEYS, cycle=WALK, last=120, channels=channels)
    behind = replace(document.layers[0], id=1, name="behind")
    weave = document.layers[0].with_keys_of(DRAW_ORDER, [DRAW_ORDER.key(30, DrawOrder(1))])
    document = replace(document, layers=(weave, behind))

    def shown(document, frame):
        layer = document.layer(0)
        moved = transform_at(document, layer, frame).shift
        order = [each.id for each in layers_in_draw_order(document, frame)]
        return moved, opacity_at(document, layer, frame), order

    for frame in (20, 23, 30 + wait, 39, 43):
        for again in (24, 48):
            moved, opacity, order = shown(document, frame + again)
            assert abs(moved - shown(document, frame)[0]) < 1e-9
            assert abs(opacity - shown(document, frame)[1]) < 1e-9
            assert order == shown(document, frame)[2]
    assert [shown(document, frame)[2] for frame in (29, 30, 44, 54)] == [[0, 1], [1, 0]] * 2
    # Through the seam at one velocity; before and after the repeats it is held.
    before, at, after = (shown(document, 44 + by)[0] for by in (-1e-4, 0, 1e-4))
    assert abs((after - at) - (at - before)) < 1e-3 * abs(after - before)
    assert shown(document, end) == shown(document, end + 9) == shown(document, 20)
    # Posed in one, all change; made into keys, nothing is seen to.
    changed = channel_commands.set_key(Channel(TRANSFORM, 0), 44, Transform(5 + 0j))(document)
    assert [shown(changed, frame)[0] for frame in (20, 44, 92)] == [5, 5, 5]
    keyed = cycle_commands.bake_cycle(0, 20, 120)(document)
    for frame in (30, 46, 54, 67, 78, 91):
        assert abs(shown(keyed, frame)[0] - shown(document, frame)[0]) < 1.5
        assert shown(keyed, frame)[2] == shown(document, frame)[2]
    # Who goes on beyond the stretch, or comes elsewhere, has a time of their own.
    for last in (60, 44):
        moves = TRANSFORM.key(20, Transform()), TRANSFORM.key(last, Transform(9))
        walk = document.layer(0).with_keys_of(TRANSFORM, moves)
        assert shown(document.with_layer(walk), 92)[0] == 9
