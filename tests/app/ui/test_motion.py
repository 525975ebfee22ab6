"""A drawing is given a motion: its joints by hand, the motion by buttons, and all of it again."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from overlapping_legs import draw_person
from silhouettes import paint

from app.document import find_motion_edits, is_motion_unedited, shape_commands
from app.editor import pending_changes
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup.cut_out_editing import remove_knife_cut
from app.editor.actions.posing.handles import remove_handles, suggest_handles
from app.editor.actions.posing.motion_presets import (
    apply_motion,
    joint_placement,
    preset_setup,
    rigging,
)
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.project_files import saving
from app.editor.actions.updates.stage_jobs import GLIMPSING, REFINING, SKETCHING
from app.editor.tools import move_tool
from app.storage.project_file import load_project
from app.ui.panel import is_in_front


def open_child(window):
    """Open a child in a picture."""
    return window.open(paint(window.folder, "child"))


def breathing(window):
    """Let a ghost breathe: the simplest of motions."""
    project = window.open(paint(window.folder, "ghost"))
    draft_motion(window)
    preset_setup.set_motion_parameters(window.session, speed=3.0)
    apply_motion.apply_motion_preset(window.session)
    arrive(window, project)
    playback.stop_playback(window.session)
    window.frames(2)
    return project


def draft_motion(window):
    preset_setup.begin_motion_setup(window.session)
    window.settle()


def arrive(window, project):
    window.until(lambda: project.motion_job is None and pending_changes.is_document_idle(project))
    window.settle()


@pytest.fixture
def child(window):
    """Open a child in a picture, and draft a motion for it."""
    project = window.again(open_child)
    draft_motion(window)
    return project


@pytest.fixture
def ghost(window):
    return window.again(breathing)


def press(window, place, *, to=None, key=None):
    def act(robot):
        robot.mouse_move_to_pos(window.point(place))
        if key is not None:
            robot.key_down(key)
        robot.mouse_down(0)
        if to is not None:
            for share in (0.3, 0.7, 1.0):
                robot.mouse_move_to_pos(window.point(place + share * (to - place)))
        robot.mouse_up(0)
        if key is not None:
            robot.key_up(key)

    window.run(act)
    window.frames(2)


def click(window, item):
    window.run(lambda robot: robot.item_click(item))
    window.frames(3)


def test_a_dropped_picture_walks_after_few_clicks_and_drags(window, tmp_path):
    window.program.take_dropped([paint(tmp_path, "walker", size=160)])
    window.settle()
    project = window.session.project
    before = project.document
    # Whatever tab was in front, the motion's own comes there.
    window.show_tab("Handle")
    entry = "//##MainMenuBar/Animate/Apply motion preset…"
    window.run(lambda robot: robot.menu_click(entry))
    window.settle()
    assert is_in_front("Animate")
    assert (window.session.tools.motion_setup.kind, window.session.tools.motion_setup.motion) == (
        "biped-side",
        "walk",
    )
    foot = window.session.tools.motion_setup.joints["foot.L"]
    press(window, foot, to=foot + 3)
    assert window.session.tools.motion_setup.joints["foot.L"].real == pytest.approx(
        foot.real + 3, abs=2
    )
    preset_setup.set_motion_parameters(window.session, size=0.5, speed=4.0)
    assert project.document is before, "nothing is done to it yet"
    click(window, "//Animate/**/###give")
    arrive(window, project)
    assert project.layer.motions, [toast.text for toast in window.session.notices.toasts]
    assert project.timeline.playhead.since is not None, "it plays"
    assert project.document.loop
    (given,) = project.layer.motions
    assert given.motion == "walk"
    assert project.document.frames.last == given.last == project.layer.keys[-1].frame
    handles = {handle.name for handle in project.layer.handles}
    assert handles == set(given.joints)
    places = [each.pose.targets[given.joints["foot.L"]].position for each in project.layer.keys]
    assert np.ptp(np.real(places)) > 4
    editing.undo(window.session)
    assert project.document is before, "one step"


def test_joints_are_dragged_left_out_and_put_back(window, child):
    before = child.document
    hand = window.session.tools.motion_setup.joints["hand.L"]
    press(window, hand, to=hand - 12)
    assert abs(window.session.tools.motion_setup.joints["hand.L"] - (hand - 12)) < 3
    press(window, window.session.tools.motion_setup.joints["elbow.L"], key=window.Key.mod_ctrl)
    assert "elbow.L" not in window.session.tools.motion_setup.joints
    press(window, window.session.tools.motion_setup.joints["head"])
    window.run(lambda robot: robot.key_press(int(window.Key.delete)))
    assert "head" not in window.session.tools.motion_setup.joints
    click(window, "//Animate/**/joint head")
    assert "head" in window.session.tools.motion_setup.joints
    for _ in range(4):
        window.run(lambda robot: robot.key_press(int(window.Key.mod_ctrl | window.Key.z)))
    assert window.session.tools.motion_setup.joints["hand.L"] == hand
    assert "elbow.L" in window.session.tools.motion_setup.joints
    assert child.document is before
    window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    assert window.session.tools.motion_setup is None
    assert window.session.tools.is_posing
    assert child.document is before


@pytest.mark.usefixtures("child")
def test_one_side_is_mirrored_onto_the_other(window):
    joints = window.session.tools.motion_setup.joints
    joint_placement.move_joint(window.session, "hand.R", joints["hand.R"] + 8)
    joint_placement.mirror_joints(window.session)
    axis = np.mean(
        [window.session.tools.motion_setup.joints[name].real for name in ("hips", "chest", "head")]
    )
    right, left = (window.session.tools.motion_setup.joints[f"hand.{side}"] for side in "RL")
    assert right.real + left.real == pytest.approx(2 * axis, abs=1)
    assert right.imag == pytest.approx(left.imag, abs=1)


def test_missing_needs_of_a_motion_are_named(window, child):
    joint_placement.exclude_joint(window.session, "foot.R")
    window.frames()
    assert "needs foot.R" in preset_setup.apply_motion_disabled_reason(window.session, child)
    apply_motion.apply_motion_preset(window.session)
    assert window.session.tools.motion_setup is not None
    assert child.motion_job is None
    joint_placement.include_joint(window.session, "foot.R")
    assert not preset_setup.apply_motion_disabled_reason(window.session, child)
    preset_setup.set_body_kind(window.session, "anything")
    window.settle()
    assert window.session.tools.motion_setup.motion in {"breathe", "sway", "hop"}
    preset_setup.set_body_kind(window.session, "biped-front")
    window.settle()
    assert "foot.R" in window.session.tools.motion_setup.joints, "as they were left"


def test_handles_that_are_there_are_joints(window):
    project = window.open(paint(window.folder, "child"))
    suggest_handles(window.session)
    head = next(each for each in project.layer.handles if each.name == "head")
    draft_motion(window)
    assert window.session.tools.motion_setup.joints["head"] == head.position


def test_a_motion_is_given_again_in_another_way_as_one_step_and_a_save_waits_for_it(
    window, ghost, tmp_path
):
    before = ghost.document
    (given,) = ghost.layer.motions
    draft_motion(window)
    assert window.session.tools.motion_setup.applied_motion is given
    preset_setup.set_motion_parameters(window.session, speed=4.0)
    apply_motion.apply_motion_preset(window.session)
    ghost.file.path = tmp_path / "ghost.lissom"
    saving.save(window.session)
    arrive(window, ghost)
    window.until(lambda: ghost.file.path.exists() and not ghost.pending.changes)
    (again,) = ghost.layer.motions
    assert again.last < given.last
    assert ghost.document.frames.last == again.last == ghost.layer.keys[-1].frame
    assert is_motion_unedited(ghost.layer, again)
    assert load_project(ghost.file.path).layers[0].motions == (again,)
    editing.undo(window.session)
    assert ghost.document is before


def test_given_again_its_handles_go_where_joints_were_dragged(window):
    project = window.open(paint(window.folder, "snake"))
    draft_motion(window)
    preset_setup.set_motion_parameters(window.session, size=0.2, speed=4.0)
    apply_motion.apply_motion_preset(window.session)
    arrive(window, project)
    playback.stop_playback(window.session)
    handles = {handle.name: handle.id for handle in project.layer.handles}
    playback.scrub(window.session, 0)
    draft_motion(window)
    place = window.session.tools.motion_setup.joints["joint.2"] + 6
    joint_placement.move_joint(window.session, "joint.2", place)
    apply_motion.apply_motion_preset(window.session)
    arrive(window, project)
    assert {handle.name: handle.id for handle in project.layer.handles} == handles
    assert abs(project.layer.handle(handles["joint.2"]).position - place) < 2


def test_what_was_edited_by_hand_stays_unless_another_preset_replaces_it(window, ghost):
    key = ghost.layer.keys[2]
    playback.scrub(window.session, key.frame)
    window.settle()
    identity, target = next(iter(key.pose.targets.items()))
    moved = replace(target, position=target.position + 4j)
    set_targets(window.session, {identity: moved})
    window.settle()
    (given,) = ghost.layer.motions
    apply_motion.change_applied_motion(window.session, ghost.layer.id, given.first, size=0.8)
    arrive(window, ghost)
    (given,) = ghost.layer.motions
    assert given.parameters.size == 0.8
    assert not is_motion_unedited(ghost.layer, given)
    assert find_motion_edits(ghost.layer, given).shifts[2][identity].imag > 2
    playback.stop_playback(window.session)
    playback.scrub(window.session, 0)
    draft_motion(window)
    assert not preset_setup.apply_motion_disabled_reason(window.session, ghost)
    preset_setup.set_motion_preset(window.session, "sway")
    window.frames(3)
    assert "edited the motion by hand" in preset_setup.apply_motion_disabled_reason(
        window.session, ghost
    )
    apply_motion.apply_motion_preset(window.session)
    assert ghost.motion_job is None
    click(window, "//Animate/**/Replace edits")
    assert not preset_setup.apply_motion_disabled_reason(window.session, ghost)


def test_rig_this_makes_handles_and_bones_in_one_step(window):
    project = window.open(paint(window.folder, "child"))
    before = project.document
    rigging.rig_layer(window.session)
    window.settle()
    layer = project.layer
    names = {handle.id: handle.name for handle in layer.handles}
    bones = {tuple(names[end] for end in bone.ends) for bone in layer.bones}
    assert {("hip.L", "knee.L"), ("knee.L", "foot.L"), ("elbow.R", "hand.R")} <= bones
    rigging.rig_layer(window.session)
    window.settle()
    assert window.session.notices.toasts[-1].text == "child has this rig already."
    editing.undo(window.session)
    assert project.document is before


@pytest.mark.parametrize("how", ["escape", "change"])
def test_rigging_ends_without_a_rig_by_escape_or_a_change_of_the_drawing(window, how):
    project = window.open(paint(window.folder, "child"))
    with window.session.jobs.held(rigging.RIGGING):
        rigging.rig_layer(window.session)
        window.frames(3)
        if how == "escape":
            window.run(lambda robot: robot.key_press(int(window.Key.escape)))
            assert rigging.RIGGING not in window.session.jobs.kinds
        else:
            suggest_handles(window.session)
        left = project.document
    window.settle()
    assert project.document is left
    told = [toast.text for toast in window.session.notices.toasts]
    assert any("Press “Rig this” again." in text for text in told) == (how == "change")


def test_a_draft_opens_in_no_other_tool(window):
    project = window.open(paint(window.folder, "child"))
    with window.session.jobs.held(preset_setup.FINDING):
        preset_setup.begin_motion_setup(window.session)
        window.frames(2)
        assert window.session.tools.mode == "pose"
        move_tool.toggle_move_tool(window.session)
    window.settle()
    assert window.session.tools.mode == "move"
    assert not project.pending.changes


@pytest.mark.parametrize("how", ["rig", "apply"])
def test_legs_that_touch_are_parted_in_the_same_step(window, tmp_path, how):
    draw_person("lines").save(tmp_path / "person.png")
    project = window.open(tmp_path / "person.png")
    before = project.document
    if how == "rig":
        rigging.rig_layer(window.session)
        window.settle()
        window.until(lambda: not project.layer.is_stale)
    else:
        draft_motion(window)
        preset_setup.set_motion_parameters(window.session, size=0.3, speed=4.0)
        apply_motion.apply_motion_preset(window.session)
    arrive(window, project)
    print(
        [t.text for t in window.session.notices.toasts],
        window.session.tools.mode,
        project.layer.domain.mesh.triangles.shape,
        len(project.layer.handles),
    )
    assert any("were parted" in toast.text for toast in window.session.notices.toasts)
    layer = project.layer
    assert layer.domain.closed is not None
    assert len(layer.cut_out.cut_lines) == 1
    assert {"hip.L", "knee.R"} <= {handle.name for handle in layer.handles}
    if how == "apply":
        playback.stop_playback(window.session)
    remove_knife_cut(window.session, complex(layer.cut_out.cut_lines[0].points[50]), 3.0)
    assert not project.layer.cut_out.cut_lines
    window.until(lambda: not project.layer.is_stale)
    assert project.layer.domain.closed is None
    editing.undo(window.session)
    editing.undo(window.session)
    assert project.document is before


def test_another_motion_follows(window, ghost):
    (given,) = ghost.layer.motions
    preset_setup.append_motion(window.session, given)
    window.settle()
    preset_setup.set_motion_parameters(window.session, size=0.3, speed=4.0)
    apply_motion.apply_motion_preset(window.session)
    arrive(window, ghost)
    first, second = ghost.layer.motions
    assert first is given
    assert is_motion_unedited(ghost.layer, first)
    assert second.first == given.last < second.start
    assert ghost.document.frames.last == second.last


@pytest.mark.parametrize("parts", [False, True])
def test_each_solved_pose_is_shown_until_escape_cancels_the_preset(window, tmp_path, parts):
    if parts:
        draw_person("lines").save(tmp_path / "person.png")
    project = window.open(tmp_path / "person.png" if parts else paint(window.folder, "child"))
    before, at_rest = project.document, project.runtimes.displayed
    draft_motion(window)
    preset_setup.set_motion_parameters(window.session, size=0.3, speed=4.0)
    apply_motion.apply_motion_preset(window.session)
    window.until(lambda: project.motion_job.solve is not None and project.motion_job.solve.poses)
    with window.session.jobs.held():
        window.frames(3)
        solve = project.motion_job.solve
        assert solve.parted == parts
        shown = project.layer_runtime.shown
        vertices = shown.mesh.domain.mesh.vertices
        expected = solve.rig.layer.map_of(solve.poses[-1])(vertices)
        assert_allclose(shown.positions, expected, atol=1e-2)
        assert np.abs(shown.positions - vertices).max() > 1
        assert project.document is before
        window.run(lambda robot: robot.key_press(int(window.Key.escape)))
        window.frames(3)
        assert project.motion_job is None
        assert project.runtimes.displayed.layers.keys() == at_rest.layers.keys()
        assert_allclose(
            project.layer_runtime.shown.positions, next(iter(at_rest.layers.values())).positions
        )
    assert project.document is before


def test_a_cancelled_preset_leaves_the_frame_that_was_shown_without_its_in_between(window, ghost):
    with window.session.jobs.held(GLIMPSING, SKETCHING, REFINING):
        playback.scrub(window.session, 1)
        editing.edit_layer(window.session, shape_commands.set_variant, "eta")
        window.frames(3)
        before = ghost.layer_runtime.shown
        assert not before.is_current
        apply_motion.change_applied_motion(window.session, ghost.layer.id, 0, size=0.8)
        window.until(lambda: ghost.motion_job.solve and len(ghost.motion_job.solve.poses) == 2)
        with window.session.jobs.held():
            window.frames()
            assert np.abs(ghost.layer_runtime.shown.positions - before.positions).max() > 0.1
            window.run(lambda robot: robot.key_press(int(window.Key.escape)))
            window.frames(3)
            assert_allclose(ghost.layer_runtime.shown.positions, before.positions)


@pytest.mark.parametrize("how", ["escape", "undo"])
def test_on_its_way_it_is_given_up_and_drafted_again(window, child, how):
    before = child.document
    apply_motion.apply_motion_preset(window.session)
    window.frames(3)
    assert child.motion_job is not None
    if how == "escape":
        window.run(lambda robot: robot.key_press(int(window.Key.escape)))
    else:
        editing.undo(window.session)
    assert child.motion_job is None
    assert window.session.tools.motion_setup is not None
    window.settle()
    assert child.document is before


def test_a_change_meanwhile_refuses_it(window, ghost):
    draft_motion(window)
    apply_motion.apply_motion_preset(window.session)
    remove_handles(window.session, frozenset({ghost.layer.handles[0].id}))
    changed = ghost.document
    arrive(window, ghost)
    assert ghost.document is changed
    assert "the drawing changed meanwhile" in window.session.notices.toasts[-1].text


def test_near_leg_is_asked_for_beside_a_picture_of_each_leg(window, tmp_path):
    window.program.take_dropped([paint(tmp_path, "walker", size=160)])
    window.settle()
    draft_motion(window)
    setup = window.session.tools.motion_setup
    window.session.tools.select(replace(setup, unsure=("foot.R",)))
    window.frames(3)
    click(window, "//Animate/**/###foot.R 1")
    answered = window.session.tools.motion_setup
    assert not answered.unsure
    assert answered.joints["foot.R"] == setup.joints["foot.L"]
    assert answered.joints["hip.L"] == setup.joints["hip.R"]
