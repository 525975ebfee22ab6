"""Parts that are made stiff or soft by hand: brush, bones, tint, and keys posed again."""

import numpy as np
import pytest
from bars import BENT
from imgui_bundle import ImVec2

from app.document import Target, handle_commands, stiffness_commands
from app.document.rig.chains import Bone
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import stiffness_editing
from app.editor.actions.posing.handles import add_handle, remove_handles
from app.editor.actions.posing.pose_drag import release_drag, set_targets
from app.editor.tools import move_tool
from app.storage.assets import sample_images
from app.ui.viewport.interaction.shapes import triangulate_stroke
from app.ui.viewport.stiffness_overlay import measure_vertex_stiffness

ENDS = (0, 1)


@pytest.fixture
def tab(window, bent):
    """The bent bar, with the tab in front that shows its material."""
    playback.scrub(window.session, 0)
    window.show_tab("Shape")
    window.settle()
    return bent


def drag(window, places, *, button_up=True):
    def act(robot):
        robot.mouse_move_to_pos(window.point(places[0]))
        robot.mouse_down(0)
        for place in places[1:]:
            robot.mouse_move_to_pos(window.point(place))
        if button_up:
            robot.mouse_up(0)

    window.run(act)
    window.settle()


def place_of(project, handle):
    index = [each.id for each in project.layer.handles].index(handle)
    return complex(project.layer_runtime.shown.handle_positions[index])


def middle(project):
    return sum(place_of(project, end) for end in ENDS) / 2


def test_a_stroke_makes_what_it_covers_stiff_and_undo_takes_it_back(window, tab):
    before = tab.document
    stiffness_editing.toggle_stiffness_tool(window.session, "stiff")
    drag(window, [middle(tab) - 10, middle(tab), middle(tab) + 10])
    stiffness = tab.layer.stiffness
    along = np.concatenate(tab.layer.domain.loops)
    near = np.abs(along.real - middle(tab).real) < 10
    assert stiffness[near].max() == pytest.approx(window.session.tools.strength)
    assert stiffness[np.abs(along.real - middle(tab).real) > 0.4 * np.ptp(along.real)] == (
        pytest.approx(1.0)
    )
    assert tab.layer.keys == before.layers[0].keys, "poses stay"
    editing.undo(window.session)
    assert tab.document is before


def test_on_a_posed_drawing_the_brush_reaches_what_is_shown_there(window, tab):
    playback.scrub(window.session, BENT)
    window.settle()
    end = place_of(tab, ENDS[1])
    rest = tab.layer.handle(ENDS[1]).position
    assert abs(end - rest) > 20
    stiffness_editing.toggle_stiffness_tool(window.session, "soft")
    drag(window, [end, end - 2])
    along = np.concatenate(tab.layer.domain.loops)
    softest = along[tab.layer.stiffness.argmin()]
    assert abs(softest - rest) < abs(softest - end)
    assert tab.layer.stiffness.min() == pytest.approx(1 / window.session.tools.strength, rel=0.3)


def test_a_brush_that_reaches_no_outline_says_so(window, tab):
    window.session.tools.mode = "stiff"
    tab.layer_setup.brush = 1.0
    stiffness_editing.paint_stiffness(window.session, [middle(tab)])
    assert tab.layer.stiffness is None
    assert "reaches no outline" in window.session.notices.toasts[-1].text


def test_a_bone_is_drawn_from_handle_to_handle(window, tab):
    stiffness_editing.toggle_stiffness_tool(window.session, "bone")
    drag(window, [place_of(tab, ENDS[0]), middle(tab), place_of(tab, ENDS[1])])
    assert [set(bone.ends) for bone in tab.layer.bones] == [set(ENDS)]
    drag(window, [place_of(tab, ENDS[0]), middle(tab) + 40j])
    assert len(tab.layer.bones) == 1, "it ends at no handle"
    drag(window, [place_of(tab, ENDS[1]), place_of(tab, ENDS[0])])
    assert len(tab.layer.bones) == 1
    assert "already" in window.session.notices.toasts[-1].text
    assert window.session.tools.is_posing is False
    move_tool.return_to_posing(window.session)
    assert window.session.tools.is_posing


@pytest.mark.parametrize("way", [[0], [0, 100], [0, 100, 0, 60], [0, 0]])
def test_what_a_stroke_covers_is_shown_once_however_often_it_goes_there(way):
    triangles = triangulate_stroke([ImVec2(x, 7) for x in way], 20.0)
    area = sum(
        abs((two - one).x * (three - one).y - (two - one).y * (three - one).x) / 2
        for one, two, three in triangles
    )
    assert area == pytest.approx(40 * max(way) + np.pi * 20**2, rel=0.01)
    reach = [np.hypot(at.x - min(max(at.x, 0), max(way)), at.y - 7) for at in sum(triangles, ())]
    assert max(reach) < 20.01


def test_escape_takes_back_a_stroke_and_then_puts_the_brush_away(window, tab):
    before = tab.document
    stiffness_editing.toggle_stiffness_tool(window.session, "stiff")

    def act(robot):
        robot.mouse_move_to_pos(window.point(middle(tab)))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(window.point(middle(tab) + 10))
        robot.key_press(int(window.Key.escape))
        robot.mouse_up(0)
        robot.key_press(int(window.Key.escape))

    window.run(act)
    assert tab.document is before
    assert window.session.tools.is_posing


def test_the_drawing_is_tinted_as_long_as_the_tab_is_in_front(window, tab):
    assert window.session.display.tint == "stiffness"
    stiffness_editing.toggle_stiffness_tool(window.session, "stiff")
    drag(window, [middle(tab) - 10, middle(tab) + 10])
    values = measure_vertex_stiffness(tab.layer, tab.layer_runtime.shown.mesh)
    vertices = tab.layer_runtime.shown.mesh.domain.mesh.vertices
    assert values[np.abs(vertices - middle(tab)).argmin()] > 0.2
    assert abs(values[np.abs(vertices - vertices.real.min()).argmin()]) < 0.05
    window.show_tab("Layers")
    window.frames(2)
    assert window.session.display.tint is None
    viewing.set_tint(window.session, "depth")
    window.frames(2)
    assert window.session.display.tint == "depth"


def test_a_key_follows_the_new_material_when_it_is_posed_again(window, tab):
    playback.scrub(window.session, BENT)
    window.settle()
    before = tab.layer.key(BENT).pose
    stiffness_editing.add_bone(window.session, ENDS)
    window.settle()
    assert tab.layer.key(BENT).pose is before
    stiffness_editing.solve_shown_pose_again(window.session)
    window.settle()
    after = tab.layer.key(BENT).pose
    assert after.phi is not before.phi
    # The bone gets its length, from its root on.
    assert abs(after.targets[ENDS[0]].position - before.targets[ENDS[0]].position) < 2
    rest = [tab.layer.handle(end).position for end in ENDS]
    reached = [after.targets[end].position for end in ENDS]
    assert abs(abs(reached[1] - reached[0]) - abs(rest[1] - rest[0])) < 2
    editing.undo(window.session)
    assert tab.layer.key(BENT).pose is before


def test_names_suggest_what_is_stiff_and_what_is_soft(window, tab):
    stiffness_editing.suggest_stiffness(window.session)
    assert "No handle is named" in window.session.notices.toasts[-1].text
    editing.edit_layer(window.session, handle_commands.rename_handle, ENDS[0], "Left Hand")
    editing.edit_layer(window.session, handle_commands.rename_handle, ENDS[1], "tail tip")
    before = tab.document
    stiffness_editing.suggest_stiffness(window.session)
    assert tab.layer.stiffness.max() > 5
    assert tab.layer.stiffness.min() < 0.3
    editing.undo(window.session)
    assert tab.document is before, "one step"


def test_hidden_bones_act_and_a_handle_that_goes_takes_its_bones_along(window, tab):
    stiffness_editing.add_bone(window.session, ENDS)
    editing.edit_layer(window.session, stiffness_commands.set_bones_visible, shown=False)
    assert tab.layer.bones == (Bone(ends=ENDS, is_shown=False),)
    first, second = (tab.layer.handle(end).name for end in ENDS)
    remove_handles(window.session, frozenset({ENDS[1]}))
    window.settle()
    assert tab.layer.bones == ()
    told = f"Deleted with the handle: the bone {first} – {second}. Undo brings it back."
    assert window.session.notices.toasts[-1].text == told
    editing.undo(window.session)
    assert len(tab.layer.bones) == 1


def test_a_bone_that_is_refused_is_named(window):
    """The bone would cross the hole of the ring."""
    ring = window.open(sample_images() / "ring.png")
    for place in (100 + 512j, 920 + 512j):
        add_handle(window.session, place)
    ends = tuple(handle.id for handle in ring.layer.handles)
    stiffness_editing.add_bone(window.session, ends)
    assert window.session.notices.toasts[-1].text.startswith("handle 1 – handle 2: The bone leaves")
    assert ring.layer.bones == ()


def test_dragging_goes_on_where_a_part_is_stiff(window, tab):
    stiffness_editing.add_bone(window.session, ENDS)
    playback.scrub(window.session, BENT)
    window.settle()
    root = tab.layer.key(BENT).pose.targets[ENDS[0]].position
    length = abs(np.diff([tab.layer.handle(end).position for end in ENDS])[0])
    place = root + length * np.exp(0.2j)
    set_targets(window.session, {ENDS[1]: Target(position=complex(place))})
    release_drag(window.session)
    window.settle()
    assert abs(place_of(tab, ENDS[1]) - place) < 2
    assert tab.layer.key(BENT).pose.certificate.is_certified


@pytest.mark.usefixtures("tab", "painted")
def test_colours_are_worked_out_anew_only_where_something_is_stiff_otherwise(window, monkeypatch):
    calls = []

    def counted(*arguments):
        calls.append(arguments)
        return measure_vertex_stiffness(*arguments)

    monkeypatch.setattr("app.ui.viewport.picture.gpu_resources.measure_vertex_stiffness", counted)
    stiffness_editing.add_bone(window.session, ENDS)
    window.settle()
    assert len(calls) == 1
    playback.scrub(window.session, BENT // 2)
    window.settle()
    playback.scrub(window.session, 3)
    window.settle()
    assert len(calls) == 1
    editing.edit_layer(window.session, stiffness_commands.set_bone_stiffness, ENDS, 20.0)
    window.settle()
    assert len(calls) == 2
