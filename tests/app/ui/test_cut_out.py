"""Cutting out by hand in the window: brush, pipette, mask, holes, and how the mesh follows."""

import re

import numpy as np
import pictures
import pytest
from documents import differences
from harness import Harness
from imgui_bundle import imgui
from messages import says
from PIL import Image

from app.cut_out.mask import ALL_REMOVED
from app.document import Target
from app.editor.actions import editing
from app.editor.actions.layer_setup import cut_out_editing, resolving
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets
from app.storage.project_file import load_project, save_project
from app.ui.panel import is_in_front
from app.ui.style.widgets import TOAST
from engine.domain.outline.cuts import CUTS_OFF

SIZE = 120
PAPER = (214, 205, 190)


@pytest.fixture(scope="module")
def ring(tmp_path_factory):
    """An opaque picture of a ring on a plain colour, whose inside is taken for drawing."""
    path = tmp_path_factory.mktemp("ring") / "ring.png"
    Image.fromarray(pictures.on_plain(pictures.ring(SIZE), PAPER)).save(path)
    return path


@pytest.fixture
def drawing(window, ring):
    return window.again(Harness.open, ring)


def rest(window):
    """Let the mesh follow the brush."""
    window.settle()
    window.clock.now += resolving.REST
    window.settle()
    window.frames(2)
    window.settle()


def stroke(window, *places):
    """Draw a stroke by the pointer."""
    window.session.notices.toasts = []  # they are above the drawing
    window.frames()

    def draw(robot):
        robot.mouse_move_to_pos(window.point(places[0]))
        robot.mouse_down()
        for place in places[1:]:
            robot.mouse_move_to_pos(window.point(place))
        robot.mouse_up()

    window.run(draw)


def click(window, place):
    stroke(window, place)


def kept(project):
    return project.layer_runtime.cut.value.kept


MIDDLE = complex(SIZE / 2, SIZE / 2)


def test_where_nothing_is_cut_out_of_a_photo_the_brush_is_offered(window, tmp_path):
    rgb = np.random.default_rng(0).integers(0, 256, (SIZE, SIZE, 3), dtype=np.uint8)
    Image.fromarray(rgb).save(tmp_path / "photo.png")
    project = window.open(tmp_path / "photo.png")
    assert kept(project).all()
    (offer,) = (toast for toast in window.session.notices.toasts if toast.label)
    assert "whole picture is the drawing" in offer.text

    def accept(robot):
        robot.item_click(f"//{TOAST}{offer.place}/{offer.label}")

    window.run(accept)
    assert window.session.tools.mode == "remove"
    window.act(cut_out_editing.set_brush_radius, 20.0)
    stroke(window, 10 + 10j, 10 + 100j)
    rest(window)
    assert not kept(project).all()


def test_where_a_background_was_removed_no_brush_is_offered(window, ring):
    assert not kept(window.open(ring)).all()
    # Only to open what it may show through.
    (offer,) = (toast for toast in window.session.notices.toasts if toast.label)
    assert offer.label == "Show holes"
    assert offer.text.startswith("Parts inside have the background's colour")


def test_each_stroke_is_a_step_and_the_mesh_follows_when_the_brush_rests(window, drawing):
    session, first = window.session, drawing.document
    add_handle(session, complex(0.1 * SIZE, SIZE / 2))
    window.settle()
    with_handle = drawing.document
    window.act(cut_out_editing.toggle_cut_tool, "remove")
    window.act(cut_out_editing.set_brush_radius, 12.0)
    stroke(window, MIDDLE - 10, MIDDLE + 10)
    stroke(window, MIDDLE)
    layer = drawing.layer
    assert [len(s.points) > 1 for s in layer.cut_out.strokes] == [True, False]
    assert layer.is_stale
    assert layer.domain is first.layers[0].domain
    rest(window)
    layer = drawing.layer
    assert not layer.is_stale
    assert layer.domain is not first.layers[0].domain
    assert len(layer.handles) == 1
    assert not kept(drawing)[SIZE // 2, SIZE // 2]
    assert drawing.layer_runtime.cut.value.texture[SIZE // 2, SIZE // 2, 3] == 0
    assert drawing.history.undo_label == "Brush"
    last = drawing.document
    window.act(editing.undo)
    assert len(drawing.layer.cut_out.strokes) == 1
    window.act(editing.undo)
    assert drawing.document is with_handle
    window.act(editing.redo)
    window.act(editing.redo)
    assert drawing.document is last


def test_a_step_between_two_strokes_gets_a_mesh_of_its_own(window, drawing):
    window.act(cut_out_editing.toggle_cut_tool, "remove")
    window.act(cut_out_editing.set_brush_radius, 8.0)
    stroke(window, MIDDLE)
    stroke(window, complex(5, 5), complex(5, SIZE - 5))
    rest(window)
    last = drawing.document
    window.act(editing.undo)
    assert drawing.layer.is_stale
    rest(window)
    assert not drawing.layer.is_stale
    assert len(drawing.layer.cut_out.strokes) == 1
    window.act(editing.redo)
    assert drawing.document is last


def test_alt_and_x_swap_the_brush_and_brackets_change_its_size(window, drawing):
    session = window.session
    keys = window.Key

    session.notices.toasts = []  # they are above the drawing

    def play(robot):
        robot.key_press(keys.x)
        assert session.tools.mode == "remove"
        robot.key_press(keys.x)
        assert session.tools.mode == "keep"
        radius = cut_out_editing.brush_radius(drawing)
        robot.key_press(keys.right_bracket)
        assert cut_out_editing.brush_radius(drawing) == pytest.approx(
            radius * cut_out_editing.BRUSH_STEP
        )
        robot.key_press(keys.left_bracket)
        assert cut_out_editing.brush_radius(drawing) == pytest.approx(radius)
        robot.mouse_move_to_pos(window.point(MIDDLE))
        robot.key_down(imgui.Key.mod_alt)
        robot.mouse_down()
        robot.mouse_up()
        robot.key_up(imgui.Key.mod_alt)
        robot.mouse_move_to_pos(window.point(complex(3, 3)))
        robot.mouse_down()
        robot.mouse_up()

    window.run(play)
    assert [stroke.keeps for stroke in drawing.layer.cut_out.strokes] == [False, True]

    def leave(robot):
        robot.key_press(keys.escape)

    window.run(leave)
    assert session.tools.mode == "pose"


def test_cut_out_is_a_mode_with_a_bar_of_its_own(window, drawing):
    def is_shown(name):
        found = imgui.internal.find_window_by_name(name)
        return found is not None and found.active

    window.show_tab("Handle")
    window.run(lambda robot: robot.key_press(int(window.Key.x)))
    window.frames(3)
    assert (is_shown("###mode"), is_shown("###mode settings")) == (True, False)
    assert is_in_front("Handle"), "the panel stays as it is"

    def play(robot):
        robot.item_click("//###mode/###knife tool")
        robot.item_click("//###mode/###cut-out settings")
        robot.item_click("//###mode settings/**/###none")

    window.run(play)
    assert window.session.tools.mode == "knife"
    assert drawing.layer.cut_out.background == "none"
    window.run(lambda robot: robot.item_click("//###mode/###done"))
    window.frames(3)
    assert window.session.tools.mode == "pose"
    assert not is_shown("###mode")


def test_a_stroke_that_is_cancelled_is_none(window, drawing):
    before = drawing.document
    window.act(cut_out_editing.toggle_cut_tool, "keep")

    def play(robot):
        robot.mouse_move_to_pos(window.point(MIDDLE))
        robot.mouse_down()
        robot.mouse_move_to_pos(window.point(MIDDLE + 20))
        robot.key_press(window.Key.escape)
        robot.mouse_up()

    window.run(play)
    assert drawing.document is before
    assert window.session.tools.mode == "keep"


def test_the_pipette_takes_the_background_s_colour(window, drawing):
    window.act(cut_out_editing.toggle_cut_tool, "pick")
    click(window, complex(4, 4))
    assert drawing.layer.cut_out.background == PAPER
    window.act(cut_out_editing.set_background, "none")
    rest(window)
    assert kept(drawing).all()
    window.act(cut_out_editing.set_background_tolerance, 3)
    window.act(cut_out_editing.set_background, "auto")
    rest(window)
    assert not kept(drawing).all()
    assert drawing.layer.cut_out.tolerance == 3


def test_a_mask_is_saved_and_loaded_again(window, drawing, tmp_path):
    window.act(cut_out_editing.toggle_cut_tool, "remove")
    stroke(window, MIDDLE, MIDDLE + 15)
    rest(window)
    by_hand = kept(drawing)
    path = tmp_path / "mask.png"
    window.act(cut_out_editing.save_mask, path)
    window.settle()
    written = Image.open(path)
    assert written.size == (SIZE, SIZE)
    assert set(np.unique(np.asarray(written.convert("L")))) == {0, 255}
    window.act(cut_out_editing.clear_cut_out_strokes)
    rest(window)
    assert not np.array_equal(kept(drawing), by_hand)
    window.act(cut_out_editing.load_mask, path)
    rest(window)
    assert drawing.layer.cut_out.mask is not None
    assert np.array_equal(kept(drawing), by_hand)
    assert not drawing.layer.is_stale


def test_a_mask_of_another_size_is_refused(window, drawing, tmp_path):
    before = drawing.document
    Image.new("L", (10, 10), 255).save(tmp_path / "small.png")
    window.act(cut_out_editing.load_mask, tmp_path / "small.png")
    window.settle()
    assert drawing.document is before
    assert any("of the picture's size" in toast.text for toast in window.session.notices.toasts)


def test_impossible_cut_out_is_reported_and_undone(window, drawing):
    add_handle(window.session, complex(0.1 * SIZE, SIZE / 2))
    window.settle()
    domain = drawing.layer.domain
    window.act(cut_out_editing.toggle_cut_tool, "remove")
    window.act(cut_out_editing.set_brush_radius, 300.0)
    stroke(window, MIDDLE)
    rest(window)
    assert drawing.layer.is_stale
    assert drawing.layer.domain is domain
    assert any(ALL_REMOVED in toast.text for toast in window.session.notices.toasts)
    window.act(editing.undo)
    rest(window)
    assert not drawing.layer.is_stale


def test_it_is_saved_and_survives_a_crash(window, drawing, tmp_path):
    window.act(cut_out_editing.toggle_cut_tool, "remove")
    stroke(window, MIDDLE, MIDDLE + 15)
    path = tmp_path / "stale.lissom"
    save_project(path, drawing.document)
    assert not differences(drawing.document, load_project(path))
    assert load_project(path).layers[0].is_stale
    again = window.open(path)
    assert again.layer.is_stale
    rest(window)
    assert not again.layer.is_stale
    assert len(again.layer.cut_out.strokes) == 1
    assert not kept(again)[SIZE // 2, SIZE // 2]


def test_a_click_keeps_a_hole_or_fills_it(window, tmp_path):
    Image.fromarray(pictures.ring(SIZE)).save(tmp_path / "ring.png")
    project = window.open(tmp_path / "ring.png")
    add_handle(window.session, complex(0.1 * SIZE, SIZE / 2))
    window.settle()
    before = project.document
    first = len(project.layer.domain.holes)
    window.act(cut_out_editing.toggle_cut_tool, "holes")
    click(window, complex(0.1 * SIZE, SIZE / 2))
    assert project.document is before  # no hole there
    click(window, MIDDLE + 4)
    assert len(project.layer.cut_out.toggled_holes) == 1
    rest(window)
    assert len(project.layer.domain.holes) == 1 - first
    assert len(project.layer.handles) == 1
    path = tmp_path / "ring.lissom"
    save_project(path, project.document)
    assert not differences(project.document, load_project(path))
    click(window, MIDDLE - 9j)
    assert project.layer.cut_out.toggled_holes == ()
    rest(window)
    assert len(project.layer.domain.holes) == first
    window.act(editing.undo)
    assert len(project.layer.domain.holes) == 1 - first
    window.act(editing.undo)
    assert project.document is before


@pytest.mark.parametrize(("colour", "first"), [((255, 255, 255), 0), ((90, 150, 220), 1)])
def test_a_click_opens_what_the_background_shows_through(window, tmp_path, colour, first):
    opaque = pictures.on_plain(pictures.ring(SIZE), colour)
    Image.fromarray(opaque).save(tmp_path / "ring.png")
    project = window.open(tmp_path / "ring.png")
    assert len(project.layer.domain.holes) == first
    offers = [toast for toast in window.session.notices.toasts if toast.label]
    assert len(offers) == 1 - first
    for offer in offers:
        window.run(
            lambda robot, offer=offer: robot.item_click(f"//{TOAST}{offer.place}/{offer.label}")
        )
    if first:
        window.act(cut_out_editing.toggle_cut_tool, "holes")
    assert window.session.tools.mode == "holes"
    for holes in (1 - first, first):
        click(window, MIDDLE + 4)
        rest(window)
        assert len(project.layer.domain.holes) == holes
        assert (project.layer_runtime.cut.value.texture[SIZE // 2, SIZE // 2, 3] == 0) == bool(
            holes
        )
    window.act(cut_out_editing.set_enclosed_removed, "keep" if first else "remove")
    rest(window)
    assert len(project.layer.domain.holes) == 1 - first
    path = tmp_path / "ring.lissom"
    save_project(path, project.document)
    assert not differences(project.document, load_project(path))


@pytest.fixture
def line_art(window, tmp_path):
    """A thick black line around white paper, on white paper, and a small pocket in the line."""
    x, y = pictures.plane(SIZE, SIZE)
    radius = np.hypot(x - SIZE / 2, y - SIZE / 2)
    line = (radius < 50) & (radius > 36) & (np.hypot(x - SIZE / 2, y - 17) > 1.5)
    rgba = pictures.on_plain(pictures.painted(line, (20, 20, 20)), (255, 255, 255))
    Image.fromarray(rgba).save(tmp_path / "line art.png")
    return window.open(tmp_path / "line art.png")


def pixel(window, place):
    at = window.point(place)
    return np.asarray(window.picture().convert("RGB"))[round(at.y), round(at.x)].astype(int)


POCKET = complex(SIZE / 2, SIZE - 17)


def test_a_click_opens_a_pocket_that_is_too_small_for_a_hole_of_the_mesh(window, line_art):
    window.act(cut_out_editing.toggle_cut_tool, "holes")
    click(window, POCKET + 0.5)
    assert len(line_art.layer.cut_out.toggled_holes) == 1
    rest(window)
    at = SIZE - 1 - int(POCKET.imag), int(POCKET.real)
    assert not kept(line_art)[at]
    assert kept(line_art)[SIZE // 2, SIZE // 2]
    assert not line_art.layer.domain.holes
    click(window, POCKET - 0.5)
    rest(window)
    assert kept(line_art)[at]


@pytest.mark.usefixtures("line_art")
def test_paper_that_is_left_inside_is_tinted(window):
    places = (MIDDLE, POCKET)
    assert [tuple(pixel(window, place)) for place in places] == [(255, 255, 255)] * 2
    window.act(cut_out_editing.toggle_cut_tool, "holes")
    window.session.notices.toasts = []  # they are above the drawing
    elsewhere = MIDDLE + 20j  # of the mark in the middle
    red, _, blue = pixel(window, elsewhere)
    assert blue > red + 60
    red, _, blue = pixel(window, complex(3, 3))
    assert red > blue + 60  # what is removed
    window.act(cut_out_editing.set_enclosed_removed, "remove")
    rest(window)
    red, _, blue = pixel(window, elsewhere)
    assert red > blue + 60


@pytest.mark.usefixtures("line_art")
def test_the_canvas_suits_lines_whose_paper_was_removed(window):
    """Their dark edge is seen on neither of the dark theme's squares, with and without paper."""
    window.session.settings.prefer(theme="dark")
    outside = complex(-10, SIZE / 2)
    assert 80 < pixel(window, outside).min() < 120
    window.act(cut_out_editing.set_enclosed_removed, "remove")
    rest(window)
    assert 80 < pixel(window, outside).min() < 120
    window.act(editing.undo)
    rest(window)
    assert 80 < pixel(window, outside).min() < 120


@pytest.fixture(autouse=True)
def _without_settings(window):
    """Close the settings, which would cover a part of the drawing, as if they were never opened."""
    del window  # it must be there
    bar = imgui.internal.find_window_by_name("###mode")
    if bar is not None:
        bar.state_storage.clear()


@pytest.fixture
def boots(window, tmp_path):
    """A block with a handle left and right of the middle of its lower half, and a key of each."""
    mask = np.zeros((SIZE, SIZE), dtype=np.bool_)
    mask[10:-10, 10:-10] = True
    Image.fromarray(pictures.painted(mask)).save(tmp_path / "boots.png")
    project = window.open(tmp_path / "boots.png")
    for place in (complex(30, 30), complex(90, 30), complex(60, 100)):
        add_handle(window.session, place)
        window.settle()
    return project


FROM_BELOW = (complex(60, 3), complex(60, 40), complex(60, 70))


def test_a_knife_parts_what_touches_and_nothing_is_seen_of_it_at_rest(window, boots):
    document, outline = boots.document, len(boots.layer.domain.outline)
    before = pixel(window, 60 + 40j)
    window.act(cut_out_editing.toggle_cut_tool, "knife")
    stroke(window, *FROM_BELOW)
    (slit,) = boots.layer.cut_out.cut_lines
    assert slit.points[0] == pytest.approx(FROM_BELOW[0], abs=1)
    assert boots.history.undo_label == "Cut with knife"
    rest(window)
    layer = boots.layer
    assert not layer.is_stale
    assert len(layer.domain.outline) > outline + 8
    assert len(layer.handles) == 3
    window.act(cut_out_editing.toggle_cut_tool, None)
    for place in (60 + 40j, 60 + 12j, 60 + 66j):
        assert tuple(pixel(window, place)) == tuple(before)
    # Both sides can be pulled apart.
    targets = layer.keys[0].pose.targets
    targets_now = {0: Target(position=15 + 30j), 1: Target(position=105 + 30j), 2: targets[2]}
    set_targets(window.session, targets_now)
    window.settle()
    reached = boots.layer_runtime.shown.handle_positions
    assert abs(reached[1] - reached[0]) == pytest.approx(90, abs=0.5)
    assert boots.layer.keys[0].pose.certificate.is_certified
    sides = boots.layer_runtime.shown.mesh.pose_vertices(boots.layer_runtime.shown.pose)[
        : len(layer.domain.outline)
    ]
    beside = np.abs(layer.domain.outline - (60 + 20j)) < 8
    assert np.ptp(sides[beside].real) > 10
    assert pixel(window, 60 + 15j).min() > 200  # the canvas
    window.act(editing.undo)
    window.act(editing.undo)
    assert boots.document is document


def test_a_line_of_the_knife_is_saved_taken_away_and_refused(window, boots, tmp_path):
    window.act(cut_out_editing.toggle_cut_tool, "knife")
    stroke(window, *FROM_BELOW)
    rest(window)
    path = tmp_path / "boots.lissom"
    save_project(path, boots.document)
    assert not differences(boots.document, load_project(path))
    (read,) = load_project(path).layers
    assert len(read.cut_out.cut_lines) == 1
    assert read.domain.closed is not None
    stroke(window, 40 + 3j)  # a click is no line
    assert len(boots.layer.cut_out.cut_lines) == 1
    stroke(window, 3 + 60j, 117 + 62j)
    rest(window)
    told = [toast.text for toast in window.session.notices.toasts]
    assert any(re.search(says(CUTS_OFF), text) for text in told), told
    assert boots.layer.is_stale
    window.act(editing.undo)
    rest(window)
    assert not boots.layer.is_stale

    def alt_click(robot):
        robot.mouse_move_to_pos(window.point(61 + 50j))
        robot.key_down(imgui.Key.mod_alt)
        robot.mouse_down()
        robot.mouse_up()
        robot.key_up(imgui.Key.mod_alt)

    window.run(alt_click)
    assert boots.layer.cut_out.cut_lines == ()
    rest(window)
    assert boots.layer.domain.closed is None


def test_a_line_of_the_knife_through_a_handle_is_refused_at_once(window, boots):
    document = boots.document
    window.act(cut_out_editing.toggle_cut_tool, "knife")
    stroke(window, 30 + 3j, 30 + 60j)
    assert boots.document is document
    name = boots.layer.handles[0].name
    assert any(f"crosses {name}" in toast.text for toast in window.session.notices.toasts)
    stroke(window, 33 + 3j, 33 + 60j)
    rest(window)
    assert boots.layer.domain.closed is not None


def test_a_line_of_the_knife_is_shown_while_it_is_drawn_and_can_be_cancelled(window, boots):
    window.act(cut_out_editing.toggle_cut_tool, "knife")
    before, document = pixel(window, 60 + 40j), boots.document

    def play(robot):
        robot.mouse_move_to_pos(window.point(FROM_BELOW[0]))
        robot.mouse_down()
        for place in FROM_BELOW[1:]:
            robot.mouse_move_to_pos(window.point(place))
        shown.append(window.session.tools.active_tool.shapes(0j, 1.0))
        robot.key_press(window.Key.escape)
        robot.mouse_up()

    shown: list[object] = []
    window.run(play)
    ((mark,),) = shown
    assert len(mark.points) >= 3
    assert boots.document is document
    assert tuple(pixel(window, 60 + 40j)) == tuple(before)
    stroke(window, *FROM_BELOW)
    assert tuple(pixel(window, 60 + 40j)) != tuple(before)
