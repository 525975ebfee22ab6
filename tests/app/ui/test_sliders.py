"""Pose sliders in the window: dragged live, keyed, and made from poses."""

from dataclasses import replace

import numpy as np
import pytest
from imgui_bundle import ImVec2
from numpy.testing import assert_allclose
from projects import project_of
from still_poses import dragged, drawing

from app.document import (
    SLIDER,
    Channel,
    FrameRange,
    LibraryPose,
    Slider,
    SliderPose,
    clip_of,
    keys_in,
    value_at,
)
from app.editor.actions import editing, playback, viewing
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.poses import sliders
from app.motion import Animation
from app.storage import decode_picture

NAMES = {"up": 1, "down": 2}
TOP = 3
NOD = Channel(SLIDER, 0, "nod")


@pytest.fixture
def project(window):
    return window.again(show_blob)


def show_blob(window):
    """Show the blob with a slider of two poses and of the drawing between them, and with a pad."""
    names = ("down", None, "up")
    poses = tuple(
        SliderPose(at=complex(at), pose=each) for at, each in zip((-1, 0, 1), names, strict=True)
    )
    corners = ((0, None), (1, "up"), (1j, "down"), (1 + 1j, "up"))
    pad = tuple(SliderPose(at=complex(at), pose=each) for at, each in corners)
    library = tuple(LibraryPose(name=name, pose=dragged(n)) for name, n in NAMES.items())
    layer = replace(
        drawing().layers[0],
        library=library,
        sliders=(Slider(name="nod", poses=poses), Slider(name="look", poses=pad)),
    )
    rgba = decode_picture(layer.picture.data, "").rgba
    document = replace(drawing(), layers=(layer,), frames=FrameRange(0, 24))
    window.session.project = project_of(document, rgba, "blob")
    window.settle()


def shown(project):
    return project.layer_runtime.shown.handle_positions


def exact(project, frame):
    points = np.array([handle.position for handle in project.layer.handles])
    return Animation(clip_of(project.document, 0), points=points).positions(frame)


def drag(window, path, by):
    """Drag a widget of the tab from its middle by a part of its width and height."""
    window.show_tab("Animate")

    def play(robot):
        robot.set_ref("###Animate")
        robot.scroll_to_item_y(path)
        box = robot.item_info(path).rect_full
        size = box.max - box.min
        robot.mouse_move(path)
        robot.mouse_down(0)
        middle = (box.min + box.max) * 0.5
        for step in (0.5, 1.0):
            to = ImVec2(middle.x + step * by.real * size.x, middle.y - step * by.imag * size.y)
            robot.mouse_move_to_pos(to)
        robot.mouse_up(0)

    window.run(play)
    window.settle()


def test_slider_is_dragged_live_and_keyed(window, project):
    before = project.document
    playback.scrub(window.session, 12)
    drag(window, "**/nod/track", 0.4)
    (key,) = keys_in(project.document, NOD)
    assert key.frame == 12
    assert 0.5 < key.value.real < 1.0
    assert_allclose(shown(project), exact(project, 12), rtol=0, atol=0.05)
    assert abs(shown(project)[TOP] - project.layer.handles[TOP].position) > 3
    window.act(editing.undo)
    assert project.document is before


def test_slider_without_auto_key_is_set_for_all_frames(window, project):
    viewing.toggle_auto_key(window.session)
    drag(window, "**/nod/track", -0.4)
    assert not keys_in(project.document, NOD)
    assert -1 < project.layer.slider("nod").value.real < -0.5
    assert_allclose(shown(project), exact(project, 0), rtol=0, atol=0.05)


def test_pad_is_dragged_in_both_directions(window, project):
    drag(window, "**/look/pad", -0.2 + 0.3j)
    value = value_at(project.document, Channel(SLIDER, 0, "look"), 0)
    assert value == pytest.approx(0.3 + 0.8j, abs=0.03)
    assert_allclose(shown(project), exact(project, 0), rtol=0, atol=0.05)


def test_slider_goes_beyond_its_poses_on_request(window, project):
    window.act(sliders.toggle_wide_slider, "nod")
    drag(window, "**/nod/track", 0.6)
    assert value_at(project.document, NOD, 0) == pytest.approx(1.6)


def test_slider_is_made_from_poses(window, project):
    window.act(sliders.add_slider, ["down", None, "up"])
    window.act(sliders.add_slider, [None, "up", "down", "up"])
    made = project.layer.slider("Slider 1")
    assert [(each.at, each.pose) for each in made.poses] == [(-1, "down"), (0, None), (1, "up")]
    with_pad = sliders.add_slider
    window.act(lambda session: with_pad(session, [None, "up", "down", "up"], is_pad=True))
    assert project.layer.slider("Slider 3").is_pad


def test_pose_is_set_where_the_slider_stands(window, project):
    editing.select_handles(window.session, frozenset({TOP}))
    nudge_handles(window.session, 5 - 8j)
    window.settle()
    wanted = shown(project)
    drag(window, "**/nod/track", 0.25)
    before = value_at(project.document, NOD, 0)
    seen = shown(project)
    window.act(sliders.set_slider_pose, "nod")
    window.settle()
    assert len(project.layer.slider("nod").poses) == 4
    assert value_at(project.document, NOD, 0) == before
    assert_allclose(shown(project), seen, rtol=0, atol=0.5)
    assert abs(wanted[TOP] - seen[TOP]) > 1
    rest = [handle.position for handle in project.layer.handles]
    assert_allclose(
        [project.layer.keys[0].pose.targets[i].position for i in range(4)], rest, rtol=0, atol=1e-9
    )


def test_slider_begins_with_the_shown_pose(window, project):
    editing.select_handles(window.session, frozenset({TOP}))
    nudge_handles(window.session, 5 - 8j)
    window.settle()
    seen = shown(project)
    window.act(sliders.begin_slider)
    window.settle()
    slider = project.layer.sliders[-1]
    assert [each.at for each in slider.poses] == [0, 1]
    playback.scrub(window.session, 0)
    drag(window, f"**/{slider.name}/track", 0.6)
    assert_allclose(shown(project), seen, rtol=0, atol=0.05)
