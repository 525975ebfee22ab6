"""The manual's pictures of the window: samples, opened and used as a person would."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from harness import Robot
from PIL import Image, ImageDraw
from sound_files import sound, wav

from app.document import (
    TRANSFORM,
    VOLUME,
    Channel,
    Target,
    Transform,
    channel_commands,
    sound_commands,
)
from app.document.commands import handle_commands
from app.editor import CurvePoint
from app.editor.actions import dialog_actions, editing, playback, viewing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.actions.timing import cycles, graph, keys, sounds
from app.editor.actions.timing.channel_keys import key_camera
from app.editor.layering.footage import add_footage
from app.editor.layering.layer_selection import set_active_layer, toggle_tree_row
from app.editor.poses import copying, library, pasting
from app.storage import sample_images
from tests.manual.film import Film
from tests.manual.stage import (
    SIZE,
    project_of,
    save,
    scroll_to,
)
from tests.readme.window import come_to_rest, handle_named, open_sample

NOSE = 75 + 840j  # of the giraffe
HEAD = 530 + 790j  # of the child
# How far a giraffe's hooves are from where they stand, at the four keys of a walk.
FORE, LIFT = 55 + 0j, 35j
WALK = {
    "near front hoof": (-FORE, LIFT, FORE, 0j),
    "far front hoof": (FORE, 0j, -FORE, LIFT),
    "near hind hoof": (FORE, 0j, -FORE, LIFT),
    "far hind hoof": (-FORE, LIFT, FORE, 0j),
}
RIGHT = 1  # the other button of the mouse
HIGHER = (1000, 672)  # of a window where nothing in a tab is cut in half
LAYERED = (1000, 812)


def _still(window: Film, path: Path) -> None:
    """Take a picture of what is on the screen."""
    come_to_rest(window)
    save(window.picture(), path)


def _overview(window: Film, path: Path) -> None:
    """A dragon that is posed, its timeline, and the tabs."""
    project = open_sample(window, "dragon", frame=36)
    wishes = {"snout": 90 + 740j, "brow": 270 + 810j}
    window.act(
        set_targets,
        {handle_named(project, name): Target(position=at) for name, at in wishes.items()},
    )
    window.settle()
    window.act(editing.select_handles, frozenset({handle_named(project, "snout")}))
    window.show_tab("Handle")
    _still(window, path)


def _timing(window: Film, path: Path) -> None:
    """The menu of a key."""
    open_sample(window, "dragon", frame=24)
    window.show_tab("Handle")
    come_to_rest(window)

    def ask(robot: Robot) -> None:
        robot.item_click("###Timeline/**/key 24", RIGHT)
        robot.yield_(2)
        robot.mouse_move("//$FOCUSED/Tangent")
        robot.yield_(30)

    save(window.seen_by(ask).crop((0, 180, *SIZE)), path)


def _graph(window: Film, path: Path) -> None:
    """A dragon that hops, by four keys of its transform, as curves."""
    project = open_sample(window, "dragon", frame=12)
    moved = Channel(TRANSFORM, project.layer.id)
    hops = (Transform(), Transform(60 + 140j, 0.2, 1.1), Transform(130 + 0j, -0.1), Transform())
    for frame, value in zip((0, 12, 24, 48), hops, strict=True):
        window.act(editing.edit_document, channel_commands.set_key(moved, frame, value))
    window.act(graph.toggle_graph)
    graph.show_channel(window.session, moved, adds=False)
    window.frames(10)
    up = graph.shown_curves(project)[1]
    window.act(graph.select_points, frozenset({CurvePoint(up, 12), CurvePoint(up, 24)}))
    _still(window, path)


def _feet(window: Film, path: Path) -> None:
    """Hooves that stay, with the line below each that tells of it."""
    project = open_sample(window, "giraffe", frame=15)
    window.show_tab("Handle")
    window.act(editing.select_handles, frozenset({handle_named(project, "near front hoof")}))
    window.act(viewing.zoom_to_pose)
    come_to_rest(window)
    scroll_to(window, "**/Free between keys")
    _still(window, path)


def _walk(window: Film, path: Path) -> None:
    """A giraffe's walk repeats: one stretch of five keys, and its hatched repeats."""
    project = open_sample(window, "giraffe", frame=0)
    window.act(editing.select_keys, frozenset({30, 38, 72}))
    window.act(editing.delete_selection)
    rests = {handle.name: handle.position for handle in project.layer.handles}
    for number, frame in enumerate((0, 6, 12, 18)):
        window.act(playback.seek, frame)
        window.settle()
        wishes = {
            handle_named(project, name): Target(position=rests[name] + ways[number])
            for name, ways in WALK.items()
        }
        window.act(set_targets, wishes)
        window.settle()
    window.act(playback.seek, 0)
    window.act(copying.copy_pose_or_keys)
    window.act(playback.seek, 24)
    window.act(pasting.paste_copied)
    window.settle()
    window.session.notices.toasts.clear()  # what copying told
    window.act(keys.toggle_loop)
    window.act(keys.set_last_frame, 96)
    window.act(editing.select_keys, frozenset({0, 6, 12, 18, 24}))
    window.act(cycles.create_cycle)
    window.settle()
    window.act(playback.seek, 48)
    window.show_tab("Handle")
    window.act(viewing.zoom_to_pose)
    _still(window, path)


def _poses(window: Film, path: Path) -> None:
    """Poses that are kept, and the poses before and after."""
    project = open_sample(window, "dragon", frame=0)
    for frame, name in {0: "calm", 24: "tail up", 48: "tail back"}.items():
        window.act(playback.seek, frame)
        window.settle()
        window.act(library.save_pose_to_library)
        window.settle()
        window.act(library.rename_library_pose, project.layer.library[-1].name, name)
    window.act(playback.seek, 37)
    window.act(viewing.toggle_overlay, "onion")
    window.resize(HIGHER)
    window.show_tab("Animate")
    _still(window, path)


def _ready_motions(window: Film, path: Path) -> None:
    """A giraffe that is about to walk: where its joints are."""
    window.open(sample_images() / "giraffe.png")
    window.resize((1000, 804))
    window.act(preset_setup.begin_motion_setup)
    come_to_rest(window)
    window.act(viewing.zoom_to_pose)
    _still(window, path)


def _front(window: Film, path: Path) -> None:
    """Two arms of an octopus cross; one of them is painted in front."""
    project = open_sample(window, "octopus", frame=16)
    window.act(editing.select_handles, frozenset({handle_named(project, "left 4")}))
    window.resize((1000, 696))
    window.show_tab("Handle")
    come_to_rest(window)
    scroll_to(window, "//Handle/**/key depth")
    _still(window, path)


def _stretch(window: Film, path: Path) -> None:
    """The limits of a giraffe, and how much of them its pose uses."""
    open_sample(window, "giraffe", frame=30)
    window.resize(HIGHER)
    window.show_tab("Shape")
    window.act(viewing.zoom_to_pose)
    come_to_rest(window)
    window.run(lambda robot: robot.item_open("**/Details"))
    _still(window, path)


def _distortion(window: Film, path: Path) -> None:
    """How far a giraffe is squeezed where it bends to the ground."""
    open_sample(window, "giraffe", frame=30)
    window.act(viewing.zoom_to_pose)
    window.act(viewing.show_heat_map, "sigma_b")
    window.show_tab("Measure")
    _still(window, path)


def _mesh(window: Film, path: Path) -> None:
    """The triangles and the cage of a dragon."""
    window.open(sample_images() / "dragon.png")
    window.resize(HIGHER)
    window.act(viewing.toggle_overlay, "wireframe")
    window.show_tab("Shape")
    window.run(lambda robot: robot.item_open("//Shape/**/###more of shape"))
    scroll_to(window, "//Shape/**/###rebuild")
    _still(window, path)


def _layers(window: Film, path: Path) -> None:
    """A child of many layers; the arm hangs on the body."""
    project = open_sample(window, "friend", frame=14)
    arm = next(layer.id for layer in project.document.layers if layer.name == "right arm")
    window.act(set_active_layer, arm)
    window.act(editing.select_handles, frozenset({handle_named(project, "hand")}))
    window.resize(LAYERED)
    window.show_tab("Layers")
    _still(window, path)


def _mouths(window: Film, path: Path) -> None:
    """Two mouths take turns by a click on a circle."""
    project = open_sample(window, "friend", frame=36)
    window.resize(LAYERED)
    window.show_tab("Layers")
    window.act(
        toggle_tree_row,
        next(row.toggle for row in project.tree if row.switch_group is not None),
    )
    head = next(layer.id for layer in project.document.layers if layer.name == "head")
    window.act(set_active_layer, head)
    _still(window, path)


def _camera(window: Film, path: Path) -> None:
    """The frame of a camera around a child's head, and its keys below the ruler."""
    open_sample(window, "friend", frame=0)
    window.show_tab("Layers")
    window.act(viewing.set_view, None)
    window.act(key_camera)
    window.act(playback.seek, 48)
    window.settle()
    whole = project_of(window).view_on(window.session.display.screen)
    window.act(viewing.set_view, replace(whole, centre=HEAD, scale=1.9 * whole.scale))
    window.act(key_camera)
    window.settle()
    window.act(viewing.set_view, None)
    window.act(playback.seek, 30)
    _still(window, path)


def _sound(window: Film, path: Path) -> None:
    """A sound with its waveform below the ruler, and its settings."""
    open_sample(window, "friend", frame=36)
    times = np.arange(3 * 44_100) / 44_100
    words = np.clip(np.sin(14.5 * times) * np.sin(2.3 * times + 1), 0, 1)
    talk = sound(wav((words * np.sin(1_100 * times))[:, None], 44_100), "hello.wav", start=10)
    window.act(editing.edit_document, sound_commands.add_sound(talk))
    channel = Channel(VOLUME, part=talk.name)
    for frame, volume in ((14, 0.2), (30, 1.0)):
        window.act(editing.edit_document, channel_commands.set_key(channel, frame, volume))
    window.act(sounds.select_sound, talk.name)
    window.show_tab("Animate")
    scroll_to(window, "//Animate/**/##seconds")
    _still(window, path)


def _footage(window: Film, path: Path) -> None:
    """A rough wave in numbered pictures, as a reference over a child."""
    open_sample(window, "friend", frame=0)
    width, height = project_of(window).document.canvas
    with TemporaryDirectory() as folder:
        for number in range(24):
            rough = Image.new("RGBA", (width, height))
            draw, centre = ImageDraw.Draw(rough), complex(width / 2, height * 0.45)
            lift = 0.6 + 0.5 * np.sin(number / 24 * 2 * np.pi)
            hand = centre + 0.3 * width * np.exp(-1j * lift)
            for end in (hand, centre - 0.25 * width * np.exp(-0.5j), centre + 0.35j * height):
                ends = [centre.real, centre.imag, end.real, end.imag]
                draw.line(ends, fill=(30, 90, 220, 255), width=width // 40)
            rough.save(Path(folder, f"rough_{number:02}.png"))
        add_footage(window.session, Path(folder, "rough_00.png"), is_reference=True)
        window.settle()
        window.act(playback.seek, 8)
        window.show_tab("Layers")
        window.settle()
        scroll_to(window, "//Layers/**/##footage speed")
        for toast in tuple(window.session.notices.toasts):
            window.session.notices.dismiss(toast)
        _still(window, path)


def _export(window: Film, path: Path) -> None:
    """What will be exported of an octopus."""
    open_sample(window, "octopus", frame=28)
    window.act(viewing.toggle_overlay, "handles")
    window.resize((1000, 810))
    window.show_tab("Export")
    _still(window, path)


def _formats(window: Film, path: Path) -> None:
    """The list of formats."""
    open_sample(window, "giraffe", frame=0)
    window.resize((1000, 780))
    window.show_tab("Export")
    come_to_rest(window)

    def ask(robot: Robot) -> None:
        robot.item_click("//###Export/##format")
        robot.yield_(30)

    save(window.seen_by(ask), path)


def _limit(window: Film, path: Path) -> None:
    """A nose that is wanted too far away, and what is said of it."""
    project = window.open(sample_images() / "giraffe.png")
    for place in (NOSE, 390 + 540j, 590 + 460j, 352 + 65j, 485 + 80j, 580 + 65j, 265 + 80j):
        window.act(add_handle, place)
    nose = project.layer.handles[0].id
    window.act(editing.edit_layer, handle_commands.rename_handle, nose, "nose")
    window.show_tab("Handle")
    window.settle()
    window.drag(window.point(NOSE), window.point(NOSE - 800 - 300j))
    window.settle()
    window.act(viewing.zoom_to_pose)
    window.frames(20)
    save(window.picture(), path)


def _sheet(window: Film, path: Path) -> None:
    """The sheet of keys."""
    open_sample(window, "giraffe", frame=0)
    window.resize((1280, 1000))
    window.act(dialog_actions.show_shortcuts)
    _still(window, path)
    window.act(dialog_actions.close_dialog)


def _welcome(window: Film, path: Path) -> None:
    """What is seen at first."""
    window.resize((1000, 780))
    window.frames(20)
    _still(window, path)


STILLS: dict[str, Callable[[Film, Path], None]] = {
    "overview": _overview,
    "welcome": _welcome,
    "timing": _timing,
    "graph": _graph,
    "feet": _feet,
    "walk": _walk,
    "poses": _poses,
    "ready-motions": _ready_motions,
    "front": _front,
    "stretch": _stretch,
    "distortion": _distortion,
    "mesh": _mesh,
    "layers": _layers,
    "mouths": _mouths,
    "camera": _camera,
    "sound": _sound,
    "footage": _footage,
    "export": _export,
    "formats": _formats,
    "limit": _limit,
    "sheet": _sheet,
}
