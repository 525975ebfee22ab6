"""Scaled time: every kind of key comes to the same frames, and none is lost."""

from dataclasses import replace

import pytest
from documents import altered, disc_document
from messages import says

from app.document import (
    CAMERA,
    DEPTH,
    DRAW_ORDER,
    LAYER_KINDS,
    OPACITY,
    SWITCH,
    TRANSFORM,
    VISIBILITY,
    Camera,
    DrawOrder,
    Transform,
)
from app.document.channels.tracks import Track, TrackKey
from app.document.commands import handle_commands
from app.document.commands.keys.retime import KEYS_MEET
from app.document.commands.scene_commands import scale_time
from app.document.keyframe import Keyframe
from app.document.layers.attachments import Attachment
from app.document.layers.switch_group import SwitchGroup
from app.document.queries.timeline import changed_ranges
from app.document.settings import FrameRange, Marker
from app.errors import LissomError

ALONE = handle_commands.add_handle(0, 100 + 100j)(disc_document())
POSE = ALONE.layers[0].keys[0].pose


def of_layer(kind, value, at, part=None):
    return {"channels": {(kind.name, part): tuple(kind.key(frame, value) for frame in at)}}


CHANNELS = {
    "keys": lambda at: {"keys": tuple(Keyframe(frame=frame, pose=POSE) for frame in at)},
    "tracks": lambda at: {
        "tracks": (
            Track(handles=(0,), keys=tuple(TrackKey(frame=frame, place=0j) for frame in at)),
        )
    },
    "transform": lambda at: of_layer(TRANSFORM, Transform(), at),
    "opacity": lambda at: of_layer(OPACITY, 1.0, at),
    "draw_order": lambda at: of_layer(DRAW_ORDER, DrawOrder(None), at),
    "visibility": lambda at: of_layer(VISIBILITY, value=True, at=at),
    "depth": lambda at: of_layer(DEPTH, 0.5, at, part=0),
    "attachments": lambda at: {
        "attachments": tuple(Attachment(parent=None, frame=frame) for frame in at),
        "anchor": 100 + 100j,
    },
    "markers": lambda at: {"markers": tuple(Marker(frame=frame, name=f"m{frame}") for frame in at)},
    "camera": lambda at: {"camera": tuple(CAMERA.key(frame, Camera(centre=0j)) for frame in at)},
    "switch_groups": lambda at: {
        "switch_groups": (
            SwitchGroup(
                name="mouth", members=(0, 1), keys=tuple(SWITCH.key(f, f % 4 // 2) for f in at)
            ),
        )
    },
}


def keyed(channel, at, first=0):
    """Return a document of two layers with keys of one channel at some frames."""
    key = Keyframe(frame=first, pose=POSE)
    document = altered(ALONE, keys=(key,), frames=FrameRange(first, 48))
    document = (
        altered(document, **CHANNELS[channel](at)) if channel != "switch_groups" else document
    )
    other = replace(document.layers[0], id=1, name="other", attachments=(), channels={})
    document = replace(document, layers=(*document.layers, other))
    return replace(document, **CHANNELS[channel](at)) if channel == "switch_groups" else document


def frames_of(document, channel):
    """Return the frames of the keys of a channel."""
    if channel == "tracks":
        return [key.frame for key in document.layers[0].tracks[0].keys]
    if channel == "switch_groups":
        return [turn.frame for turn in document.switch_groups[0].keys]
    if channel in LAYER_KINDS:
        (row,) = document.layers[0].channels.values()
        return [key.frame for key in row]
    rows = document if hasattr(document, channel) else document.layers[0]
    return [key.frame for key in getattr(rows, channel)]


@pytest.mark.parametrize("channel", CHANNELS)
def test_halved_time_keeps_keys_apart(channel):
    halved = scale_time(0.5)(keyed(channel, (0, 3, 5, 7, 9)))
    assert frames_of(halved, channel) == [0, 2, 3, 4, 5]


@pytest.mark.parametrize("channel", CHANNELS)
def test_scaled_time_refuses_keys_that_meet(channel):
    document = keyed(channel, (0, 3, 4))
    with pytest.raises(LissomError, match=says(KEYS_MEET, one=3, other=4, frame=2)):
        scale_time(0.5)(document)


@pytest.mark.parametrize(
    "channel", ["draw_order", "visibility", "depth", "attachments", "switch_groups"]
)
def test_scaled_time_keeps_what_holds_as_it_begins(channel):
    document = keyed(channel, (0, 2, 25), first=20)
    assert frames_of(scale_time(2.0)(document), channel) == [0, 30]


@pytest.mark.parametrize("channel", CHANNELS)
def test_undo_tells_where_keys_of_each_kind_have_changed(channel):
    before, after = keyed(channel, (0, 4, 9)), keyed(channel, (0, 6, 9))
    assert {4, 6} <= {each.first for each in changed_ranges(before, after)}
    assert changed_ranges(before, replace(before, fps=12.0)) == []
