"""The library of poses and flipped poses, through the widgets."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from animations import still_document
from documents import altered
from imgui_bundle import ImVec2, imgui
from PIL import Image, ImageDraw
from projects import project_of

from app.document import handle_commands
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup import resolving
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.poses import flipping, library
from app.storage import load_project, save_project
from app.ui.shortcuts.keys import chords_of
from app.ui.shortcuts.table import ACTIONS

CTRL, SHIFT, ALT = (
    int(key) for key in (imgui.Key.mod_ctrl, imgui.Key.mod_shift, imgui.Key.mod_alt)
)
HANDLES = {"arm.L": 22 + 60j, "arm.R": 138 + 60j, "hip": 80 + 20j, "head": 80 + 100j}
LEFT, RIGHT, HIP, HEAD = range(4)


@pytest.fixture
def project(window):
    return window.again(show_somebody)


def show_somebody(window):
    """Somebody with two arms; at frame 12 the left one is up."""
    picture = Image.new("RGBA", (160, 120))
    pen = ImageDraw.Draw(picture)
    pen.rectangle((60, 10, 99, 109), fill=(200, 120, 60, 255))
    pen.rectangle((10, 50, 149, 69), fill=(90, 140, 200, 255))
    document = altered(still_document(np.array(picture)), variant="nu")
    for name, place in HANDLES.items():
        document = handle_commands.add_handle(0, place, name=name)(document)
    window.session.project = project_of(document, np.array(picture), "somebody")
    window.settle()
    pose(window, 12, 8 + 25j)


def pose(window, frame, way):
    """Pull the left arm at a frame."""
    project = window.session.project
    playback.scrub(window.session, frame)
    window.settle()
    editing.select_handles(window.session, frozenset({LEFT}))
    nudge_handles(window.session, way)
    window.settle()
    editing.select_handles(window.session, frozenset())
    return project


def targets(project, frame):
    return {i: t.position for i, t in project.layer.key(frame).pose.targets.items()}


def press(window, chord):
    window.run(lambda robot: robot.key_press(chord))
    window.settle()


def go(window, frame):
    playback.scrub(window.session, frame)
    window.settle()


def test_a_pose_is_pasted_flipped_and_again_where_its_axis_is_moved(window, project):
    before = project.document
    press(window, CTRL | int(window.Key.c))
    go(window, 24)
    assert not flipping.is_mirror_axis_shown(window.session, window.session.project)
    press(window, CTRL | SHIFT | int(window.Key.v))
    way = targets(project, 12)[LEFT] - HANDLES["arm.L"]
    now = targets(project, 24)
    assert now[RIGHT] == pytest.approx(HANDLES["arm.R"] - way.conjugate(), abs=1e-6)
    assert now[LEFT] == pytest.approx(HANDLES["arm.L"], abs=1e-6)
    assert project.layer.key(24).pose.certificate.is_certified
    # While that is what is chosen, the axis is there to be moved.
    assert flipping.is_mirror_axis_shown(window.session, window.session.project)
    pasted = project.document

    def drag(robot, key=None):
        robot.set_ref("###Viewport")
        robot.mouse_move("**/mirror axis")
        robot.mouse_down(0)
        start = imgui.get_mouse_pos()
        robot.mouse_move_to_pos(ImVec2(start.x + 40, start.y + 60))
        if key is not None:
            robot.key_press(int(key))
        robot.mouse_up(0)

    window.run(lambda robot: drag(robot, window.Key.escape))
    window.settle()
    assert project.document is pasted
    window.run(drag)
    window.settle()
    moved = project.layer.axis - before.layers[0].axis
    assert moved > 5
    # Where the axis is not in the middle, a turned arm lands elsewhere.
    assert project.layer.key(24).pose is not pasted.layers[0].key(24).pose
    assert flipping.is_mirror_axis_shown(window.session, window.session.project)
    editing.undo(window.session)
    assert project.document is pasted
    editing.undo(window.session)
    assert project.document is before
    window.frames(2)
    assert not flipping.is_mirror_axis_shown(window.session, window.session.project)


def test_only_the_selected_handles_are_pasted_flipped(window, project):
    press(window, CTRL | int(window.Key.c))
    go(window, 24)
    editing.select_handles(window.session, frozenset({RIGHT}))
    press(window, CTRL | ALT | SHIFT | int(window.Key.v))
    way = targets(project, 12)[LEFT] - HANDLES["arm.L"]
    now = targets(project, 24)
    assert now[RIGHT] == pytest.approx(HANDLES["arm.R"] - way.conjugate(), abs=1e-6)
    assert now[LEFT] == pytest.approx(targets(project, 12)[LEFT], abs=1e-6)


def test_poses_are_kept_clicked_named_and_deleted(window, project, tmp_path):
    before = project.document
    window.show_tab("Animate")

    def name(robot):
        robot.set_ref("###Animate")
        robot.item_click("**/###Save pose")
        robot.yield_(2)
        robot.item_click("**/pose Pose 1", 1)
        robot.item_click("//$FOCUSED/Rename…")
        robot.key_chars_replace_enter("arm up")

    window.run(name)
    (kept,) = project.layer.library
    assert kept.name == "arm up"
    assert kept.pose is project.layer.key(12).pose
    go(window, 30)

    def click(robot):
        robot.set_ref("###Animate")
        robot.item_click("**/pose arm up")

    window.run(click)
    assert project.layer.key(30).pose is kept.pose
    save_project(tmp_path / "a.lissom", project.document)
    (again,) = load_project(tmp_path / "a.lissom").layers[0].library
    assert (again.name, again.pose.targets) == (kept.name, kept.pose.targets)

    def delete(robot):
        robot.set_ref("###Animate")
        robot.item_click("**/pose arm up", 1)
        robot.item_click("//$FOCUSED/Delete")

    window.run(delete)
    assert project.layer.library == ()
    assert [step(window) for _ in range(4)] == [
        "Delete pose",
        "Use pose",
        "Rename pose",
        "Save pose",
    ]
    assert project.document is before


def step(window):
    label = window.session.project.history.undo_label
    editing.undo(window.session)
    window.frames()
    return label


def test_a_pose_is_dragged_onto_the_timeline(window, project):
    press(window, SHIFT | int(window.Key.k))
    kept = project.layer.library[0]
    window.show_tab("Animate")

    def drag(robot, key=None):
        robot.set_ref("###Timeline")
        first = robot.item_info("**/key 0").rect_full.get_center()
        last = robot.item_info("**/key 12").rect_full.get_center()
        place = ImVec2(first.x + 20 / 12 * (last.x - first.x), first.y)
        robot.set_ref("###Animate")
        robot.mouse_move(f"**/pose {kept.name}")
        robot.mouse_down(0)
        robot.mouse_move_to_pos(place)
        robot.yield_(2)
        if key is not None:
            robot.key_press(int(key))
            robot.yield_(2)
        robot.mouse_up(0)

    window.run(lambda robot: drag(robot, window.Key.escape))
    assert project.layer.key_frames == {0, 12}
    window.run(drag)
    window.settle()
    assert project.layer.key(20).pose is kept.pose
    assert playback.current_frame(window.session, project) == 20


def test_a_pose_is_blended_in_by_its_bar_as_one_step(window, project):
    press(window, SHIFT | int(window.Key.k))
    go(window, 0)
    before = project.document
    window.show_tab("Animate")

    def drag(robot, share):
        robot.set_ref("###Animate")
        bar = robot.item_info("**/blend").rect_full
        y = bar.get_center().y
        robot.mouse_move_to_pos(ImVec2(bar.min.x + 3, y))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(ImVec2(bar.min.x + 0.2 * bar.get_width(), y))
        robot.mouse_move_to_pos(ImVec2(bar.min.x + share * bar.get_width(), y))
        robot.mouse_up(0)

    window.run(lambda robot: drag(robot, 0.5))
    window.settle()
    rest, up = HANDLES["arm.L"], targets(project, 12)[LEFT]
    assert targets(project, 0)[LEFT] == pytest.approx((rest + up) / 2, abs=1.0)
    assert project.layer.key(0).pose.certificate.is_certified
    assert project.pose_edits.blend_preview is None
    editing.undo(window.session)
    assert project.document is before
    window.run(lambda robot: drag(robot, 1.2))
    window.settle()
    assert project.layer.key(0).pose is project.layer.library[0].pose
    editing.undo(window.session)
    assert project.document is before


def test_the_axis_is_entered_shown_and_put_back(window, project):
    window.show_tab("Animate")

    def enter(robot):
        robot.set_ref("###Animate")
        robot.item_open("**/###flip")
        robot.item_click("**/##axis")
        robot.item_click("**/##axis x")
        robot.key_chars_replace_enter("70")

    window.run(enter)
    assert project.layer.axis == 70
    assert flipping.is_mirror_axis_shown(window.session, window.session.project)
    window.run(lambda robot: robot.item_click("//###Animate/Middle"))
    assert project.layer.mirror is None
    press(window, chords_of(ACTIONS["Mirror axis"])[0])
    assert not flipping.is_mirror_axis_shown(window.session, window.session.project)


def test_poses_of_the_library_are_solved_for_other_limits_with_the_keys(window, project):
    press(window, SHIFT | int(window.Key.k))
    tighter = replace(project.layer.bounds, k=0.2, sigma_a=1.2)
    resolving.set_limits(window.session, tighter)
    window.settle()
    assert project.layer.bounds == tighter
    assert all(project.layer.is_proven(pose) for pose in project.layer.poses)
    assert len(project.layer.poses) == 3


def test_no_pose_is_drawn_on_the_mesh_of_another_outline(window, loose):
    library.save_pose_to_library(window.session)
    window.settle()
    window.show_tab("Animate")
    window.frames(3)
    pictures, (kept,) = window.program.canvas.pose_pictures, loose.layer.library
    assert pictures.get(loose.layer.id, kept.pose, 16) is not None
    # As between a change of the outline and the next frame.
    old = SimpleNamespace(store=SimpleNamespace(mesh=SimpleNamespace(source=None)))
    runtimes = SimpleNamespace(layers={loose.layer.id: old})
    changed = SimpleNamespace(document=loose.document, runtimes=runtimes)
    pictures.draw(window.session, changed, posable=None)
    assert pictures.get(loose.layer.id, kept.pose, 16) is None
