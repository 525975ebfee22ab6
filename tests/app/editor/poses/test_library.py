"""Poses that are kept, and blended into others."""

from dataclasses import replace

import pytest
from animations import moving_document
from invariants import check_pose
from sessions import go, session_of, settle

from app.document import pose_commands, scene_commands
from app.document.commands import handle_commands
from app.document.commands.layers import layer_commands
from app.editor.action import do
from app.editor.actions import editing
from app.editor.poses import library
from app.editor.tools import tool_pointer
from app.storage import Preferences
from app.ui.window.action_queue import ActionQueue


@pytest.fixture
def session(tmp_path):
    """A blob that is turned and bent from frame 0 to frame 6, with two handles."""
    document = moving_document()
    for place in (40 + 45j, 80 + 45j):
        document = handle_commands.add_handle(0, place)(document)
    return session_of(document, tmp_path)


def keep(session, frame):
    go(session, frame)
    library.save_pose_to_library(session)
    settle(session)
    return session.project.layer.library[-1]


def test_an_in_between_is_kept_as_the_nearest_pose(session):
    between = keep(session, 3)
    check_pose(session.project.layer, between.pose)
    assert between.pose.certificate.is_certified
    assert session.project.layer.key_frames == {0, 6}


def test_key_saves_a_pose_while_a_widget_is_pressed_whose_edits_have_ended(session):
    document, tools = session.project.document, session.tools
    tool_pointer.note_widget_in_use(session, 5, is_pressed=True)
    editing.edit_document(session, scene_commands.set_loop(loop=not document.loop))
    session.project.history.commit()
    assert session.project.history.has_ended(tools.widget_gesture)
    go(session, 6)
    queue = ActionQueue(session, pytest.fail)
    queue.apply([replace(do(library.save_pose_to_library), is_by_key=True)])
    assert session.project.layer.library
    assert session.project.history.has_ended(tools.widget_gesture), "the widget is still pressed"
    assert tools.is_widget_pressed


@pytest.mark.parametrize("share", [0.0, 0.3, 0.7])
def test_a_blend_is_between_and_certified_and_its_beginning_is_not_forgotten(session, share):
    project = session.project
    kept = keep(session, 6)
    go(session, 0)
    first, before = project.layer.key(0).pose, project.document
    for now in (0.9, 1.0, 0.5, share):
        library.blend_library_pose(session, kept.name, now)
        settle(session)
    library.end_pose_blend(session)
    settle(session)
    pose = project.layer.key(0).pose
    check_pose(project.layer, pose)
    assert pose.certificate.is_certified
    for identity, target in pose.targets.items():
        one, other = (each.targets[identity].position for each in (first, kept.pose))
        assert target.position == pytest.approx((1 - share) * one + share * other)
    editing.undo(session)
    assert project.document is before


def test_without_auto_key_a_blend_waits_to_be_inserted(session):
    project = session.project
    kept = keep(session, 6)
    session.settings.preferences = Preferences(auto_key=False)
    go(session, 3)
    for share in (0.5, 1.0):
        library.blend_library_pose(session, kept.name, share)
        settle(session)
        library.end_pose_blend(session)
        settle(session)
        assert project.layer.key_frames == {0, 6}
        assert project.unkeyed_pose is not None
    assert project.unkeyed_pose is kept.pose
    editing.undo(session)
    editing.undo(session)
    assert project.unkeyed_pose is None


def test_names_are_not_given_twice(session):
    one, other = keep(session, 0), keep(session, 6)
    assert (one.name, other.name) == ("Pose 1", "Pose 2")
    editing.edit_layer(session, pose_commands.delete_pose, "Pose 1")
    assert keep(session, 0).name == "Pose 3"


def test_picked_pose_is_that_of_one_layer_when_names_are_alike(session):
    project = session.project
    keep(session, 6)
    first, name = project.pose_edits.picked_pose
    editing.edit_document(session, layer_commands.duplicate_layer(first))
    second = project.document.layers[-1].id
    assert project.document.layer(second).library[0].name == name
    library.apply_library_pose(session, name, second)
    assert project.pose_edits.picked_pose == (second, name)
