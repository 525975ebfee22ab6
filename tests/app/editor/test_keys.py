"""Keys of several rows, the end of the animation, and what the timeline tells of keys."""

import re
from dataclasses import replace

import pytest
from animations import moving_document
from documents import altered, disc_document
from messages import says
from sessions import session_of

from app.document import (
    LAST_FRAME,
    TRACK,
    Channel,
    Spring,
    Track,
    TrackKey,
    handle_commands,
    pose_channel,
    track_commands,
)
from app.document.commands.layers import layer_commands
from app.editor.actions import editing
from app.editor.actions.editing import FIRST_KEY_STAYS
from app.editor.actions.timing import keys
from app.editor.actions.timing.keys import NO_LAST_FRAME
from app.editor.parts.timeline.timeline_state import measure_key_errors
from app.editor.work.derived import Derived
from app.errors import LissomError


@pytest.fixture
def session(tmp_path):
    """Two blobs with keys at frames 0 and 6; the first has a track with keys at frames 0 and 4."""
    document = handle_commands.add_handle(0, 40 + 45j)(moving_document())
    document = layer_commands.duplicate_layer(0)(document)
    row = tuple(TrackKey(frame=frame, place=1j * frame) for frame in (0, 4))
    layer = replace(document.layer(0), tracks=(Track(handles=(0,), keys=row),))
    return session_of(document.with_layer(layer), tmp_path)


def texts(session):
    return [toast.text for toast in session.notices.toasts]


def test_deleting_all_keys_keeps_the_first_of_each_layer(session):
    project = session.project
    first, second = (layer.id for layer in project.document.layers)
    everything = {
        pose_channel(first): frozenset({0, 6}),
        pose_channel(second): frozenset({0, 6}),
        Channel(TRACK, first, 0): frozenset({0, 4}),
    }
    editing.select_channel_keys(session, everything)
    editing.delete_selection(session)
    assert [layer.key_frames for layer in project.document.layers] == [{0}, {0}]
    assert not project.document.layer(first).tracks
    (text,) = texts(session)
    assert re.fullmatch(says(FIRST_KEY_STAYS), text)
    editing.undo(session)
    assert [layer.key_frames for layer in project.document.layers] == [{0, 6}, {0, 6}]


def test_deleting_some_keys_deletes_those_alone(session):
    project = session.project
    first, second = (layer.id for layer in project.document.layers)
    chosen = {pose_channel(first): frozenset({0}), pose_channel(second): frozenset({6})}
    editing.select_channel_keys(session, chosen)
    editing.delete_selection(session)
    assert [layer.key_frames for layer in project.document.layers] == [{6}, {0}]
    assert not texts(session)
    editing.select_channel_keys(session, {pose_channel(first): frozenset({6})})
    with pytest.raises(LissomError, match="at least one key"):
        editing.delete_selection(session)


@pytest.mark.parametrize("last", [0, -5, LAST_FRAME + 1])
def test_last_frame_is_refused_in_words_where_it_cannot_be(session, last):
    with pytest.raises(LissomError, match=says(NO_LAST_FRAME, last=last)):
        keys.set_last_frame(session, last)


def test_handle_falls_short_no_longer_when_it_gets_a_spring():
    document = handle_commands.add_handle(0, 100 + 100j)(disc_document())
    layer = document.layers[0]
    pose = layer.keys[0].pose
    away = replace(pose.targets[0], position=160 + 100j)
    document = altered(
        document, keys=(replace(layer.keys[0], pose=replace(pose, targets={0: away})),)
    )
    layer, target_errors = document.layers[0], Derived({})
    target_errors.set(layer, measure_key_errors(layer, target_errors))
    (lags,) = target_errors.value.values()
    assert lags == {0: pytest.approx(60)}
    spring = Spring(handle=0, frequency=2, damping=0.3)
    follower = track_commands.put_spring(0, spring)(document).layers[0]
    (lags,) = measure_key_errors(follower, target_errors).values()
    assert lags == {}
