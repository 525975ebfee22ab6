"""What the hand does while another pose stands in for the in-between at the playhead."""

from dataclasses import replace

import numpy as np
import pytest
from bars import HALF, LAST, bend_bar

from app.document import shape_commands
from app.document.commands.keys import (
    key_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.posing.inserting import insert_key
from app.editor.actions.posing.pose_commit import POSING
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.actions.posing.pose_solver import step_pose_solver
from app.editor.actions.project_files import export_settings
from app.motion import Animation

FRAME, TURN = HALF, np.exp(0.5j)
WAY = 30 - 20j  # pixels of the picture


def bend_by_nu(window):
    """Bend the bar loosely: which in-between it is that is awaited is not asked."""
    window.again(bend_bar, LAST, "loose")
    editing.edit_layer(window.session, shape_commands.set_variant, "nu")
    window.settle()


@pytest.fixture
def bent(window, request):
    return window.again(*getattr(request, "param", (bend_by_nu,)))


@pytest.fixture
def come(monkeypatch, window, bent):
    """What lets the workers' results come; until then a key stands in at the playhead."""
    deliver = window.session.jobs.deliver
    monkeypatch.setattr(window.session.jobs, "deliver", lambda: None)
    pose = bent.layer.key(LAST).pose
    turned = replace(pose, phi=TURN * pose.phi, psi=pose.psi / TURN)
    editing.edit_document(
        window.session, key_commands.replace_key_pose(bent.selection.active, LAST, turned)
    )
    playback.scrub(window.session, FRAME)
    window.frames(2)
    assert bent.layer_runtime.shown.placeholder in [key.pose for key in bent.layer.keys]

    def let_come(*, settles=True):
        monkeypatch.setattr(window.session.jobs, "deliver", deliver)
        if settles:
            window.settle()

    return let_come


def in_between(project):
    """Return where the handles are in the in-between that is awaited."""
    rest = np.array([handle.position for handle in project.layer.handles])
    return Animation(project.clip, points=rest).positions(FRAME)


def pixel(window, project):
    """Return how far a pixel of the screen is in the picture: pointers are at whole ones."""
    return 1.5 / project.view_on(window.session.display.screen).scale


def drag(robot, window, project):
    place = complex(project.layer_runtime.shown.handle_positions[1])
    robot.mouse_move_to_pos(window.point(place))
    robot.mouse_down(0)
    robot.mouse_move_to_pos(window.point(place + WAY / 2))
    robot.mouse_move_to_pos(window.point(place + WAY))


# Where another handle stays, too, so that the frame is corrected.
@pytest.mark.parametrize("bent", [(bend_bar, LAST)], indirect=True)
def test_a_handle_moves_as_far_as_the_pointer_did_meanwhile(window, bent, come):
    before = bent.document
    window.frames(2)
    assert window.awaits_worker

    def play(robot):
        drag(robot, window, bent)
        # Nothing is pulled out of a pose that is not the one of this frame.
        assert bent.document is before
        assert bent.visible_drag.solver is None
        # The hand is to be followed.
        assert not window.awaits_worker
        come(settles=False)
        while bent.visible_drag.solver is None:
            robot.yield_(1)
        assert bent.history.is_held
        robot.mouse_up(0)

    window.run(play)
    come()
    targets = bent.layer.key(FRAME).pose.targets
    editing.undo(window.session)
    assert bent.document is before
    window.settle()
    wanted = in_between(bent) + np.array([0, WAY])
    np.testing.assert_allclose(
        [targets[i].position for i in (0, 1)], wanted, atol=pixel(window, bent)
    )


def test_neither_a_drag_that_is_over_nor_steps_are_lost(window, bent, come):
    def play(robot):
        drag(robot, window, bent)
        robot.mouse_up(0)

    window.run(play)
    bent.selection.handles = frozenset({1})
    for _ in range(3):
        window.act(nudge_handles, 5j)
    assert FRAME not in bent.layer.key_frames
    come()
    target = bent.layer.key(FRAME).pose.targets[1]
    while FRAME in bent.layer.key_frames:
        editing.undo(window.session)
    window.settle()
    assert abs(target.position - in_between(bent)[1] - WAY - 15j) < pixel(window, bent)


def test_a_turn_goes_on_from_the_in_between(window, bent, come):
    bent.selection.handles = frozenset({1})
    window.frames(2)

    def turn(robot):
        centre = complex(bent.layer_runtime.shown.handle_positions[1])
        arm = window.ring(bent)
        robot.mouse_move_to_pos(window.point(centre + arm))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(centre + arm * np.exp(0.2j)))
        robot.mouse_move_to_pos(window.point(centre + arm * np.exp(0.4j)))
        robot.mouse_up(0)

    window.run(turn)
    come()
    target = bent.layer.key(FRAME).pose.targets[1]
    editing.undo(window.session)
    window.settle()
    turned = bent.layer_runtime.shown.handle_rotations[1]
    assert abs(target.position - in_between(bent)[1]) < 1.0
    assert target.rotation - turned == pytest.approx(0.4, abs=0.05)


def test_it_is_taken_back_before_it_began(window, bent, come):
    before = bent.document

    def play(robot, *, escapes=False):
        drag(robot, window, bent)
        assert bent.visible_drag is not None
        if escapes:
            robot.key_press(int(window.Key.escape))
        robot.mouse_up(0)

    window.run(lambda robot: play(robot, escapes=True))
    assert bent.drag is None
    window.run(play)
    window.act(editing.undo)
    assert bent.drag is None
    come()
    assert bent.document is before


@pytest.mark.parametrize(
    "leave",
    [
        lambda session: playback.scrub(session, 2),
        playback.toggle_play,
        export_settings.ask_destination_and_export,
        insert_key,
    ],
)
def test_it_is_not_lost_where_something_else_follows(window, bent, come, leave):
    before = bent.document
    window.run(lambda robot: (drag(robot, window, bent), robot.mouse_up(0)))
    window.act(leave)
    window.session.dialogs.current = None
    come()
    window.until(lambda: bent.drag is None)
    playback.stop_playback(window.session)
    target = bent.layer.key(FRAME).pose.targets[1]
    assert bent.layer.target_errors(bent.layer.key(FRAME).pose)[1] < 1.0
    while bent.document is not before:
        editing.undo(window.session)
    playback.scrub(window.session, FRAME)
    window.settle()
    assert abs(target.position - in_between(bent)[1] - WAY) < pixel(window, bent)


def test_a_pose_for_which_a_command_waits_does_not_wait_for_the_shown_frame(window, bent, come):
    window.run(lambda robot: (drag(robot, window, bent), robot.mouse_up(0)))
    playback.scrub(window.session, 2)
    window.frames(2)
    jobs = window.session.jobs
    jobs.drop(POSING)
    step_pose_solver(window.session, bent)
    assert POSING not in jobs.kinds
    bent.drag.note_awaited()
    step_pose_solver(window.session, bent)
    assert POSING in jobs.kinds
    come()
    assert bent.drag is None


@pytest.mark.usefixtures("everything")
def test_undo_and_redo_need_not_wait(window, bent):
    playback.scrub(window.session, FRAME)
    for turn in (TURN, TURN**2):
        pose = bent.layer.key(LAST).pose
        turned = replace(pose, phi=turn * pose.phi, psi=pose.psi / turn)
        editing.edit_document(
            window.session, key_commands.replace_key_pose(bent.selection.active, LAST, turned)
        )
        window.settle()
    documents = bent.history.nearby
    for step in (editing.undo, editing.redo, editing.undo):
        step(window.session)
        assert bent.document in documents
        assert bent.layer_runtime.store.has(bent.clip)
    # What leads on from here is worked out, and then nothing of the way back is lost.
    editing.undo(window.session)
    window.settle()
    editing.redo(window.session)
    assert bent.layer_runtime.store.has(bent.clip)
