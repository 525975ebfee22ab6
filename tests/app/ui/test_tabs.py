from dataclasses import replace

import numpy as np
import pytest
from documents import CENTRE, RADIUS, altered, disc_document
from imgui_bundle import ImVec2, imgui
from PIL import Image
from projects import project_of
from sessions import run_update_steps

from app.document import channel_commands, pose_channel, scene_commands
from app.document.commands.keys import (
    key_commands,
)
from app.document.commands.scene_commands import set_export
from app.document.keyframe import Handle, Keyframe, Pose, Target
from app.document.settings import NATURAL, RUBBERY, STIFF, Meshing
from app.editor.actions import editing, playback
from app.editor.actions.layer_setup.resolving import SOLVING_KEYS
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.pose_drag import set_targets
from app.export_formats import MeshOptions, SpriteSheetOptions
from app.motion.extents.extent import extent_key
from app.storage import NO_FOLDER
from engine.maps.boundary import Boundary
from engine.maps.certificate import certify
from engine.maps.harmonic_map import HarmonicMap

STRETCH = 0.3


@pytest.fixture(scope="module")
def _stretched():
    """A disc with two handles: at rest at frame 0, stretched sideways at frame 24."""
    (empty,) = disc_document().layers
    domain, rest = empty.domain, empty.keys[0].pose
    boundary = Boundary.sample(domain)
    handles = (
        Handle(id=0, name="left", position=CENTRE - RADIUS / 2),
        Handle(id=1, name="right", position=CENTRE + RADIUS / 2),
    )
    keys = []
    for frame, factor in ((0, 0.0), (24, STRETCH)):
        psi = factor * (domain.cage - CENTRE)
        shape = HarmonicMap(cage=domain.cage, phi=rest.phi, psi=psi)
        places = shape(np.array([handle.position for handle in handles]))
        targets = {
            handle.id: Target(position=complex(place))
            for handle, place in zip(handles, places, strict=True)
        }
        pose = Pose(
            targets=targets,
            phi=rest.phi,
            psi=psi,
            certificate=certify(shape, boundary, empty.bounds),
        )
        keys.append(Keyframe(frame=frame, pose=pose))
    return altered(disc_document(), handles=handles, next_handle=2, keys=tuple(keys))


@pytest.fixture
def project(window, _stretched):
    y, x = np.mgrid[200:0:-1, 0:200] - 0.5
    inside = np.abs(x + 1j * y - CENTRE) < RADIUS
    rgba = np.where(inside, 255, 0).astype(np.uint8)[..., None].repeat(4, axis=2)
    window.session.project = project_of(_stretched, rgba, "disc")
    playback.seek(window.session, 24)
    window.settle()
    return window.session.project


MORE = "**/###more of shape"


@pytest.fixture
def tab(window):
    """A function that lets the robot play in a tab, and waits for what that leads to."""

    def play(title, act):
        def body(robot):
            robot.set_ref(f"//{title}")
            act(robot)

        window.show_tab(title)
        window.run(body)
        window.settle()

    return play


def largest(project, field):
    return max(getattr(key.pose.certificate, field) for key in project.layer.keys)


def test_handle_is_chosen_renamed_weighed_and_deleted(project, tab):
    tab("Handle", lambda robot: robot.item_click("**/###handle 0"))
    assert project.selection.handles == {0}

    def change(robot):
        robot.item_input_value("**/##name", "paw")
        robot.item_input_value("**/##weight", 2.5)

    tab("Handle", change)
    handle = project.layer.handle(0)
    assert (handle.name, handle.weight) == ("paw", 2.5)
    tab("Handle", lambda robot: robot.item_click("**/###delete handles"))
    assert [handle.id for handle in project.layer.handles] == [1]
    assert project.history.undo_label == "Delete handle"


def test_target_typed_in_poses_the_shape(window, project, tab):
    editing.select_handles(window.session, frozenset({1}))
    before = project.layer.key(24).pose
    target = before.targets[1].position
    tab(
        "Handle",
        lambda robot: robot.item_input_value(
            "**/##target y", project.document.canvas[1] - target.imag + 20.0
        ),
    )
    after = project.layer.key(24).pose
    assert after.targets[1].position == pytest.approx(target - 20j, abs=0.01)
    place = project.layer.map_of(after)(np.array([project.layer.handle(1).position]))
    np.testing.assert_allclose(place, target - 20j, rtol=0, atol=2)


def test_turn_is_taken_from_the_shape_then_typed_then_freed(window, project, tab):
    editing.select_handles(window.session, frozenset({1}))
    turn = project.layer_runtime.shown.handle_rotations[1]
    tab("Handle", lambda robot: robot.item_click("**/##turns"))
    assert project.layer.key(24).pose.targets[1].rotation == pytest.approx(turn, abs=1e-6)
    tab("Handle", lambda robot: robot.item_input_value("**/##angle", 10.0))
    rotation = project.layer.key(24).pose.targets[1].rotation
    assert rotation == pytest.approx(np.radians(10.0), abs=1e-4)
    tab("Handle", lambda robot: robot.item_click("**/##turns"))
    assert project.layer.key(24).pose.targets[1].rotation is None


def test_anchor_goes_to_the_handle_and_back(window, project, tab):
    editing.select_handles(window.session, frozenset({0}))
    tab("Handle", lambda robot: robot.item_click("**/###anchor here"))
    assert project.layer.anchor == project.layer.handle(0).position
    tab("Handle", lambda robot: robot.item_click("**/###clear anchor"))
    assert project.layer.anchor is None


def enter_bound(robot, name, value):
    """Type a bound into its field, which stands under "Details"."""
    robot.item_open("**/Details")
    robot.item_input_value(f"**/##bound {name}", value)


def test_one_word_sets_all_three_bounds(window, project, tab):
    assert project.layer.bounds == NATURAL.bounds, "new drawings are natural"
    before = project.document
    tab("Shape", lambda robot: robot.item_click("**/stretch/###Rubbery"))
    assert project.layer.bounds == RUBBERY.bounds
    assert project.history.undo_label == "Set limits"
    editing.undo(window.session)
    assert project.document is before
    tab("Shape", lambda robot: robot.item_click("**/stretch/###Stiff"))
    assert project.layer.bounds == STIFF.bounds
    assert all(project.layer.is_proven(key.pose) for key in project.layer.keys)


def test_tighter_bounds_bring_keys_in_as_one_step(window, project, tab):
    before = project.document
    reached = largest(project, "k")
    bound = round(0.6 * reached, 2)
    tab("Shape", lambda robot: enter_bound(robot, "k", bound))
    assert project.layer.bounds.k == pytest.approx(bound, abs=1e-6)
    assert largest(project, "k") <= bound
    assert all(key.pose.certificate.is_certified for key in project.layer.keys)
    assert project.layer.key(0).pose is before.layers[0].key(0).pose
    assert project.history.undo_label == "Set limits"
    editing.undo(window.session)
    assert project.document is before


def test_knob_that_is_dragged_sets_the_bound_once(window, project, tab):
    before = project.document

    def drag(robot):
        robot.item_open("**/Details")
        name = "**/bound sigma_a track"
        middle = robot.item_info(name).rect_full.get_center()
        robot.mouse_move(name)
        robot.mouse_down(0)
        robot.mouse_move_to_pos(ImVec2(middle.x + 90, middle.y))
        assert project.document is before
        assert project.layer_setup.previewed_limits.sigma_a > NATURAL.bounds.sigma_a
        robot.mouse_up(0)

    tab("Shape", drag)
    assert project.layer.bounds.sigma_a > NATURAL.bounds.sigma_a
    assert project.layer_setup.previewed_limits is None
    editing.undo(window.session)
    assert project.document is before
    editing.redo(window.session)
    tab("Shape", lambda robot: robot.item_click("**/stretch/###Natural"))
    assert project.layer.bounds == NATURAL.bounds


def test_pose_that_no_handle_holds_is_brought_within_the_bounds(window, project, tab):
    remove_handles(window.session, frozenset({0, 1}))
    bound = round(0.5 * largest(project, "k"), 2)
    tab("Shape", lambda robot: enter_bound(robot, "k", bound))
    certificate = project.layer.key(24).pose.certificate
    assert certificate.is_certified
    assert certificate.k <= bound + 1e-6


def test_cancelled_solving_changes_nothing(project, window):
    before = project.document

    def act(robot):
        robot.set_ref("//Shape")
        robot.item_click("**/Re-pose all keys")
        robot.item_click("**/###stop")

    window.show_tab("Shape")
    # A fast machine would be done before the button is found.
    with window.session.jobs.held(SOLVING_KEYS):
        window.run(act)
    window.settle()
    assert project.document is before
    assert project.key_resolver is None


@pytest.mark.usefixtures("everything")
def test_heat_map_and_curves_follow_the_document(window, project, tab):
    def act(robot):
        robot.item_click("**/heat map/###sigma_a")
        robot.item_click("**/curves/###absolute")

    tab("Measure", act)
    assert window.session.display.overlays.heat_map == "sigma_a"
    curves = project.measured.curves.value
    assert curves.clip == project.clip
    assert curves.k_share.max() <= 1 + 1e-3
    assert curves.k.max() == pytest.approx(largest(project, "k"), rel=0.1)
    editing.edit_document(
        window.session, channel_commands.move_keys({pose_channel(0): frozenset({24})}, 4)
    )
    window.settle()
    assert project.measured.curves.follows(project.clip)
    assert project.measured.curves.value.frames[-1] == 28


@pytest.mark.usefixtures("everything")
def test_curves_of_an_older_document_are_not_kept(window, project, tab):
    tab("Measure", lambda _: None)
    editing.edit_document(
        window.session, channel_commands.move_keys({pose_channel(0): frozenset({24})}, 4)
    )
    older = project.document
    run_update_steps(window.session)
    editing.edit_document(
        window.session, channel_commands.move_keys({pose_channel(0): frozenset({28})}, 4)
    )
    window.settle()
    assert project.measured.curves.follows(project.clip)
    assert project.document is not older


@pytest.mark.usefixtures("project")
@pytest.mark.usefixtures("everything")
def test_curves_are_saved_as_picture_and_table(window, tab, tmp_path):
    for suffix in (".png", ".csv"):

        def act(robot, suffix=suffix):
            robot.item_click(f"**/###{suffix[1:]}")
            window.session.dialogs.current = replace(
                window.session.dialogs.current, folder=tmp_path
            )

        tab("Measure", act)
        window.run(lambda robot: robot.item_click("//###dialog/Save"))
        window.settle()
    table = np.genfromtxt(tmp_path / "disc distortion.csv", delimiter=",", names=True)
    assert table["frame"][-1] == 24
    assert max(table["k_share_0"]) <= 1 + 1e-3
    with Image.open(tmp_path / "disc distortion.png") as picture:
        assert picture.size[0] > 1000


@pytest.mark.usefixtures("project")
def test_outline_cage_and_mesh_are_shown(window, tab):
    before = window.picture()

    def act(robot):
        robot.item_open(MORE)
        for name in ("Outline", "Cage", "Mesh"):
            robot.item_click(f"**/{name}")

    tab("Shape", act)
    overlays = window.session.display.overlays
    assert (overlays.outline, overlays.cage, overlays.wireframe) == (True, True, True)
    assert window.picture() != before


def test_rebuilt_domain_keeps_handles_and_poses_as_one_step(window, project, tab):
    before = project.document

    def act(robot):
        robot.item_open(MORE)
        robot.item_click("**/detail/###normal")
        robot.item_input_value("**/##triangles", 4000.0)
        robot.item_click("**/###rebuild")

    tab("Shape", act)
    after = project.document
    assert after.layers[0].meshing == Meshing(triangles=4_000, detail="normal")
    counts = [len(document.layers[0].domain.mesh.triangles) for document in (before, after)]
    assert counts[1] > 1.5 * counts[0]
    assert after.layers[0].handles == before.layers[0].handles
    for frame in (0, 24):
        old, new = before.layers[0].key(frame).pose, after.layers[0].key(frame).pose
        assert new.certificate.is_certified
        places = np.array([handle.position for handle in after.layers[0].handles])
        np.testing.assert_allclose(
            after.layers[0].map_of(new)(places),
            before.layers[0].map_of(old)(places),
            rtol=0,
            atol=3,
        )
    assert after.layers[0].key(0).pose.certificate.k < 1e-6
    assert project.history.undo_label == "Rebuild domain"
    editing.undo(window.session)
    assert project.document is before


def test_rebuilt_domain_keeps_a_pose_that_no_handle_holds(window, project, tab):
    remove_handles(window.session, frozenset({0, 1}))

    def act(robot):
        robot.item_open(MORE)
        robot.item_input_value("**/##triangles", 4000.0)
        robot.item_click("**/###rebuild")

    tab("Shape", act)
    assert project.layer.meshing.triangles == 4_000
    certificate = project.layer.key(24).pose.certificate
    assert certificate.k == pytest.approx(STRETCH, rel=0.01)


def test_error_appears_when_the_domain_cannot_be_built(window, project, tab):
    before = project.document
    project.layer_runtime.picture = replace(
        project.layer_runtime.picture, rgba=np.zeros_like(project.layer_runtime.picture.rgba)
    )

    def act(robot):
        robot.item_open(MORE)
        robot.item_click("**/detail/###fine")
        robot.item_click("**/###rebuild")

    tab("Shape", act)
    assert project.document is before
    assert project.key_resolver is None
    assert [toast.tone for toast in window.session.notices.toasts] == ["error"]


def test_export_settings_are_entered_and_undone(window, project, tab):
    before = project.document
    width, height = project.document.canvas

    def act(robot):
        robot.item_click("**/framing/###fit")
        robot.item_click("**/framing/###canvas")
        robot.item_input_value("**/##width", width // 2)
        robot.item_click("**/range/###own")
        robot.item_input_value("**/##last frame", 3)
        robot.item_click("**/background/###colour")

    tab("Export", act)
    settings = project.document.export
    assert settings.size == (width // 2, round((width // 2) * height / width))
    assert (settings.frames.first, settings.frames.last) == (0, 3)
    assert settings.background == "#ffffff"
    while project.history.undo_label == "Set export":
        editing.undo(window.session)
    assert project.document is before


def test_what_single_formats_ask_is_entered(window, project, tab):
    def lay_out(robot):
        assert robot.item_exists("**/framing/###fit")
        robot.item_click("**/trimmed/###Same size")
        robot.item_input_value("**/##padding", 999)
        robot.item_click("**/power_of_two/###Powers of two")

    def detail(robot):
        assert not robot.item_exists("**/framing/###fit")
        robot.item_input_value("**/##triangles", 900)
        robot.item_click("**/tolerance/###Custom")
        robot.item_input_value("**/##tolerance", 0.25)

    editing.edit_document(
        window.session,
        scene_commands.set_export(replace(project.document.export, format="spritesheet")),
    )
    tab("Export", lay_out)
    wanted = SpriteSheetOptions(trimmed=False, padding=256, power_of_two=True)
    assert project.document.export.sheet == wanted
    editing.edit_document(
        window.session, scene_commands.set_export(replace(project.document.export, format="glb"))
    )
    tab("Export", detail)
    assert project.document.export.shapes == MeshOptions(triangles=900, tolerance=0.25)
    tab("Export", lambda robot: robot.item_click("**/tolerance/###½ px, 8 shapes"))
    assert project.document.export.shapes == MeshOptions(triangles=900)
    assert project.document.export.sheet == wanted


@pytest.mark.usefixtures("everything")
def test_frame_of_the_export_shows_only_with_its_tab(window, project, tab):
    tab("Export", lambda _: None)
    assert window.session.export.frame_box is not None
    window.settle()
    assert project.measured.extent.follows(extent_key(project.document))
    tab("Handle", lambda _: None)
    assert window.session.export.frame_box is None


def note_of_the_frame(window, project):
    """Where the motion reaches, and which places of the panel stand below the note."""
    where = {}

    def look(robot):
        robot.set_ref("//Export")
        where["speed"] = robot.item_info("**/##speed").rect_full.min.y

    window.run(look)
    source = extent_key(project.document)
    return project.measured.extent.follows(source), where["speed"]


@pytest.mark.usefixtures("everything")
def test_extent_follows_undo_and_redo_at_once(window, project, tab):
    tab("Export", lambda _: None)
    first = project.measured.extent.value
    known, place = note_of_the_frame(window, project)
    assert known
    set_targets(window.session, {1: Target(position=CENTRE + 2.5 * RADIUS)})
    window.frames(1)
    known, waiting = note_of_the_frame(window, project)
    window.settle()
    second = project.measured.extent.value
    assert second.upper.real > first.upper.real + 5
    known, after = note_of_the_frame(window, project)
    assert known
    assert place == waiting == after, "the panel does not jump when its note changes"
    editing.undo(window.session)
    window.frames(2)
    assert project.measured.extent.value == first
    editing.redo(window.session)
    window.frames(2)
    assert project.measured.extent.value == second
    editing.undo(window.session)
    tab("Handle", lambda _: None)
    editing.edit_document(window.session, channel_commands.move_keys({pose_channel(0): {24}}, 3))
    window.settle()
    assert project.measured.extent.follows(extent_key(project.document)), (
        "where the tab is hidden, too"
    )


def test_export_starts_repeats_and_reports(window, project, tab, tmp_path):
    session = window.session
    editing.edit_document(
        session, scene_commands.set_export(replace(project.document.export, size=(80, 60)))
    )

    def choose(robot):
        robot.item_click("**/range/###own")
        robot.item_input_value("**/##last frame", 2)
        robot.item_click("**/###choose output")
        session.dialogs.current = replace(session.dialogs.current, folder=tmp_path, name="frames")

    tab("Export", choose)
    window.run(lambda robot: robot.item_click("//###dialog/Choose"))
    window.frames(2)
    assert project.exports.by_format == {"png": tmp_path / "frames"}
    assert not (tmp_path / "frames").exists()
    tab("Export", lambda robot: robot.item_click("**/###start"))
    window.until(lambda: session.export.run is None)
    names = sorted(path.name for path in (tmp_path / "frames").iterdir())
    assert names == [f"frame_{number:04d}.png" for number in range(3)]
    toast = next(toast for toast in session.notices.toasts if toast.tone == "good")
    assert toast.label == "Open folder"
    assert toast.action.arguments == (tmp_path / "frames",)


def test_error_appears_when_an_export_cannot_begin(window, project, tab, tmp_path):
    project.exports.by_format["png"] = tmp_path / "missing" / "frames"
    tab("Export", lambda robot: robot.item_click("**/###start"))
    assert window.session.export.run is None
    assert any(
        NO_FOLDER.format(folder=tmp_path / "missing") in toast.text
        for toast in window.session.notices.toasts
    )


def test_the_export_tab_changes_nothing_by_itself(window, project):
    settings = replace(project.document.export, format="mp4", background="transparent")
    editing.edit_document(window.session, set_export(settings))
    before = project.document
    window.show_tab("Export")
    window.frames(5)
    assert project.document is before
    window.show_tab("Handle")


def test_each_widget_makes_a_step_of_its_own(window, project, tab):
    """A name that is typed, and the track of the weight that is pressed while it still is."""
    editing.select_handles(window.session, frozenset({0}))
    steps = []

    def change(robot):
        robot.item_click("**/##name")
        robot.key_chars_replace("paw")
        track = robot.item_info("**/weight track").rect_full
        robot.mouse_move_to_pos(ImVec2(track.min.x + 0.8 * track.get_width(), track.get_center().y))
        robot.mouse_down(0)
        robot.mouse_move_to_pos(ImVec2(track.min.x + 0.9 * track.get_width(), track.get_center().y))
        robot.mouse_up(0)

    before = project.document
    tab("Handle", change)
    assert project.layer.handle(0).name == "paw"
    assert project.layer.handle(0).weight > 10
    while project.history.undo_label is not None and project.document is not before:
        steps.append(project.history.undo_label)
        editing.undo(window.session)
    assert steps == ["Set handle weight", "Rename handle"]


def test_a_handle_that_is_outweighed_is_not_said_to_be_held_back_by_limits(
    window, project, monkeypatch
):
    """Pulled weakly, far from every limit: all places that tell of it say so, and the same."""
    layer = project.layer
    key = layer.key(24)
    target = Target(position=key.pose.targets[1].position + 12j)
    pose = replace(key.pose, targets={**key.pose.targets, 1: target})
    editing.edit_document(
        window.session, key_commands.replace_key_pose(project.selection.active, 24, pose)
    )
    editing.select_handles(window.session, frozenset({1}))
    written = []
    for name in ("text_unformatted", "text_colored"):
        draw = getattr(imgui, name)
        monkeypatch.setattr(
            imgui, name, lambda *words, draw=draw: (written.append(words[-1]), draw(*words))[-1]
        )
    reason = "held back by the other handles and the shape's stiffness"
    for title in ("Handle", "Measure"):
        written.clear()
        window.show_tab(title)
        text = " ".join(written).lower()
        assert "12 px short of its target" in text, title
        assert reason in text, title
        assert "by the limits" not in text
    assert project.timeline.target_errors.value[pose] == {1: pytest.approx(12, abs=1e-6)}


def test_the_canvas_has_a_size_of_its_own(window, project, tab):
    tab("Export", lambda robot: robot.item_click("**/framing/###canvas"))
    before = project.document
    width, height = before.canvas
    tab("Export", lambda robot: robot.item_input_value("**/##canvas width", width + 40))
    assert project.document.canvas == (width + 40, height)
    assert project.document.layers == before.layers
    tab("Export", lambda robot: robot.item_click("**/###canvas size"))
    assert project.document.canvas == (width, height)
    editing.undo(window.session)
    editing.undo(window.session)
    assert project.document is before
