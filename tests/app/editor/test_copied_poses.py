"""Poses that are copied at one frame and pasted at another."""

from dataclasses import replace

import numpy as np
import pytest
from animations import moving_document
from projects import project_of

from app.document.commands import figure_commands, handle_commands
from app.document.settings import NATURAL
from app.editor import Jobs, Session
from app.editor.actions import editing, keys, playback, posing
from app.editor.actions.upkeep import maintain
from app.storage import Preferences
from engine.maps import Boundary, certify

PICTURE = np.zeros((90, 120, 4), np.uint8)


@pytest.fixture
def session(tmp_path):
    """A blob that is turned and bent from frame 0 to frame 6, with a handle."""
    document = handle_commands.add_handle(0, 60 + 45j)(moving_document())
    project = project_of(document, PICTURE, "blob")
    session = Session(clock=lambda: 0.0, jobs=Jobs(), folder=tmp_path, project=project)
    settle(session)
    return session


def settle(session):
    while True:
        maintain(session)
        if not session.jobs.kinds:
            return
        assert session.jobs.settle()
        session.jobs.deliver()


def go(session, frame):
    playback.scrub(session, frame)
    settle(session)


def test_a_pose_is_pasted_at_another_frame_as_one_step(session):
    project, before = session.project, session.project.document
    assert not keys.can_paste(session)
    go(session, 6)
    keys.copy_pose(session)
    bent = project.figure.key(6).pose
    for frame, frames in ((3, {0, 3, 6}), (0, {0, 6})):
        go(session, frame)
        keys.paste_pose(session)
        assert project.figure.key_frames == frames
        pose = project.figure.key(frame).pose
        assert (pose.phi is bent.phi, pose.psi is bent.psi) == (True, True)
        assert pose.targets == bent.targets
        assert project.chosen == {frame}
        editing.undo(session)
        assert project.document is before


def test_the_one_chosen_key_is_copied_wherever_the_playhead_is(session):
    editing.choose_keys(session, frozenset({6}))
    keys.copy_pose(session)
    assert session.copied.pose is session.project.figure.key(6).pose
    editing.choose_keys(session, frozenset({0, 6}))
    keys.copy_pose(session)
    assert session.copied.pose is session.project.figure.key(0).pose


def test_an_in_between_is_copied_as_the_nearest_pose(session):
    go(session, 3)
    between = session.project.puppet.shown.positions
    keys.copy_pose(session)
    settle(session)
    go(session, 0)
    keys.paste_pose(session)
    settle(session)
    size = np.ptp(between.real)
    np.testing.assert_allclose(
        session.project.puppet.shown.positions, between, rtol=0, atol=0.02 * size
    )


def test_a_pose_is_pasted_with_the_handles_of_now(session):
    project = session.project
    go(session, 6)
    keys.copy_pose(session)
    editing.edit(session, handle_commands.add_handle(0, 40 + 45j))
    editing.edit(session, handle_commands.remove_handles(0, frozenset({0})))
    keys.paste_pose(session)
    pose = project.figure.key(6).pose
    assert set(pose.targets) == {1}
    assert project.figure.lags(pose)[1] == pytest.approx(0.0, abs=1e-9)


def test_a_pose_is_proven_against_the_limits_of_now(session):
    project = session.project
    go(session, 6)
    keys.copy_pose(session)
    tighter = replace(NATURAL.bounds, sigma_a=1.01)
    editing.edit_figure(session, figure_commands.set_bounds, tighter)
    go(session, 3)
    keys.paste_pose(session)
    figure = project.figure
    pose = figure.key(3).pose
    boundary = Boundary.sample(figure.domain.outline, figure.domain.cage)
    assert pose.certificate == certify(figure.map_of(pose), boundary, tighter)
    assert not pose.certificate.certified


def test_a_pose_of_another_shape_cannot_be_pasted(session):
    keys.copy_pose(session)
    session.project = project_of(moving_document(), PICTURE, "other")
    before = session.project.document
    settle(session)
    assert not keys.can_paste(session)
    keys.paste_pose(session)
    assert session.project.document is before


def test_a_pose_that_no_key_holds_is_copied_and_gives_way_to_a_pasted_one(session):
    project = session.project
    session.preferences = Preferences(auto_key=False)
    go(session, 6)
    keys.copy_pose(session)
    go(session, 0)
    editing.select(session, frozenset({0}))
    posing.nudge(session, 4j)
    settle(session)
    unkeyed = project.unkeyed
    assert unkeyed is not None
    keys.paste_pose(session)
    assert project.unkeyed is None
    editing.undo(session)
    assert project.unkeyed is unkeyed
    project.chosen = frozenset()
    keys.copy_pose(session)
    assert session.copied.pose is unkeyed
