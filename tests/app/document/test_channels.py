"""Commands on keys do the same to the channels of every kind."""

import re
from dataclasses import fields, is_dataclass, replace
from math import floor, isclose

import numpy as np
import pytest
from animations import still_document
from documents import CENTRE, PICTURE, altered, disc_domain, random_pose
from hypothesis import assume, given, settings, strategies as st

from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    HOLD,
    LAYER_KINDS,
    LINEAR,
    MARKER,
    PARENT,
    POSE,
    SLIDER,
    SWITCH,
    TRACK,
    VISIBILITY,
    Attachment,
    Camera,
    Channel,
    Cycle,
    Document,
    DrawOrder,
    Easing,
    ExportSettings,
    FrameRange,
    Keyframe,
    Marker,
    Meshing,
    Quantity,
    Slider,
    SliderPose,
    SwitchGroup,
    TangentMode,
    Track,
    TrackKey,
    camera_at,
    channel_commands,
    channels_in,
    clip_of,
    combine_commands,
    cycle_commands,
    depth_points_at,
    draw_order_key_at,
    frames_in,
    handle_commands,
    held_key_at,
    is_visible,
    keys_in,
    layer_commands,
    layer_value_at,
    new_layer,
    scene_commands,
    source_frame,
    track_at,
    track_commands,
    with_repeats,
)
from app.document.checks import MAX_COORDINATE
from app.document.commands.keys.stored_keys import put_keys
from app.document.queries.channel_values.repeats import repeated_keys, rest_value
from app.errors import LissomError

FIRST, LAST = 5, 29  # of keys
CYCLE = Cycle(first=10, last=26, until=70)
LAYER, OTHERS = 0, (1, 2, 3)
EASINGS = [
    LINEAR,
    HOLD,
    Easing((0.5, 0.0, 1.0, 1.0)),
    Easing((0.25, 0.0, 0.75, 1.0)),
    Easing((0.0, 0.25, 0.5, 1.0)),
]
MODES = [TangentMode.SMOOTH, TangentMode.CORNER, TangentMode.STOP]
POINTS = st.builds(complex, *2 * [st.integers(-90, 90)])
SHARES = st.floats(0, 1)
VALUES = {
    Quantity.NUMBER: st.floats(-100, 100),
    Quantity.FACTOR: st.floats(0.1, 10),
    Quantity.SHARE: SHARES,
    Quantity.DEPTH: st.floats(-1, 1),
    Quantity.POINT: POINTS,
    Quantity.ANGLE: st.floats(-9, 9),
    Quantity.FLAG: st.booleans(),
    Quantity.LAYER: st.sampled_from(OTHERS),
    Quantity.COLOUR: st.tuples(SHARES, SHARES, SHARES),
    Quantity.VALUE: st.builds(complex, *2 * [st.floats(-1, 1)]),
    Quantity.ANYTHING: st.none(),
}


def channel_of(kind):
    """Return a channel of a kind in the document of these tests."""
    if kind in {MARKER, CAMERA}:
        return Channel(kind)
    if kind is SWITCH:
        return Channel(kind, part="mouths")
    if kind is SLIDER:
        return Channel(kind, LAYER, "turn")
    return Channel(kind, LAYER, 0 if kind in {TRACK, DEPTH} else None)


CHANNELS = [
    channel_of(kind)
    for kind in (POSE, TRACK, PARENT, MARKER, CAMERA, SWITCH, *LAYER_KINDS.values())
]
OF_LAYER = [channel for channel in CHANNELS if channel.kind.name in LAYER_KINDS]
every_channel = pytest.mark.parametrize("channel", CHANNELS, ids=lambda each: each.kind.name)
every_layer_channel = pytest.mark.parametrize("channel", OF_LAYER, ids=lambda each: each.kind.name)


def empty_document():
    """Return a document of a layer with handles and a track, and three layers of a switch."""
    document = Document(layers=(new_layer(PICTURE, disc_domain(4), Meshing()),))
    document = handle_commands.add_handle(0, CENTRE)(document)
    document = handle_commands.add_handle(0, CENTRE + 30j)(document)
    layer = document.layers[0]
    track = Track(handles=(0,), keys=(TrackKey(frame=0, place=0j),), keys_rotation=True)
    poses = tuple(SliderPose(at=complex(at), pose=None) for at in (-1, 1))
    slider = Slider(name="turn", poses=poses)
    layer = replace(layer, anchor=CENTRE, tracks=(track,), sliders=(slider,))
    others = [replace(layer, id=each, name=f"layer {each}", tracks=()) for each in OTHERS]
    group = SwitchGroup(name="mouths", members=OTHERS)
    frames = FrameRange(0, 80)
    return replace(document, layers=(layer, *others), switch_groups=(group,), frames=frames)


EMPTY = empty_document()
POSES = [random_pose(np.random.default_rng(seed), EMPTY) for seed in range(6)]


@st.composite
def values(draw, kind):
    """Draw a value of a kind whose keys have no class of their own."""
    given = [
        draw(
            st.one_of(st.none(), VALUES[each.quantity])
            if each.is_optional
            else VALUES[each.quantity]
        )
        for each in kind.fields
    ]
    return kind.make(*given)


@st.composite
def keys(draw, kind, first=FIRST, last=LAST, easings=tuple(EASINGS), least=1):
    """Draw one to six keys of a kind."""
    frames = sorted(draw(st.sets(st.integers(first, last), min_size=least, max_size=6)))
    start, made = draw(st.integers(0, 2)), []
    for number, frame in enumerate(frames):
        segment = {"frame": frame}
        if not kind.is_held:
            segment["easing"] = draw(st.sampled_from(easings))
            segment["tangent_mode"] = draw(st.sampled_from(MODES))
        match kind.name:
            case POSE.name:
                turns = draw(st.integers(-1, 1))
                key = Keyframe(pose=POSES[number], revolutions=turns, **segment)
            case TRACK.name:
                velocity = draw(st.one_of(st.none(), POINTS))
                turn = draw(VALUES[Quantity.ANGLE])
                key = TrackKey(place=draw(POINTS), turn=turn, velocity=velocity, **segment)
            case PARENT.name:
                parent = draw(st.sampled_from([None, *OTHERS]))
                key = Attachment(parent=parent, offset=draw(POINTS), **segment)
            case MARKER.name:
                key = Marker(name=f"marker {number}", **segment)
            case SWITCH.name:
                # A key that shows the layer that is visible anyway is left out.
                key = kind.key(value=OTHERS[(start + number) % len(OTHERS)], **segment)
            case _:
                key = kind.key(value=draw(values(kind)), **segment)
        made.append(key)
    return tuple(made)


def keyed(channel, row, document=EMPTY):
    document = put_keys(document, channel, row)
    assert content(document, channel) == list(map(fields_of, row))
    return document


def chosen(document, *channels):
    return {channel: frames_in(document, channel) for channel in channels}


def fields_of(key, *, without=()):
    """Return all fields of a key, which two pose keys would not be compared by."""
    return {each.name: getattr(key, each.name) for each in fields(key) if each.name not in without}


def content(document, channel, *, without=()):
    return [fields_of(key, without=without) for key in keys_in(document, channel)]


def visible_member(document, frame):
    return with_repeats(document, document.switch_group("mouths")).member_at(frame)


def name_at(document, frame):
    return next((each.name for each in document.markers if each.frame == frame), None)


def pose_at(_document, layer, frame):
    """Return which pose is keyed at a frame."""
    return next((id(key.pose) for key in layer.keys if key.frame == frame), None)


def track_value(document, layer, frame):
    return track_at(layer.tracks[0], clip_of(document, layer.id), frame)


def joint_at(_document, layer, frame):
    joint = layer.attachment_key_at(frame)
    return None if joint is None else replace(joint, frame=0)


def order_at(document, layer, frame):
    key = draw_order_key_at(document, layer, frame)
    return DrawOrder(None) if key is None else key.value


def depth_at(document, layer, frame):
    points = depth_points_at(clip_of(document, layer.id), frame)
    return next((each.depth for each in points if each.place == layer.handles[0].position), 0.0)


VALUES_OF_SCENE = {MARKER: name_at, CAMERA: camera_at, SWITCH: visible_member}
VALUES_OF_LAYER = {
    POSE: pose_at,
    TRACK: track_value,
    PARENT: joint_at,
    VISIBILITY: is_visible,
    DRAW_ORDER: order_at,
    DEPTH: depth_at,
}


def value_at(document, channel, frame):
    """Return what a channel shows at a frame; of poses and markers only what a key there says."""
    kind = channel.kind
    if channel.layer is None:
        return VALUES_OF_SCENE[kind](document, frame)
    layer = document.layer(channel.layer)
    if kind in VALUES_OF_LAYER:
        return VALUES_OF_LAYER[kind](document, layer, frame)
    if not kind.is_held:
        return layer_value_at(document, layer, kind, frame, channel.part)
    rest, row = rest_value(layer, kind, channel.part), layer.keys_of(kind, channel.part)
    key = held_key_at(repeated_keys(row, layer.cycles, document.frames.last, rest), frame)
    return rest if key is None else key.value


def are_same(one, other):
    """Return whether two values are the same to rounding."""
    if isinstance(one, tuple) and isinstance(other, tuple):
        return all(map(are_same, one, other))
    if is_dataclass(one) and is_dataclass(other):
        return all(are_same(getattr(one, f.name), getattr(other, f.name)) for f in fields(one))
    if isinstance(one, complex) and isinstance(other, complex):
        return are_same(one.real, other.real) and are_same(one.imag, other.imag)
    if isinstance(one, float) and isinstance(other, float):
        return isclose(one, other, rel_tol=1e-6, abs_tol=1e-6)
    return one == other


def require_same(one, other, channel, frames):
    """Check that a document shows at frames what another one shows at the frames they map to."""
    for frame, source in frames:
        shown, expected = value_at(one, channel, frame), value_at(other, channel, source)
        assert are_same(shown, expected), (frame, source, shown, expected)


@every_channel
@settings(max_examples=20)
@given(data=st.data(), by=st.integers(-FIRST, 50))
def test_moved_keys_show_everything_later(channel, data, by):
    document = keyed(channel, data.draw(keys(channel.kind)))
    moved = channel_commands.move_keys(chosen(document, channel), by)(document)
    assert (moved is document) == (by == 0)
    assert content(moved, channel, without={"frame"}) == content(
        document, channel, without={"frame"}
    )
    require_same(moved, document, channel, [(at + by, at) for at in range(max(0, -by), LAST + 3)])


FACTORS = st.one_of(st.sampled_from([0.5, 1.5, 2, 3]), st.floats(0.1, 4))


def scaled_frames(row, stays, factor):
    return [stays + floor((key.frame - stays) * factor + 0.5) for key in row]


@every_channel
@settings(max_examples=20)
@given(data=st.data(), factor=FACTORS)
def test_scaled_keys_stay_in_order_or_are_refused(channel, data, factor):
    row = data.draw(keys(channel.kind))
    document, first = keyed(channel, row), row[0].frame
    frames = scaled_frames(row, first, factor)
    command = channel_commands.scale_keys(chosen(document, channel), factor)
    if len({*frames}) < len(row):
        with pytest.raises(LissomError) as refusal:
            command(document)
        pairs = [
            (one.frame, other.frame)
            for one, other, at, after in zip(row, row[1:], frames, frames[1:], strict=False)
            if at == after
        ]
        assert f"at frames {pairs[0][0]} and {pairs[0][1]} would both be" in str(refusal.value)
        return
    scaled = command(document)
    assert [key.frame for key in keys_in(scaled, channel)] == frames
    of_time = {"frame", "velocity"}
    assert content(scaled, channel, without=of_time) == content(document, channel, without=of_time)
    if factor == int(factor):
        shown = [(first + int(factor) * (at - first), at) for at in range(first, LAST + 3)]
        require_same(scaled, document, channel, shown)


@every_channel
@settings(max_examples=20)
@given(data=st.data(), gap=st.integers(1, 9))
def test_copies_that_are_deleted_leave_what_was_there(channel, data, gap):
    row = data.draw(keys(channel.kind))
    document, by = keyed(channel, row), row[-1].frame - row[0].frame + gap
    # A switch key that shows the layer that is visible anyway is left out.
    assume(channel.kind is not SWITCH or row[0].value != row[-1].value)
    copied = channel_commands.copy_keys(chosen(document, channel), by)(document)
    copies = frozenset(key.frame + by for key in row)
    assert frames_in(copied, channel) == frames_in(document, channel) | copies
    left = channel_commands.delete_keys({channel: copies})(copied)
    assert content(left, channel) == content(document, channel)


@every_channel
@settings(max_examples=20)
@given(data=st.data())
def test_reversed_keys_run_backwards(channel, data):
    eased = tuple(easing for easing in EASINGS if easing != HOLD)
    row = data.draw(keys(channel.kind, easings=eased))
    document, ends = keyed(channel, row), row[0].frame + row[-1].frame
    backwards = channel_commands.reverse_keys(chosen(document, channel))(document)
    inside = range(row[0].frame, row[-1].frame + 1)
    if channel.kind.is_held and channel.kind is not MARKER:
        # What holds changes at the frame of a key, and the last key holds on.
        inside = [at for at in inside if at not in frames_in(document, channel)]
        require_same(backwards, document, channel, [(row[-1].frame + 2, row[-1].frame + 2)])
    require_same(backwards, document, channel, [(ends - at, at) for at in inside])


@every_channel
@settings(max_examples=20)
@given(data=st.data())
def test_reversing_keys_twice_leaves_them_as_they_were(channel, data):
    row = data.draw(keys(channel.kind))
    document = keyed(channel, row)
    assume(channel.kind is not SWITCH or len(row) == 1 or row[0].value != row[-1].value)
    command = channel_commands.reverse_keys
    once = command(chosen(document, channel))(document)
    assert len(keys_in(once, channel)) == len(row)
    twice = command(chosen(once, channel))(once)
    assert content(twice, channel) == content(document, channel)


# Keys of all channels.
ROWS = st.tuples(*(keys(channel.kind) for channel in CHANNELS))


def document_of(rows):
    """Return a document with keys in all channels."""
    document = EMPTY
    for channel, row in zip(CHANNELS, rows, strict=True):
        document = keyed(channel, row, document)
    return document


@settings(max_examples=40)
@given(
    rows=ROWS,
    factor=st.sampled_from([0.5, 1.5, 2, 3]),
    some=st.sets(st.integers(0, len(CHANNELS) - 1), min_size=2),
)
def test_keys_of_many_kinds_change_as_each_alone(rows, factor, some):
    document = document_of(rows)
    every = chosen(document, *(CHANNELS[number] for number in some))
    first = min(min(frames) for frames in every.values())
    last = max(max(frames) for frames in every.values())
    for command, arguments, own in (
        (channel_commands.reverse_keys, (), ((first, last),)),
        (channel_commands.scale_keys, (factor,), (factor, first)),
        (channel_commands.move_keys, (3,), (3,)),
    ):
        each = [command({channel: frames}, *own) for channel, frames in every.items()]
        try:
            together = command(every, *arguments)(document)
        except LissomError as refusal:
            with pytest.raises(LissomError, match=re.escape(str(refusal))):
                combine_commands("Alone", each)(document)
            continue
        alone = combine_commands("Alone", each)(document)
        for channel in CHANNELS:
            assert content(together, channel) == content(alone, channel)


@settings(max_examples=40)
@given(rows=ROWS, factor=st.sampled_from([0.5, 1.5, 2, 3]))
def test_scaled_time_scales_all_channels_and_ranges(rows, factor):
    document = document_of(rows)
    preview, export = FrameRange(4, 30), ExportSettings(frames=FrameRange(6, 60))
    document = replace(document, preview=preview, export=export)
    frames = {
        channel: scaled_frames(keys_in(document, channel), 0, factor)
        for channel in channels_in(document)
    }
    assert {*CHANNELS} <= {*frames}
    command = scene_commands.scale_time(factor)
    if any(len({*each}) < len(each) for each in frames.values()):
        with pytest.raises(LissomError, match=r"at frames \d+ and \d+ would both be"):
            command(document)
        return
    scaled = command(document)
    of_time = {"frame", "velocity"}
    for channel, at in frames.items():
        assert [key.frame for key in keys_in(scaled, channel)] == at
        assert content(scaled, channel, without=of_time) == content(
            document, channel, without=of_time
        )
    ranges = [scaled.frames, scaled.preview, scaled.export.frames]
    ends = [(each.first, each.last) for each in (document.frames, preview, export.frames)]
    assert ranges == [
        FrameRange(floor(first * factor + 0.5), floor(last * factor + 0.5)) for first, last in ends
    ]


def cycling(document, until=CYCLE.until):
    """Return the document with a cycle of its first layer."""
    layer = document.layer(LAYER)
    pose = replace(layer.keys[0], frame=CYCLE.first)
    cycle = replace(CYCLE, until=until)
    return document.with_layer(replace(layer, keys=(pose,), cycles=(cycle,)))


def in_cycle(kind, **given):
    """Draw keys within the cycle."""
    return keys(kind, first=CYCLE.first, last=CYCLE.last - 1, **given)


def filling_cycle(row):
    """Return keys from the first frame of the cycle to its last, which shows the same."""
    return (replace(row[0], frame=CYCLE.first), *row[1:], replace(row[0], frame=CYCLE.last))


UNTIL = st.one_of(st.none(), st.integers(CYCLE.last, 75))


@every_layer_channel
@settings(max_examples=20)
@given(data=st.data(), until=UNTIL)
def test_repeats_show_what_the_cycle_shows(channel, data, until):
    document = cycling(keyed(channel, data.draw(in_cycle(channel.kind))), until)
    last = document.frames.last if until is None else until
    shown = [(at, int(CYCLE.source_frame(at))) for at in range(CYCLE.first, last + 1)]
    require_same(document, document, channel, shown)
    # After the repeats, the last frame of the repeats holds.
    after = [(at, last) for at in range(last, document.frames.last)]
    require_same(document, document, channel, after)


@every_layer_channel
@settings(max_examples=20)
@given(data=st.data(), until=UNTIL)
def test_baked_repeats_show_what_was_shown(channel, data, until):
    kind = channel.kind
    row = data.draw(in_cycle(kind, least=1 if kind.is_held else 2))
    if not kind.is_held:
        # At its ends, smooth motion changes.
        row = tuple(replace(key, tangent_mode=TangentMode.CORNER) for key in row)
        row = filling_cycle(row) if data.draw(st.booleans()) else row
    document = cycling(keyed(channel, row), until)
    baked = cycle_commands.bake_cycle(LAYER, CYCLE.first, EMPTY.frames.last)(document)
    end = EMPTY.frames.last if until is None else until
    frames = {*range(EMPTY.frames.last + 1)}
    if not kind.is_held:
        # An eased segment that the cycle's beginning or end cuts in two shows only its ends.
        *_before, last = (key.frame for key in keys_in(baked, channel) if key.frame < end)
        frames -= {*range(CYCLE.first + 1, row[0].frame), *range(last + 1, end)}
    require_same(baked, document, channel, [(at, at) for at in sorted(frames)])


@every_layer_channel
@settings(max_examples=20)
@given(data=st.data())
def test_keys_in_repeats_show_the_same_when_poses_are_baked(channel, data):
    eased = tuple(each for each in EASINGS if each != HOLD)
    row = data.draw(keys(channel.kind, first=42, last=57, easings=eased))
    document = cycling(keyed(channel, row))
    baked = cycle_commands.bake_cycle(LAYER, CYCLE.first, EMPTY.frames.last)(document)
    (left,) = baked.layer(LAYER).cycles  # of an incomplete repeat
    assert left.contains(row[0].frame)
    assert left.contains(row[-1].frame)
    require_same(baked, document, channel, [(at, at) for at in range(EMPTY.frames.last + 1)])


@pytest.mark.parametrize("shown", [2, 3])
def test_switch_keys_in_repeats_stay_when_poses_are_baked(shown):
    """At the end of the cycle that is left, its first layer is visible again, or another one."""
    switch = channel_of(SWITCH)
    document = keyed(switch, tuple(map(SWITCH.key, (0, 44, 50), (2, 1, shown))))
    for each in OTHERS:
        pose = replace(document.layer(each).keys[0], frame=CYCLE.first)
        layer = replace(document.layer(each), keys=(pose,), cycles=(CYCLE,))
        document = document.with_layer(layer)
    baked = document
    for each in OTHERS:
        baked = cycle_commands.bake_cycle(each, CYCLE.first, EMPTY.frames.last)(baked)
    assert baked.layer(1).cycles == (Cycle(first=42, last=58, until=70),)
    frames = [(at, at) for at in range(EMPTY.frames.last + 1)]
    require_same(baked, document, switch, frames)


@every_layer_channel
@given(data=st.data())
@settings(max_examples=5)
def test_cycle_without_repeats_ends_as_it_began(channel, data):
    document = cycling(keyed(channel, data.draw(in_cycle(channel.kind, least=2))))
    frames = [(at, at) for at in range(CYCLE.first, CYCLE.last + 1)]
    ended = cycle_commands.delete_cycle(LAYER, CYCLE.first)(document)
    require_same(ended, document, channel, frames if channel.kind.is_held else frames[-1:])


@pytest.mark.parametrize("delay", [0, 5])
@settings(max_examples=20)
@given(data=st.data(), until=UNTIL)
def test_baked_track_shows_what_was_shown(delay, data, until):
    channel = channel_of(TRACK)
    row = data.draw(in_cycle(TRACK, easings=(LINEAR,), least=2))
    row = (
        replace(key, tangent_mode=TangentMode.CORNER, velocity=None) for key in filling_cycle(row)
    )
    document = cycling(keyed(channel, tuple(row)), until)
    document = track_commands.set_delay(LAYER, 0, delay)(document)
    end = EMPTY.frames.last if until is None else until
    baked = cycle_commands.bake_cycle(LAYER, CYCLE.first, EMPTY.frames.last)(document)
    require_same(baked, document, channel, [(at, at) for at in range(CYCLE.first, end + 1)])


@every_layer_channel
@settings(max_examples=20)
@given(data=st.data(), frame=st.integers(CYCLE.last + 1, CYCLE.until - 1))
def test_key_set_in_a_repeat_is_set_in_all(channel, data, frame):
    kind, row = channel.kind, data.draw(in_cycle(channel.kind, least=2))
    if not kind.is_held and data.draw(st.booleans()):
        row = filling_cycle(row)
    document = cycling(keyed(channel, row))
    value = data.draw(values(kind))
    source = int(CYCLE.source_frame(frame))
    assert source_frame(document, channel, frame) == source
    changed = channel_commands.set_key(channel, frame, value)(document)
    assert frames_in(changed, channel) == frames_in(document, channel) | {source}
    for at in range(source, CYCLE.until, CYCLE.period):
        assert are_same(value_at(changed, channel, at), value)


def references(document):
    """Yield the ids of layers to which keys refer."""
    for channel in channels_in(document):
        for key in keys_in(document, channel):
            if channel.kind is PARENT:
                yield key.parent
            for name in channel.kind.layer_fields:
                yield channel.kind.field_of(key.value, name)


@settings(max_examples=40)
@given(rows=ROWS, identity=st.sampled_from(OTHERS), copies=st.booleans())
def test_deleted_layer_leaves_no_keys_that_refer_to_it(rows, identity, copies):
    document = document_of(rows)
    if copies:
        document = layer_commands.duplicate_layer(LAYER)(document)
        document = layer_commands.duplicate_layer(identity)(document)
    left = layer_commands.remove_layer(identity)(document)
    assert identity not in set(references(left))
    for channel in CHANNELS:
        if channel.kind is not SWITCH:
            kept = [
                key
                for key, others in zip(
                    content(document, channel), refer_by_key(document, channel), strict=True
                )
                if identity not in others
            ]
            assert content(left, channel) == kept


def refer_by_key(document, channel):
    """Return for each key of a channel the ids of the layers to which it refers."""
    return [
        [key.parent]
        if channel.kind is PARENT
        else [channel.kind.field_of(key.value, name) for name in channel.kind.layer_fields]
        for key in keys_in(document, channel)
    ]


@pytest.mark.parametrize(
    "zooms", [(1e-3, 1e3, 1e3), (1e3, 1e-3, 1e-3), (1.0, 1e-3, 1e-3, 1e3, 1e3)]
)
def test_smooth_motion_of_the_camera_stays_within_the_limits_of_keys(zooms):
    far = (MAX_COORDINATE, -MAX_COORDINATE)
    keys = tuple(
        CAMERA.key(8 * number**2, Camera(centre=far[number % 2], zoom=zoom))
        for number, zoom in enumerate(zooms)
    )
    document = altered(still_document(), frames=FrameRange(0, 200), camera=keys)
    for frame in np.linspace(0, keys[-1].frame, 97):
        shot = camera_at(document, frame)
        assert 1e-3 <= shot.zoom <= 1e3
        assert abs(shot.centre.real) <= MAX_COORDINATE
