"""Moving a layer as a whole: exactly as it is, with all that it wants."""

from dataclasses import replace

import numpy as np
import pytest
from animations import moving_document, round_document
from sessions import run_update_steps, session_of, settle

from app.document.commands import handle_commands, shape_commands
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.layering.layer_list import duplicate_layer, toggle_layers_locked
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import attach_layer
from app.editor.tools import move_tool, tool_pointer
from app.editor.tools.tool import PointerHit
from app.storage import Preferences
from app.ui.viewport.marks import find_off_target

LEFT, RIGHT, BESIDE = 40 + 45j, 80 + 45j, 5 + 5j
WAY = 30 - 12j


def with_handles(document):
    for place in (LEFT, RIGHT):
        document = handle_commands.add_handle(0, place)(document)
    return document


@pytest.fixture(scope="module")
def blob():
    return with_handles(round_document())


@pytest.fixture(scope="module")
def pulled(blob, tmp_path_factory):
    """A blob with two handles, one of which is pulled beyond its reach, at frame 0."""
    session = session_of(blob, tmp_path_factory.mktemp("pulled"))
    set_targets(session, {1: replace(target(session, 1), position=RIGHT + 70)})
    settle(session)
    return session.project.document


@pytest.fixture
def session(pulled, tmp_path):
    return session_of(pulled, tmp_path)


def pose_of(session, number=0):
    return session.project.layer.keys[number].pose


def target(session, identity):
    return pose_of(session).targets[identity]


def drag(session, way=WAY, *, end=True, **held):
    spot = PointerHit(place=BESIDE, **held)
    tool_pointer.press_pointer(session, spot)
    for share in (0.3, 0.7, 1.0):
        tool_pointer.move_pointer(session, spot.place + share * way)
        run_update_steps(session)
    if end:
        tool_pointer.release_pointer(session, spot.place + way)
    run_update_steps(session)


def is_moved(session, pose, before, way):
    """Tell whether a pose is another one, moved, and nothing else."""
    f, g = (session.project.layer.map_of(each) for each in (pose, before))
    places = session.project.layer.domain.mesh.vertices
    np.testing.assert_allclose(f(places), g(places) + way, rtol=0, atol=1e-9)
    assert pose.targets.keys() == before.targets.keys()
    for identity, wanted in pose.targets.items():
        assert abs(wanted.position - before.targets[identity].position - way) < 1e-9
        assert wanted.rotation == before.targets[identity].rotation
    assert pose.certificate == before.certificate
    return True


def test_a_drag_from_beside_moves_all_of_it_in_one_step(session):
    document, before = session.project.document, pose_of(session)
    drag(session, ctrl=True, shift=True)
    assert is_moved(session, pose_of(session), before, WAY), "at once, not as a solver finds it"
    assert not session.project.pending.changes
    settle(session)
    assert is_moved(session, pose_of(session), before, WAY)
    assert session.project.history.undo_label == "Move"
    editing.undo(session)
    assert session.project.document is document
    editing.redo(session)
    assert is_moved(session, pose_of(session), before, WAY)


@pytest.mark.parametrize("at", [{"handle": 0}, {"on_shape": True}, {}])
def test_with_the_tool_it_does_so_from_anywhere(session, at):
    before = pose_of(session)
    move_tool.toggle_move_tool(session)
    drag(session, **at)
    assert is_moved(session, pose_of(session), before, WAY)
    assert len(session.project.layer.handles) == 2
    move_tool.return_to_posing(session)
    tool_pointer.press_pointer(session, PointerHit(place=LEFT, handle=0))
    assert type(session.tools.active_tool).__name__ == "PoseTool"


def test_ctrl_click_still_sets_the_anchor(session):
    move_tool.toggle_move_tool(session)
    tool_pointer.press_pointer(session, PointerHit(place=LEFT + 5j, on_shape=True, ctrl=True))
    assert session.project.layer.anchor is not None


def test_escape_in_the_middle_takes_it_back(session):
    project, document = session.project, session.project.document
    before = find_off_target(project, project.layer_runtime.shown)
    assert before
    drag(session, end=False, ctrl=True, shift=True)
    assert project.document is not document
    marked = find_off_target(project, project.layer_runtime.shown)
    assert marked == pytest.approx({i: place + WAY for i, place in before.items()})
    tool_pointer.cancel_tool(session)
    settle(session)
    assert project.document is document
    assert not project.pending.changes


def test_numbers_and_axes_are_typed(session):
    before = pose_of(session)
    move_tool.toggle_move_tool(session)
    tool_pointer.press_pointer(session, PointerHit(place=LEFT))
    tool_pointer.type_in_tool(session, "y40")
    tool_pointer.release_pointer(session, LEFT)
    settle(session)
    # Pixels are counted downwards.
    assert is_moved(session, pose_of(session), before, -40j)


def test_each_arrow_is_a_step(session):
    project, before, document = session.project, pose_of(session), session.project.document
    for step in (1, 10j, -1):
        move_tool.nudge_layer(session, step)
        run_update_steps(session)
    assert is_moved(session, pose_of(session), before, 10j)
    for _ in range(3):
        editing.undo(session)
    assert project.document is document


@pytest.fixture
def joined(blob, tmp_path):
    """Two blobs: the second is attached to the first, and is posed."""
    session = session_of(blob, tmp_path)
    session.project.history.do(shape_commands.set_anchor(0, LEFT))
    settle(session)
    duplicate_layer(session, 0)
    attach_layer(session, 1, 0)
    set_active_layer(session, 1)
    settle(session)
    return session


def places_of(session, layer):
    """Where all points of a layer are in the scene."""
    shown = session.project.runtimes.layers[layer].shown
    return shown.placement.apply(shown.positions)


def test_layer_moves_its_root_parent(joined):
    project, before = joined.project, [places_of(joined, layer) for layer in (0, 1)]
    drag(joined, end=False, ctrl=True, shift=True)
    settle(joined)
    assert project.selection.active == 0
    for layer in (0, 1):
        np.testing.assert_allclose(places_of(joined, layer), before[layer] + WAY, atol=1e-3)
    tool_pointer.cancel_tool(joined)
    settle(joined)
    assert project.selection.active == 1
    np.testing.assert_allclose(places_of(joined, 1), before[1], atol=1e-3)
    move_tool.nudge_layer(joined, 4)
    settle(joined)
    assert project.selection.active == 0
    np.testing.assert_allclose(places_of(joined, 1), before[1] + 4, atol=1e-3)


def test_layer_stays_when_its_parent_is_locked(joined):
    toggle_layers_locked(joined, 0)
    document = joined.project.document
    drag(joined, ctrl=True, shift=True)
    move_tool.nudge_layer(joined, 1)
    assert joined.project.document is document
    assert "is locked" in joined.notices.toasts[-1].text


def test_the_layer_that_is_pressed_moves_and_no_other(blob, tmp_path):
    session = session_of(blob, tmp_path)
    duplicate_layer(session, 0)
    set_active_layer(session, 0)
    settle(session)
    move_tool.toggle_move_tool(session)
    before = places_of(session, 0)
    drag(session, layer=1, on_shape=True)
    settle(session)
    assert session.project.selection.active == 1
    np.testing.assert_allclose(places_of(session, 0), before, atol=1e-6)
    assert session.project.history.undo_label == "Move"


def test_an_arrow_is_undone_before_it_is_seen(session):
    project, before, document = session.project, pose_of(session), session.project.document
    move_tool.nudge_layer(session, 10)
    editing.undo(session)
    assert project.document is document
    editing.redo(session)
    assert is_moved(session, pose_of(session), before, 10)


def test_a_drawing_without_handles_moves_too(tmp_path):
    session = session_of(round_document(), tmp_path)
    before = pose_of(session)
    drag(session, ctrl=True, shift=True)
    assert is_moved(session, pose_of(session), before, WAY)


@pytest.mark.parametrize("auto_key", [True, False])
@pytest.mark.parametrize("is_there", [True, False])
def test_an_in_between_becomes_a_pose_of_its_own(tmp_path, auto_key, is_there):
    """Also where it was not worked out yet when the hand began."""
    session = session_of(with_handles(moving_document(6)), tmp_path)
    session.settings.preferences = Preferences(auto_key=auto_key)
    settle(session)
    project = session.project
    playback.seek(session, 3)
    if is_there:
        settle(session)
    middle = project.layer_runtime.shown.handle_positions.mean()
    drag(session, ctrl=True, shift=True)
    settle(session)
    frames = [key.frame for key in project.layer.keys]
    assert frames == ([0, 3, 6] if auto_key else [0, 6])
    assert (project.unkeyed_pose is None) == auto_key
    if is_there:
        moved = project.layer_runtime.shown.handle_positions.mean()
        assert abs(moved - middle - WAY) < 0.01 * abs(WAY)
    editing.undo(session)
    assert [key.frame for key in project.layer.keys] == [0, 6]
    assert project.unkeyed_pose is None


def test_a_pose_on_its_way_gets_there_elsewhere(blob, tmp_path):
    """The hand lets a handle go, and moves all of it before the pose has come to rest."""
    session = session_of(blob, tmp_path)
    targets = {1: replace(target(session, 1), position=RIGHT + 12j)}
    set_targets(session, targets)
    settle(session)
    rested = pose_of(session)
    editing.undo(session)
    set_targets(session, targets)
    run_update_steps(session)
    assert session.jobs.wait_until_idle()
    session.jobs.deliver()
    assert session.project.pending.changes
    drag(session, ctrl=True, shift=True)
    settle(session)
    now = pose_of(session)
    for identity, wanted in now.targets.items():
        assert abs(wanted.position - rested.targets[identity].position - WAY) < 1e-9
    np.testing.assert_allclose(now.phi, rested.phi + WAY, atol=0.2)


def test_a_handle_is_pulled_on_after_that(session):
    drag(session, ctrl=True, shift=True)
    set_targets(session, {0: replace(target(session, 0), position=LEFT + WAY + 5)})
    settle(session)
    assert abs(target(session, 0).position - (LEFT + WAY + 5)) < 1e-9
    assert abs(target(session, 1).position - (RIGHT + 70 + WAY)) < 1e-9
