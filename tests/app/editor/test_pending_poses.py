"""A pending change of the document ends when the document refuses it, and is reported once."""

from dataclasses import replace

import pytest
from sessions import run_update_steps, session_of, settle
from still_poses import posed
from unrest import is_shown, unrest

from app.document import cycle_commands, scene_commands
from app.document.keyframe import Target
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.inserting import insert_key
from app.editor.actions.posing.pose_commit import NO_POSE
from app.editor.actions.posing.pose_drag import drag_handles, free_rotation, set_targets
from app.editor.actions.posing.pose_lifecycle import candidate_clips
from app.editor.layering.layer_list import duplicate_layer
from app.editor.layering.parenting import delete_layers

ROUNDS = 50  # of work until all is at rest, at most


@pytest.fixture
def session(tmp_path):
    return session_of(posed(2), tmp_path)


def test_refused_pose_is_reported_once(session):
    project = session.project
    last = project.layer.keys[-1].frame
    frames = replace(project.document.frames, last=last + 20)
    project.history.do(scene_commands.set_frames(frames))
    playback.scrub(session, last + 5)
    handle = project.layer.handles[0]
    with session.jobs.held():
        set_targets(session, {handle.id: Target(position=handle.position + 9)})
        run_update_steps(session)
        project.history.do(cycle_commands.set_cycle(0, 0, last + 2))
    settle(session)
    settle(session)
    (toast,) = session.notices.toasts
    assert toast.text.startswith(NO_POSE)
    assert not project.pending
    assert project.layer_runtime.shown.clip == project.clip


def begun_pull(session):
    """Pull a handle of the last key until the document has the first pose of it."""
    project = session.project
    playback.scrub(session, project.layer.keys[-1].frame)
    handle = project.layer.handles[0]
    set_targets(session, {handle.id: Target(position=handle.position + 9)})
    run_update_steps(session)
    (pull,) = project.pulls
    while pull.kept is None or pull.kept is pull.before:
        assert session.jobs.wait_until_idle()
        session.jobs.deliver()
        run_update_steps(session)
    # The hand lets go, and the in-betweens of an earlier pose are there.
    pull.is_held, pull.ready = False, replace(pull.kept, phi=pull.kept.phi.copy())
    return pull


def test_undone_pull_has_its_newest_pose_and_no_other(session):
    project = session.project
    pull = begun_pull(session)
    with session.jobs.held():
        editing.undo(session)
        playback.scrub(session, 0)
        run_update_steps(session)
        later = [step.document for step in project.history._steps]
        run_update_steps(session)
    assert not pull.is_in(project.history)
    assert pull.kept is pull.newest
    now = [step.document for step in project.history._steps]
    assert all(document is before for document, before in zip(now, later, strict=True))


def test_pull_of_a_removed_layer_lets_its_copy_rest(session):
    project, original = session.project, session.project.active
    pull = begun_pull(session)
    with session.jobs.held():
        duplicate_layer(session, original)
        delete_layers(session, original)
        assert not pull.is_in(project.history)
        assert any(pose.phi is pull.kept.phi for pose in project.layer.poses)
        playback.scrub(session, 5)
        insert_key(session)
        run_update_steps(session)
    for _ in range(ROUNDS):
        assert session.jobs.wait_until_idle()
        session.jobs.deliver()
        run_update_steps(session)
    assert is_shown(session), unrest(session)
    assert not project.pending, unrest(session)
    assert 5 in project.layer.key_frames


def test_clip_of_a_tried_pose_is_made_once_for_a_document(session):
    pull = begun_pull(session)
    with session.jobs.held():
        pull.tried = pull.ready
        (clip,) = candidate_clips(session.project)
        assert candidate_clips(session.project) == [clip]
        assert candidate_clips(session.project)[0] is clip
        assert any(key.pose.phi is pull.tried.phi for key in clip.keys)
        pull.tried = pull.newest
        assert candidate_clips(session.project)[0] is not clip


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
