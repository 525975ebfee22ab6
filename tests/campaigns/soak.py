"""The whole window, used for minutes on end: memory, handles and OpenGL objects do not grow.

Somebody drags, plays, undoes, compares, saves and exports by the window's own clock: most of the
time a small scene of layers, whose pictures cost little, and every now and then a large one.
"""

import shutil
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

import harness
import numpy as np
from harness import Harness
from held import Held, held, in_use, resident
from imgui_bundle import imgui
from layered import blob, openraster
from PIL import Image

from app.document import scene_commands
from app.document.keyframe import Target
from app.document.settings import ExportSettings, FrameRange, Meshing
from app.editor.actions import editing, playback, viewing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import drag_handles, release_drag, set_targets
from app.editor.actions.project_files import exporting, saving
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import attach_layer
from app.export_formats import EXPORT_FORMATS, MeshOptions
from app.render.gpu.context import finish_drawing
from app.storage.assets import sample_images
from app.ui.window.memory import REST, limit_arenas

RATE = 10  # frames a second by the window's clock
DRAG, PLAY = 2.0, 12.0  # seconds by it
DRAGS = 2  # a round
SIZE, LARGER = (800, 560), (960, 640)  # of the window
LARGE_EVERY = 10.0  # minutes by the clock, from the first round on
# Of the time, after which nothing may grow: by then every view, format and large drawing was used.
WARM = 0.5
MOST_SLOPE = 1.0  # MB a minute
FORMATS = [name for name, each in EXPORT_FORMATS.items() if not each.is_still]
WAYS = 4  # of looking at it
TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")


class _OnScreen(Harness):
    """A window whose frames wait until they are drawn, as they do where a screen shows them.

    Without it software OpenGL falls behind on a busy machine, and keeps hundreds of MB of pictures
    that it has yet to draw.
    """

    def _frame(self, *, painted: bool = False) -> None:
        super()._frame(painted=painted)
        with self.gl:
            finish_drawing(self.gl)


def campaign(seed: int, amount: int) -> Iterator[tuple[str, dict[str, float]]]:
    """Use a window for so many minutes by its clock, and yield what was measured on the way."""
    limit_arenas()
    harness.FRAME = 1 / RATE
    window, rng = _OnScreen(), np.random.default_rng(seed)
    window.reset()
    window.resize(SIZE)
    minutes, memory, used, frames = [], [], [], []
    counts: list[Held] = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        small = make_scene(window, folder)
        begun = window.clock.now
        now = large_at = 0.0
        while now < amount:
            if now >= large_at:
                large_at += LARGE_EVERY
                window.open(sample_images() / "friend.lissom")
                use(window, rng, folder, len(minutes), drags=1)
                window.open(small)
            seconds = use(window, rng, folder, len(minutes))
            window.frames(round(REST * RATE) + 1)  # after which the window gives back what is free
            now = (window.clock.now - begun) / 60
            minutes.append(now)
            used.append(in_use())
            memory.append(resident())
            counts.append(held(window.gl))
            frames.append(1e3 * seconds)
            yield (
                f"minute {now:.1f}",
                {
                    "MB": memory[-1],
                    "MB in use": used[-1],
                    **counts[-1]._asdict(),
                    "ms a frame that plays": frames[-1],
                },
            )
    warm = next(k for k, minute in enumerate(minutes) if minute >= WARM * amount)
    for what, taken in (("in use", used), ("of the process", memory)):
        slope, error = fitted_slope(np.array(minutes[warm:]), np.array(taken[warm:]))
        yield (
            f"memory {what}, from minute {minutes[warm]:.0f} on",
            {"slope, MB a minute": slope, "give or take (95 %)": error, "MB in the end": taken[-1]},
        )
        assert slope - error < MOST_SLOPE
    tenths = [float(np.median(part)) for part in np.array_split(frames, 10) if len(part)]
    yield "ms a frame that plays, by tenths", {f"{k}.": ms for k, ms in enumerate(tenths, 1)}
    # A round holds more than another, by what it shows.
    earlier, later = (np.max(half, axis=0) for half in np.array_split(counts[warm:], 2))
    assert (later <= earlier + 2).all(), (earlier, later)


def make_scene(window: Harness, folder: Path) -> Path:
    """Save a project of a body, an arm that hangs on it, and a wall; each layer has handles."""
    layers = [Image.new("RGBA", (160, 120)) for _ in range(2)]
    layers[0].paste(blob(90, 26), (60, 40))
    layers[1].paste(blob(60, 100, (40, 90, 180)), (20, 10))
    layers.append(Image.new("RGBA", (160, 120), (220, 230, 220, 255)))
    stack = "".join(f'<layer name="{n}" src="data/{n}.png"/>' for n in range(3))
    drawing = folder / "scene.ora"
    drawing.write_bytes(openraster((160, 120), stack, layers))
    window.session.settings.default_meshing = Meshing(triangles=1000, detail="coarse")
    project = window.open(drawing)
    arm, body = (layer.id for layer in reversed(project.document.layers[1:]))
    for layer, places in ((body, (50 + 20j, 50 + 95j)), (arm, (70 + 67j, 140 + 67j))):
        window.act(set_active_layer, layer)
        for place in places:
            window.act(add_handle, place)
            window.settle()
    attach_layer(window.session, arm, body)
    window.settle()
    for frame in (12, 24):
        playback.seek(window.session, frame)
        window.settle()
        handle = project.layer.handles[-1]
        target = Target(position=handle.position + 20j * (frame / 12 - 1.5))
        set_targets(window.session, {handle.id: target})
        window.settle()
    saving.write_project(window.session, folder / "scene.lissom", None)
    window.settle()
    return folder / "scene.lissom"


def use(
    window: Harness, rng: np.random.Generator, folder: Path, number: int, drags: int = DRAGS
) -> float:
    """Do what a person does in a round; return the processor's seconds for a frame that plays."""
    session, project = window.session, window.session.project
    before = project.document
    window.show_tab(TABS[number % len(TABS)])
    change_view(window, number)
    for _ in range(drags):
        drag(window, rng)
    seconds = play(window)
    change_view(window, number)
    export(window, folder, FORMATS[number % len(FORMATS)])
    while project.document is not before:
        editing.undo(session)
        window.frames()
    saving.write_project(session, folder / "used.lissom", None)
    window.settle()
    return seconds


def change_view(window: Harness, number: int) -> None:
    """Look at it in another way, or as before: each is its own opposite."""
    session = window.session
    match number % WAYS:
        case 0:
            viewing.toggle_overlay(session, "onion")
            viewing.toggle_theme(session)
        case 1:
            viewing.toggle_heat_map(session)
            viewing.toggle_overlay(session, "wireframe")
        case 2:
            viewing.toggle_comparison(session)
        case 3:
            window.resize(LARGER if imgui.get_io().display_size.x == SIZE[0] else SIZE)
    window.settle()


def drag(window: Harness, rng: np.random.Generator) -> None:
    """Drag a handle to and fro at some frame, and let it go."""
    session, project = window.session, window.session.project
    playback.seek(session, int(rng.integers(0, project.document.frames.last)))
    window.frames()
    handles = project.layer.handles
    handle, gesture = handles[rng.integers(len(handles))], object()
    way = complex(*(8 * rng.normal(size=2)))
    for step in range(round(DRAG * RATE)):
        place = handle.position + way * np.sin(step / 9)
        drag_handles(session, {handle.id: Target(position=place)}, gesture=gesture)
        window.frames()
    release_drag(session)
    window.settle()


def play(window: Harness) -> float:
    """Play; return the processor's seconds for a frame."""
    frames = round(PLAY * RATE)
    playback.toggle_play(window.session)
    begun = time.process_time()
    window.frames(frames)
    seconds = (time.process_time() - begun) / frames
    playback.stop_playback(window.session)
    return seconds


def export(window: Harness, folder: Path, name: str) -> None:
    """Export some frames, and remove them."""
    session, place = window.session, folder / "exported"
    place.mkdir()
    settings = ExportSettings(
        format=name,
        size=(64, 48),
        background="#ff8000",
        frames=FrameRange(0, 5),
        shapes=MeshOptions(triangles=200),
    )
    editing.edit_document(session, scene_commands.set_export(settings))
    suffixes = EXPORT_FORMATS[name].suffixes
    exporting.start_export(session, place / f"a{suffixes[0]}" if suffixes else place)
    while session.export.run is not None or session.jobs.kinds:
        session.jobs.wait_until_idle()
        window.frames()
    assert list(place.iterdir()), f"{name} exports nothing"
    shutil.rmtree(place)


def fitted_slope(x: np.ndarray, y: np.ndarray) -> tuple[float, float]:
    """Return the slope of a line through points, and twice its standard error."""
    (slope, _), covariance = np.polyfit(x, y, 1, cov=True)
    return float(slope), float(2 * np.sqrt(covariance[0, 0]))
