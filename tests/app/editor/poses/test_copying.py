"""Poses that are copied at one frame and pasted at another."""

from dataclasses import replace

import numpy as np
import pytest
from animations import PARTED, moving_document
from invariants import check_pose
from projects import project_of
from sessions import BLANK, go, session_of, settle

from app.document import HOLD, channel_commands, pose_channel
from app.document.commands import handle_commands, shape_commands
from app.document.settings import NATURAL
from app.editor.actions import editing
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.poses import copying, pasting, pasting_targets
from app.storage import Preferences
from engine.maps import Boundary, certify


@pytest.fixture
def session(tmp_path):
    """A blob that is turned and bent from frame 0 to frame 6, with a handle."""
    document = handle_commands.add_handle(0, 60 + 45j)(moving_document())
    return session_of(document, tmp_path)


def test_a_pose_is_pasted_at_another_frame_as_one_step(session):
    project, before = session.project, session.project.document
    assert (
        pasting.paste_disabled_reason(session, project, "as it is") == "Copy a pose or keys first."
    )
    go(session, 6)
    copying.copy_pose_or_keys(session)
    bent = project.layer.key(6).pose
    for frame, frames in ((3, {0, 3, 6}), (0, {0, 6})):
        go(session, frame)
        pasting.paste_copied(session)
        assert project.layer.key_frames == frames
        pose = project.layer.key(frame).pose
        assert (pose.phi is bent.phi, pose.psi is bent.psi) == (True, True)
        assert pose.targets == bent.targets
        assert project.selection.frames == {frame}
        editing.undo(session)
        assert project.document is before


def test_in_the_timeline_the_one_chosen_key_is_copied_wherever_the_playhead_is(session):
    editing.select_keys(session, frozenset({6}))
    for session.display.is_timeline_focused, frame in ((True, 6), (False, 0)):
        copying.copy_pose_or_keys(session)
        assert session.clipboard.poses[0].keys[0].pose is session.project.layer.key(frame).pose


def test_several_keys_are_pasted_with_their_ways_and_distances(session):
    project = session.project
    editing.edit_document(session, channel_commands.set_easing({pose_channel(0): {0}}, HOLD))
    before = project.document
    editing.select_keys(session, frozenset({0, 6}))
    copying.copy_keys(session)
    go(session, 4)
    pasting.paste_copied(session)
    assert project.layer.key_frames == {0, 4, 6, 10}
    assert project.selection.frames == {4, 10}
    assert project.layer.key(4).pose is project.layer.key(0).pose
    assert project.layer.key(4).easing == HOLD
    assert project.layer.key(10).pose is project.layer.key(6).pose
    assert project.history.undo_label == "Paste keys"
    editing.undo(session)
    assert project.document is before


def test_only_the_selected_handles_take_what_was_copied(session):
    project = session.project
    editing.edit_document(session, handle_commands.add_handle(0, 40 + 45j))
    go(session, 6)
    copying.copy_pose_or_keys(session)
    bent = project.layer.key(6).pose.targets
    go(session, 0)
    assert "Select" in pasting_targets.paste_on_selected_disabled_reason(
        session, project, "as it is"
    )
    editing.select_handles(session, frozenset({1}))
    pasting_targets.paste_on_selected(session)
    settle(session)
    targets = project.layer.key(0).pose.targets
    assert targets[1].position == bent[1].position
    assert targets[0].position == pytest.approx(60 + 45j, abs=1e-9)
    check_pose(project.layer, project.layer.key(0).pose)


def test_an_in_between_is_copied_as_the_nearest_pose(session):
    go(session, 3)
    between = session.project.layer_runtime.shown.positions
    copying.copy_pose_or_keys(session)
    settle(session)
    go(session, 0)
    pasting.paste_copied(session)
    settle(session)
    size = np.ptp(between.real)
    np.testing.assert_allclose(
        session.project.layer_runtime.shown.positions, between, rtol=0, atol=0.02 * size
    )


def test_a_pose_is_pasted_with_the_handles_of_now(session):
    project = session.project
    go(session, 6)
    copying.copy_pose_or_keys(session)
    editing.edit_document(session, handle_commands.add_handle(0, 40 + 45j))
    editing.edit_document(session, handle_commands.remove_handles(0, frozenset({0})))
    pasting.paste_copied(session)
    pose = project.layer.key(6).pose
    assert set(pose.targets) == {1}
    assert project.layer.target_errors(pose)[1] == pytest.approx(0.0, abs=1e-9)


def test_a_pose_is_proven_against_the_limits_of_now(session):
    project = session.project
    go(session, 6)
    copying.copy_pose_or_keys(session)
    tighter = replace(NATURAL.bounds, sigma_a=1.01)
    editing.edit_layer(session, shape_commands.set_limits, tighter)
    go(session, 3)
    pasting.paste_copied(session)
    layer = project.layer
    pose = layer.key(3).pose
    boundary = Boundary.sample(layer.domain)
    assert pose.certificate == certify(layer.map_of(pose), boundary, tighter)
    assert not pose.certificate.is_certified


def test_a_pose_of_another_shape_cannot_be_pasted(session):
    copying.copy_pose_or_keys(session)
    session.project = project_of(moving_document(cut_out=PARTED), BLANK, "other")
    before = session.project.document
    settle(session)
    assert "no handle called" in pasting.paste_disabled_reason(session, session.project, "as it is")
    pasting.paste_copied(session)
    assert session.project.document is before


def test_a_pose_that_no_key_holds_is_copied_and_gives_way_to_a_pasted_one(session):
    project = session.project
    session.settings.preferences = Preferences(auto_key=False)
    go(session, 6)
    copying.copy_pose_or_keys(session)
    go(session, 0)
    editing.select_handles(session, frozenset({0}))
    nudge_handles(session, 4j)
    settle(session)
    unkeyed = project.unkeyed_pose
    assert unkeyed is not None
    pasting.paste_copied(session)
    assert project.unkeyed_pose is None
    editing.undo(session)
    assert project.unkeyed_pose is unkeyed
    project.selection.deselect_keys()
    copying.copy_pose_or_keys(session)
    assert session.clipboard.poses[0].keys[0].pose is unkeyed
