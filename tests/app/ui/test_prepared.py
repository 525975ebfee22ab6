"""What the window prepares before anybody asks, and what it leaves in the tests."""

import pytest
from bars import bend_bar

from app.document import Target, track_commands
from app.document.channels.tracks import Track, TrackKey
from app.editor import Session
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import drag_handles
from app.editor.parts.settings import SessionSettings
from app.editor.work.jobs import Jobs
from app.motion import StreamedVertices
from app.motion.extents.extent import extent_key

HALFWAY = 12  # between the two keys
TRACK = Track(handles=(1,), keys=tuple(TrackKey(frame=f, place=0j + f) for f in (0, 4, 8)))


def prepared(project):
    """Return which of all that can be prepared of a project is there."""
    runtime, clip = project.layer_runtime, project.clip
    vertices = runtime.store.vertices(clip, HALFWAY)
    return {
        "in-betweens": runtime.store.has(clip),
        "corrections": runtime.corrected.is_whole,
        "smooth playback": isinstance(vertices, StreamedVertices),
        "distortion": project.measured.curves.follows(clip),
        "extent": project.measured.extent.follows(extent_key(project.document)),
    }


def test_session_prepares_ahead_by_itself(tmp_path):
    assert Session(
        clock=lambda: 0.0, jobs=Jobs(), settings=SessionSettings(folder=tmp_path)
    ).settings.prepares_ahead


@pytest.mark.usefixtures("everything")
def test_window_prepares_everything_unasked(window, bent):
    editing.edit_document(window.session, track_commands.put_track(bent.selection.active, TRACK))
    window.settle()
    assert bent.timeline.playhead.frame == bent.clip.keys[-1].frame
    assert all(prepared(bent).values()), prepared(bent)


def test_window_of_tests_prepares_only_what_is_shown(window):
    # The tab Export asks for the extent of the motion.
    window.show_tab("Handle")
    bent = window.again(bend_bar)
    editing.edit_document(window.session, track_commands.put_track(bent.selection.active, TRACK))
    window.settle()
    assert not any(prepared(bent).values()), prepared(bent)
    playback.seek(window.session, HALFWAY)
    window.settle()
    assert bent.layer_runtime.shown.is_current
    found = prepared(bent)
    assert found.pop("in-betweens")
    assert not any(found.values()), found


@pytest.mark.usefixtures("everything")
def test_new_handle_starts_nothing_until_it_is_dragged_or_played(window, bent):
    window.settle()
    add_handle(window.session, complex(*bent.document.canvas) / 3)
    for _ in range(5):
        window.frames()
        assert not window.session.jobs.kinds
    assert bent.layer_runtime.shown.is_current
    (new,) = bent.selection.handles
    drag_handles(window.session, {new: Target(position=complex(*bent.document.canvas) / 3 + 20)})
    window.settle()
    assert bent.layer_runtime.store.has(bent.clip)
    add_handle(window.session, complex(*bent.document.canvas) / 2)
    playback.toggle_play(window.session)
    window.settle()
    assert bent.layer_runtime.store.has(bent.clip)
