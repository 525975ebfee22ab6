"""The manual's clips of the window: a hand does what the page tells."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from imgui_bundle import imgui
from PIL import Image, ImageDraw

from app.document.commands import handle_commands
from app.document.settings import Meshing
from app.editor.actions import editing, playback, viewing
from app.editor.actions.layer_setup import cut_out_editing, stiffness_editing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.timing import keys, tracks
from app.storage import sample_images
from tests.manual.film import Film
from tests.manual.stage import (
    at,
    open_calm_dragon,
    place_of,
    play,
    project_of,
    pull,
    scroll_to,
)
from tests.readme.window import come_to_rest, handle_named, open_sample

MAGNET = 880 + 880j  # beside the child's head
EAR = 262 + 1010j  # of the giraffe


def _first_minute(window: Film, path: Path) -> None:
    """A picture, three handles, two keys, and it moves."""
    window.session.settings.default_meshing = Meshing(triangles=6_000)
    window.open(sample_images() / "dragon.png")
    window.show_tab("Handle")
    come_to_rest(window)
    window.put(window.point(-60 + 300j))
    with window.filmed(path):
        window.stay(20)
        for place in (90 + 620j, 440 + 80j, 605 + 80j, 930 + 275j):
            window.click(window.point(place))
        head = window.point(90 + 620j)
        window.drag(head, window.point(85 + 715j))
        window.click(at(window, 24))
        window.drag(window.point(85 + 715j), window.point(150 + 510j))
        with window.cut():
            window.act(keys.toggle_loop)
            window.settle()
        window.go(window.point(-60 + 300j))
        play(window, 3.0)
    playback.stop_playback(window.session)


def _pose(window: Film, path: Path) -> None:
    """A giraffe looks up, between two keys: that makes a third."""
    project = open_sample(window, "giraffe", frame=0)
    window.show_tab("Handle")
    window.act(editing.select_handles, frozenset({handle_named(project, "nose")}))
    come_to_rest(window)
    window.put(window.point(-150 + 700j))
    with window.filmed(path):
        window.stay(20)
        pull(window, "nose", 130 - 60j, 30 + 90j)
        window.click(at(window, 16))
        window.settle()
        window.stay(20)
        pull(window, "tail", 90 + 120j)
        window.stay(40)


def _photo(folder: Path) -> Path:
    """Make a photo of a paper layer on a wall, with a magnet beside it."""
    with Image.open(sample_images() / "character.png") as drawing:
        layer = drawing.convert("RGBA")
    width, height = layer.size
    grain = np.random.default_rng(1).normal(0, 1, (height, width, 1))
    shade = np.linspace(212, 200, height)[:, None, None] + grain
    wall = np.clip(shade * np.array([1.0, 0.985, 0.95]), 0, 255).astype(np.uint8)
    picture = Image.fromarray(wall)
    x, y = MAGNET.real, height - MAGNET.imag
    ImageDraw.Draw(picture).ellipse((x - 50, y - 50, x + 50, y + 50), fill=(70, 120, 190))
    picture.paste(layer, mask=layer.getchannel("A"))
    path = folder / "photo.jpg"
    picture.save(path, quality=92)
    return path


def _cut_out(window: Film, path: Path) -> None:
    """A photo: the wall is gone, and a magnet on it goes by the brush."""
    with TemporaryDirectory() as scratch:
        window.open(_photo(Path(scratch)))
        window.act(cut_out_editing.toggle_cut_tool, "keep")
        window.settle()
        window.run(lambda robot: robot.item_click("//###mode/###cut-out settings"))
        window.session.notices.toasts.clear()  # what opening it told
        come_to_rest(window)
        window.put(window.point(-60 + 300j))
        with window.filmed(path):
            window.stay(30)
            window.click(window.item("//###mode/###remove tool"))
            with window.cut():
                window.act(cut_out_editing.set_brush_radius, 60.0)
                window.settle()
            stroke = (MAGNET - 45 + 20j, MAGNET + 50 - 15j)
            window.drag(*map(window.point, stroke), frames=24)
            window.settle()
            window.stay(30)
            window.click(window.item("//###mode/###done"))
            window.stay(40)


def _tail_wag(window: Film, path: Path) -> None:
    """A track of the dragon's tail tip, beside its other keys."""
    project = open_calm_dragon(window)
    window.act(editing.select_handles, frozenset({handle_named(project, "tail tip")}))
    come_to_rest(window)
    window.put(window.point(-60 + 300j))
    with window.filmed(path):
        window.stay(20)
        window.click(window.item("//Handle/**/###Key this handle only"))
        for frame, way in ((6, -130 + 40j), (18, 150 - 90j)):
            window.click(at(window, frame))
            window.settle()
            pull(window, "tail tip", way, frames=24)
            window.settle()
        with window.cut():
            window.act(playback.seek, 24)
            window.settle()
            track = project.layer.tracks[0]
            window.act(tracks.set_handle_value, track.handles[0], 0j, 0.0)
            window.settle()
        window.stay(20)
        window.go(window.point(-60 + 300j))
        play(window, 4.0)
    playback.stop_playback(window.session)


def _record(window: Film, path: Path) -> None:
    """The dragon's tail is dragged while time goes on."""
    project = open_calm_dragon(window)
    window.act(editing.select_handles, frozenset({handle_named(project, "tail tip")}))
    come_to_rest(window)
    window.put(window.point(-60 + 300j))
    start = place_of(window, "tail tip")
    ways = (-150 + 60j, 160 - 60j, -120 + 90j, 60 - 20j)
    with window.filmed(path):
        window.stay(20)
        window.click(window.item("###Timeline/**/###Record drag"))
        window.drag(*(window.point(start + way) for way in (0, *ways)), frames=26)
        window.settle()
        window.stay(60)
    window.run(lambda robot: robot.key_press(int(imgui.Key.enter)))


def _ears(window: Film, path: Path) -> None:
    """An ear that follows the head."""
    project = open_sample(window, "giraffe", frame=0)
    window.act(add_handle, EAR)
    window.settle()
    ear = project.layer.handles[-1]
    window.act(editing.edit_layer, handle_commands.rename_handle, ear.id, "ear")
    window.show_tab("Handle")
    window.act(editing.select_handles, frozenset({ear.id}))
    come_to_rest(window)
    scroll_to(window, "//Handle/**/###ear")
    window.put(window.point(-150 + 700j))
    with window.filmed(path):
        window.stay(20)
        window.click(window.item("//Handle/**/###ear"))
        window.settle()
        window.go(window.point(-150 + 700j))
        play(window, 3.4)
    playback.stop_playback(window.session)


def _walking(window: Film, path: Path) -> None:
    """A giraffe that has no handle yet is told to walk, and walks."""
    window.session.settings.default_meshing = Meshing(triangles=6_000)
    window.open(sample_images() / "giraffe.png")
    window.show_tab("Animate")
    come_to_rest(window)
    window.put(window.point(-150 + 700j))
    with window.filmed(path):
        window.stay(20)
        window.type(imgui.Key.a)
        window.stay(60)
        window.click(window.item("//Animate/**/###give"))
        with window.cut():
            window.until(lambda: project_of(window).motion_job is None)
            window.settle()
        window.go(window.point(-150 + 700j))
        window.stay(240)
    playback.stop_playback(window.session)


def _move(window: Film, path: Path) -> None:
    """The octopus goes through the picture as it is."""
    open_sample(window, "octopus", frame=0)
    window.show_tab("Handle")
    window.act(viewing.set_view, None)
    come_to_rest(window)
    window.put(window.point(-60 + 300j))
    with window.filmed(path):
        window.stay(20)
        window.type(imgui.Key.v)
        window.stay(20)
        middle = 545 + 600j
        window.drag(window.point(middle), window.point(middle + 230 - 50j))
        window.settle()
        window.stay(30)


def _stiff(window: Film, path: Path) -> None:
    """Hands and head are stiff, and an arm has its bone."""
    project = open_sample(window, "character", frame=22)
    window.show_tab("Shape")
    ends = (handle_named(project, "right elbow"), handle_named(project, "right hand"))
    window.act(stiffness_editing.add_bone, ends)
    window.act(stiffness_editing.toggle_stiffness_tool, "stiff")
    window.act(cut_out_editing.set_brush_radius, 130.0)
    window.settle()
    come_to_rest(window)
    window.put(window.point(-60 + 300j))
    with window.filmed(path):
        window.stay(20)
        window.drag(*map(window.point, (370 + 800j, 450 + 960j, 620 + 960j, 690 + 800j)), frames=26)
        window.settle()
        window.stay(40)


FILMS: dict[str, Callable[[Film, Path], None]] = {
    "first-minute": _first_minute,
    "pose": _pose,
    "cut-out": _cut_out,
    "tail-wag": _tail_wag,
    "record": _record,
    "ears": _ears,
    "walking": _walking,
    "move": _move,
    "stiff": _stiff,
}
