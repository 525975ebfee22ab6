"""What films and pictures of the window have in common: where things are, and what hands do."""

from pathlib import Path

from harness import FRAME
from imgui_bundle import ImVec2, imgui
from PIL import Image

from app.document import Target
from app.editor.actions import (
    editing,
    playback,
)
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.parts.timeline.time_range import TimeRangeView
from app.editor.project import Project
from tests.manual.film import Film
from tests.readme.window import handle_named, open_sample

SIZE = (1000, 640)


def save(picture: Image.Image, path: Path) -> None:
    """Write a picture in as few colours as it needs."""
    picture.quantize(256, dither=Image.Dither.NONE).save(path.with_suffix(".png"), optimize=True)


def at(window: Film, frame: float) -> ImVec2:
    """Return where a frame is on the timeline's ruler."""
    low, high = window.room_of("###Timeline/**/ruler")
    timing, frames = project_of(window).timeline, project_of(window).document.frames
    em = window.text_height()
    strip = timing.time_range or TimeRangeView.fitting(frames, (high.x - low.x) / em)
    return ImVec2(low.x + strip.place(frame) * em, (low.y + high.y) / 2)


def project_of(window: Film) -> Project:
    project = window.session.project
    assert project is not None
    return project


def place_of(window: Film, name: str) -> complex:
    """Return where a handle is in what is shown, in the drawing's plane."""
    project = project_of(window)
    shown = project.layer_runtime.shown
    assert shown is not None
    identities = [handle.id for handle in project.layer.handles]
    return complex(shown.handle_positions[identities.index(handle_named(project, name))])


def pull(window: Film, name: str, *way: complex, frames: int = 30) -> None:
    """Drag a handle by so much, from one to the next."""
    start = place_of(window, name)
    window.drag(*(window.point(start + step) for step in (0, *way)), frames=frames)


def play(window: Film, seconds: float) -> None:
    window.type(imgui.Key.space)
    window.stay(round(seconds / FRAME))


def scroll_to(window: Film, item: str) -> None:
    """Scroll a tab until an item is seen."""
    window.run(lambda robot: robot.scroll_to_item_y(item))
    window.frames(4)


def open_calm_dragon(window: Film) -> Project:
    """Open a dragon whose head nods within 48 frames, while nothing else moves."""
    project = open_sample(window, "dragon", frame=0)
    for frame in (24, 48):
        window.act(editing.select_keys, frozenset({frame}))
        window.act(editing.delete_selection)
    window.settle()
    window.act(playback.seek, 36)
    window.settle()
    snout = Target(position=110 + 520j)
    window.act(set_targets, {handle_named(project, "snout"): snout})
    window.settle()
    window.act(playback.seek, 0)
    window.act(editing.select_keys, frozenset())
    window.settle()
    window.show_tab("Handle")
    return project
