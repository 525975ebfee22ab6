"""Handles that are dragged beyond their reach: what follows and stays, and what is wanted then."""

import numpy as np
import pytest
from animations import still_document, within
from PIL import Image, ImageDraw
from sessions import run_update_steps, session_of, settle

from app.document import NATURAL, RUBBERY
from app.document.commands import handle_commands, shape_commands, stiffness_commands
from app.editor.actions import editing, playback
from app.editor.actions.posing.limb_editing import flip_selected_joints
from app.editor.actions.posing.pose_drag import solve_pose_again
from app.editor.actions.posing.reach_limit import STOPPED_AT_LIMIT
from app.editor.tools import tool_pointer
from app.editor.tools.tool import PointerHit
from engine.geometry import diameter

MOVES = 12  # of the pointer, a picture for each


def drawn(*shapes):
    """Return a picture of lines and dots with rounded ends: of places, and how thick they are."""
    image = Image.new("RGBA", (200, 160), (0, 0, 0, 0))
    draw = ImageDraw.Draw(image)
    for places, width in shapes:
        draw.line(places, (90, 140, 200, 255), width)
        for x, y in places:
            r = width / 2
            draw.ellipse((x - r, y - r, x + r, y + r), (90, 140, 200, 255))
    return np.asarray(image)


# Pictures, and where their handles are, y up.
SHAPES = {
    "person": (
        drawn(
            ([(100, 30), (100, 34)], 40),
            ([(100, 40), (100, 100)], 30),
            ([(100, 70), (30, 60)], 16),
            ([(100, 70), (170, 60)], 16),
            ([(94, 100), (80, 148)], 16),
            ([(106, 100), (120, 148)], 16),
        ),
        [172 + 100j, 28 + 100j, 80 + 12j, 120 + 12j, 100 + 130j, 100 + 70j],
    ),
    "snake": (
        drawn(([(185, 130), (150, 40), (110, 120), (70, 40), (20, 110)], 22)),
        [185 + 30j, 150 + 118j, 110 + 42j, 70 + 118j, 20 + 50j],
    ),
    "tree": (
        drawn(
            ([(60, 150), (60, 30)], 30), ([(60, 60), (180, 25)], 14), ([(60, 90), (120, 130)], 12)
        ),
        [180 + 135j, 120 + 30j, 60 + 10j, 60 + 130j],
    ),
}


@pytest.fixture(
    params=["person", *(pytest.param(name, marks=pytest.mark.long) for name in ("snake", "tree"))]
)
def session(request, tmp_path):
    """A drawing with handles, the first of which is at the end of a limb."""
    picture, places = SHAPES[request.param]
    document = still_document(picture)
    # Half of the corners do, and make poses several times as fast.
    document = within(document, document.layers[0].domain.outline[::2])
    document = shape_commands.set_limits(0, NATURAL.bounds)(document)
    for place in places:
        document = handle_commands.add_handle(0, place)(document)
    return session_of(document, tmp_path, picture)


def outwards(project):
    """Return the first handle, and the way from all others to it, as long as the drawing."""
    places = [handle.position for handle in project.layer.handles]
    away = places[0] - np.mean(places[1:])
    size = diameter(project.layer.domain.outline)
    return project.layer.handles[0].id, complex(size * away / abs(away))


def where(project):
    """Return where handles are, and the outline, in the key that is pulled."""
    layer, pose = project.layer, project.layer.key(0).pose
    f, points = layer.map_of(pose), [handle.position for handle in layer.handles]
    ids = [handle.id for handle in layer.handles]
    return dict(zip(ids, f(np.array(points)).tolist(), strict=True)), f(layer.domain.outline)


def picture(session):
    """Let one picture pass, with a step of the worker in it."""
    run_update_steps(session)
    assert session.jobs.wait_until_idle()
    session.jobs.deliver()


def drag(session, identity, way, *, rests=15):
    """Drag a handle some way, and hold it there for some pictures."""
    start = complex(where(session.project)[0][identity])
    editing.select_handles(session, frozenset({identity}))
    tool_pointer.press_pointer(session, PointerHit(place=start, handle=identity))
    for share in np.linspace(0, 1, MOVES + 1)[1:]:
        tool_pointer.move_pointer(session, start + share * way)
        picture(session)
    for _ in range(rests):
        picture(session)
    return start + way


def drag_too_far(session, **rests):
    """Drag the first handle beyond its reach; return it, where to, and where all were."""
    hand, out = outwards(session.project)
    before, _ = where(session.project)
    return hand, drag(session, hand, 1.2 * out, **rests), before


def per_mille(session, lengths):
    size = diameter(session.project.layer.domain.outline)
    return 1000 * float(np.max(np.abs(lengths))) / size


def test_a_hand_beyond_reach_moves_a_limb_and_leaves_the_rest(session):
    project = session.project
    hand, asked, before = drag_too_far(session)
    tool_pointer.release_pointer(session, asked)
    _, released = where(project)
    settle(session)
    after, rests = where(project)
    assert per_mille(session, [after[i] - before[i] for i in before if i != hand]) < 3
    assert per_mille(session, after[hand] - asked) > 50
    # Nothing creeps once the hand has let go.
    assert per_mille(session, rests - released) < 10
    # It is wanted where it came to, a hair farther out.
    wanted = project.layer.key(0).pose.targets[hand].position
    assert per_mille(session, wanted - after[hand]) < 1
    assert ((wanted - after[hand]) / (asked - after[hand])).real > 0
    (toast,) = [toast for toast in session.notices.toasts if "stopped" in toast.text]
    name = project.layer.handle(hand).name
    assert toast.text == STOPPED_AT_LIMIT.format(handle=name)
    # The whole drag is one step, and the pose is solved again from its own targets.
    solve_pose_again(session, {}, gesture=object())
    settle(session)
    assert per_mille(session, where(project)[1] - rests) < 1
    editing.undo(session)
    editing.undo(session)
    settle(session)
    assert where(project)[0] == before


@pytest.mark.parametrize("session", ["person"], indirect=True)
def test_loosen_pulls_once_more_to_where_the_hand_went(session):
    project = session.project
    hand, asked, _ = drag_too_far(session, rests=5)
    tool_pointer.release_pointer(session, asked)
    settle(session)
    short = abs(where(project)[0][hand] - asked)
    playback.scrub(session, 10)
    settle(session)
    (toast,) = [toast for toast in session.notices.toasts if "stopped" in toast.text]
    assert toast.label == "Loosen"
    toast.action.apply(session)
    settle(session)
    assert playback.current_frame(session, project) == 0
    assert project.layer.bounds == RUBBERY.bounds
    assert abs(where(project)[0][hand] - asked) < 0.7 * short


@pytest.mark.parametrize("session", ["person"], indirect=True)
def test_alt_keeps_the_target_and_forces_the_drag(session):
    project = session.project
    hand, asked, before = drag_too_far(session, rests=0)
    tool_pointer.release_pointer_forced(session, asked)
    settle(session)
    after, _ = where(project)
    assert project.layer.key(0).pose.targets[hand].position == asked
    assert per_mille(session, [after[i] - before[i] for i in before if i != hand]) > 10
    assert not [toast for toast in session.notices.toasts if "stopped" in toast.text]


@pytest.mark.parametrize("session", ["person"], indirect=True)
@pytest.mark.parametrize("rests", [0, pytest.param(2, marks=pytest.mark.long)])
def test_the_next_drag_does_not_pull_on_at_what_the_hand_has_left(session, rests):
    project = session.project
    hand, asked, before = drag_too_far(session, rests=rests)
    tool_pointer.release_pointer(session, asked)
    for _ in range(rests):
        picture(session)
    other, way = project.layer.handles[1].id, 0.03 * diameter(project.layer.domain.outline)
    tool_pointer.release_pointer(session, drag(session, other, way, rests=rests))
    settle(session)
    after, _ = where(project)
    rest = [i for i in before if i not in (hand, other)]
    assert per_mille(session, [after[i] - before[i] for i in rest]) < 3
    assert per_mille(session, after[other] - before[other] - way) < 1


@pytest.mark.parametrize("session", ["person"], indirect=True)
def test_a_drag_within_reach_is_wanted_where_it_was_let_go(session):
    project = session.project
    hand, out = outwards(project)
    asked = drag(session, hand, -0.05 * out)
    tool_pointer.release_pointer(session, asked)
    settle(session)
    assert project.layer.key(0).pose.targets[hand].position == asked
    assert per_mille(session, where(project)[0][hand] - asked) < 1
    assert not session.notices.toasts


@pytest.mark.parametrize("session", ["person"], indirect=True)
def test_a_pose_that_rests_when_the_hand_lets_go_is_kept(session):
    project = session.project
    hand, out = outwards(project)
    asked = drag(session, hand, -0.05 * out, rests=40)
    assert project.visible_drag.is_at_rest
    phi = project.layer.key(0).pose.phi
    tool_pointer.release_pointer(session, asked)
    run_update_steps(session)
    assert not project.pending.changes
    assert project.layer.key(0).pose.phi is phi
    assert project.layer.key(0).pose.targets[hand].position == asked


def test_a_hand_bends_its_arm_and_stays_within_reach(tmp_path):
    picture = drawn(([(20, 120), (180, 120)], 24))
    document = still_document(picture)
    for place in (24 + 40j, 100 + 40j, 176 + 40j):
        document = handle_commands.add_handle(0, place)(document)
    for ends in ((0, 1), (1, 2)):
        document = stiffness_commands.add_bone(0, ends, 30.0)(document)
    session = session_of(document, tmp_path, picture)
    project = session.project
    asked = drag(session, 2, 160j)
    tool_pointer.release_pointer(session, asked)
    settle(session)
    targets = project.layer.key(0).pose.targets
    root, joint, hand = (targets[i].position for i in range(3))
    assert abs(root - 24 - 40j) < 1
    assert abs(joint - root) == pytest.approx(76, abs=1)
    assert abs(hand - joint) == pytest.approx(76, abs=1.5)
    assert abs(joint - 100 - 40j) > 20
    beyond = drag(session, 2, 400j)
    tool_pointer.release_pointer(session, beyond)
    settle(session)
    assert session.notices.toasts[-1].text.endswith("stopped: its bones reach no farther.")


def arm_session(tmp_path):
    picture = drawn(([(20, 120), (100, 112), (180, 120)], 24))
    document = still_document(picture)
    for place in (24 + 40j, 100 + 48j, 176 + 40j):
        document = handle_commands.add_handle(0, place)(document)
    for ends in ((0, 1), (1, 2)):
        document = stiffness_commands.add_bone(0, ends, 10.0)(document)
    return session_of(document, tmp_path, picture)


def test_ctrl_turns_the_last_bone_alone(tmp_path):
    session = arm_session(tmp_path)
    project = session.project
    hand = complex(where(project)[0][2])
    tool_pointer.press_pointer(session, PointerHit(place=hand, handle=2))
    for share in (0.25, 0.5, 0.75, 1.0):
        tool_pointer.move_pointer_in_steps(session, hand + share * (-30 + 60j))
        run_update_steps(session)
    tool_pointer.release_pointer(session, hand - 30 + 60j)
    settle(session)
    targets = project.layer.key(0).pose.targets
    assert abs(targets[1].position - 100 - 48j) < 1.5
    assert abs(targets[2].position - targets[1].position) == pytest.approx(abs(76 - 8j), abs=1.5)
    turned = np.angle(targets[2].position - targets[1].position)
    assert turned == pytest.approx(np.angle(46 + 52j), abs=0.05)


def test_a_joint_bends_to_its_other_side_by_a_click(tmp_path):
    session = arm_session(tmp_path)
    project = session.project
    asked = drag(session, 2, -16 + 0j)
    tool_pointer.release_pointer(session, asked)
    settle(session)
    assert flip_selected_joints.why_disabled(session, project)
    editing.select_handles(session, frozenset({1}))
    assert not flip_selected_joints.why_disabled(session, project)

    def joint():
        targets = project.layer.key(0).pose.targets
        assert abs(targets[2].position - 160 - 40j) < 1
        return targets[1].position

    before = joint()
    flip_selected_joints(session)
    settle(session)
    after = joint()
    assert after == pytest.approx(before.conjugate() + 80j, abs=1.5)
    flip_selected_joints(session)
    settle(session)
    assert joint() == pytest.approx(before, abs=1.5)


@pytest.mark.parametrize("session", ["person"], indirect=True)
def test_all_handles_together_take_the_whole_drawing_along(session):
    project = session.project
    way = 0.8 * diameter(project.layer.domain.outline) * np.exp(1j)
    _, before = where(project)
    handles = [handle.id for handle in project.layer.handles]
    start = complex(where(project)[0][handles[0]])
    editing.select_handles(session, frozenset(handles))
    tool_pointer.press_pointer(session, PointerHit(place=start, handle=handles[0]))
    tool_pointer.move_pointer(session, start + way)
    tool_pointer.release_pointer(session, start + way)
    settle(session)
    assert per_mille(session, where(project)[1] - before - way) < 1
    assert not session.notices.toasts
