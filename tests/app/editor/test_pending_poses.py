"""A pending change of the document ends when the document refuses it, and is reported once."""

from dataclasses import replace

import pytest
from sessions import run_update_steps, session_of, settle
from still_poses import posed
from unrest import is_shown, unrest

from app.document import cycle_commands, scene_commands
from app.document.keyframe import Target
from app.editor import pending_changes
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.inserting import INSERTING, insert_key
from app.editor.actions.posing.pose_drag import (
    drag_handles,
    free_rotation,
    release_drag,
    set_targets,
)
from app.editor.layering.deletion import delete_layers
from app.editor.layering.layer_list import duplicate_layer
from app.errors import LissomError


@pytest.fixture
def session(tmp_path):
    return session_of(posed(2), tmp_path)


def test_command_is_refused_if_an_unfinished_drag_rules_it_out(session):
    project = session.project
    last = project.layer.keys[-1].frame
    frames = replace(project.document.frames, last=last + 20)
    project.history.do(scene_commands.set_frames(frames))
    playback.scrub(session, last + 5)
    handle = project.layer.handles[0]
    with session.jobs.held():
        set_targets(session, {handle.id: Target(position=handle.position + 9)})
        with pytest.raises(LissomError, match=f"key at frame {last + 5}"):
            project.history.do(cycle_commands.set_cycle(0, 0, last + 2))
    settle(session)
    assert not project.pending.changes
    assert last + 5 in project.layer.key_frames
    assert project.layer_runtime.shown.clip == project.clip


def begun_drag(session):
    """Drag a handle of the last key until a pose of it is shown, and let go."""
    project = session.project
    playback.scrub(session, project.layer.keys[-1].frame)
    handle = project.layer.handles[0]
    set_targets(session, {handle.id: Target(position=handle.position + 9)})
    while project.drag.preview is None:
        run_update_steps(session)
        assert session.jobs.wait_until_idle()
        session.jobs.deliver()
    assert not project.drag.is_at_rest
    return project.drag


def test_undo_of_an_unfinished_drag_can_be_redone(session):
    project = session.project
    before = project.document
    drag = begun_drag(session)
    editing.undo(session)
    assert project.document is before
    assert project.drag is None
    editing.redo(session)
    assert project.layer.keys[-1].pose is drag.newest
    assert drag.is_at_rest


def test_duplicate_of_a_dragged_layer_has_its_pose_at_rest(session):
    project, original = session.project, session.project.selection.active
    drag = begun_drag(session)
    duplicate_layer(session, original)
    delete_layers(session, original)
    assert project.layer.keys[-1].pose.phi is drag.newest.phi
    playback.scrub(session, 5)
    insert_key(session)
    settle(session)
    assert is_shown(session), unrest(session)
    assert 5 in project.layer.key_frames


def test_moves_of_a_drag_that_a_command_ended_are_void(session):
    project, handle = session.project, session.project.layer.handles[0]
    drag_handles(session, {handle.id: Target(position=handle.position + 9)}, gesture="drag")
    settle(session)
    assert project.history.is_held
    project.history.do(scene_commands.set_fps(31))
    document = project.document
    drag_handles(session, {handle.id: Target(position=handle.position + 20)}, gesture="drag")
    settle(session)
    assert project.document is document
    assert project.layer.keys[0].pose.targets[handle.id].position == handle.position + 9


def test_result_of_a_worker_waits_for_a_drag(session):
    project, handle = session.project, session.project.layer.handles[0]
    drag_handles(session, {handle.id: Target(position=handle.position + 9)}, gesture="drag")
    taken = []
    pending_changes.begin_pending_change(
        session, project, INSERTING, lambda: 1, lambda _: taken.append(project.drag)
    )
    settle(session)
    assert project.history.is_held
    assert not taken
    release_drag(session)
    settle(session)
    pending_changes.run_deferred_actions(session)
    assert taken == [None]


def test_turn_of_a_handle_that_came_later_is_left_out(session):
    project = session.project
    playback.scrub(session, 5)
    with session.jobs.held():
        handle = project.layer.handles[0]
        targets = {handle.id: Target(position=handle.position + 9)}
        drag_handles(session, targets, gesture="drag")
        add_handle(session, complex(project.layer.domain.mesh.vertices[0]))
        free_rotation(session, project.layer.handles[-1].id)
    settle(session)
    assert not [toast.text for toast in session.notices.toasts]
