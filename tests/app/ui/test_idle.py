"""A window in which nothing changes does next to nothing, however many layers there are."""

import gc
import sys
from dataclasses import dataclass, field, replace
from pathlib import Path

import pytest
from projects import project_of
from scenes import PICTURE, drawn

from app.document import (
    OPACITY,
    TINT,
    Channel,
    channel_commands,
    key_commands,
    layer_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.project_files import saving
from app.editor.parts.tools import ToolState
from app.editor.work.jobs import Jobs
from app.editor.work.revised import Revised, revision_getter
from app.ui.viewport.canvas import Canvas
from app.ui.window import memory
from app.ui.window.window_frame import WindowFrame

OWN = str(Path(__file__).parents[3] / "app")
MOST_CALLS = 64  # fewer than one a layer of 72
# Panels, and the picture of the drawing.
DRAWING = {each.__code__ for each in (WindowFrame._draw_panel, WindowFrame._ask, Canvas.draw)}

# Changes of a layer's look that leave its motion alone.
LOOKS = {
    "name": lambda layer: layer_commands.rename_layer(layer, "arm"),
    "lock": lambda layer: layer_commands.set_locked(layer, locked=True),
    "opacity": lambda layer: channel_commands.set_key(Channel(OPACITY, layer), 3, 0.5),
    "tint": lambda layer: channel_commands.set_key(Channel(TINT, layer), 3, (1.0, 0.5, 0.0)),
}


def show_layers(window, count):
    """Show a scene of some layers, and wait until nothing is left to do."""
    document = drawn()
    layers = (replace(document.layers[0], id=each, name=f"layer {each}") for each in range(count))
    project = project_of(replace(document, layers=tuple(layers)), PICTURE, "idle")
    saving.set_project(window.session, project)
    # The tab Export, which another test may have left in front, marks the frame of an export.
    window.show_tab("Handle")
    window.settle()
    playback.stop_playback(window.session)
    window.clock.now += 2 * memory.REST  # the memory of what was done is returned by then
    window.frames(30)


def count_calls(window, frames=1):
    """Return the calls of the program's functions in a frame outside of its panels, on average."""
    calls, inside = 0, 0

    def note(frame, event, _):
        nonlocal calls, inside
        code = frame.f_code
        if code in DRAWING and event in {"call", "return"}:
            inside += 1 if event == "call" else -1
        elif event == "call" and not inside and code.co_filename.startswith(OWN):
            calls += 1

    gc.disable()  # or what other tests left would be closed here, by calls of the program
    sys.setprofile(note)
    try:
        window.frames(frames)
    finally:
        sys.setprofile(None)
        gc.enable()
    return calls / frames


@pytest.mark.parametrize("layers", [1, 72])
def test_idle_window_makes_few_calls(window, layers):
    show_layers(window, layers)
    assert count_calls(window, frames=5) <= MOST_CALLS


def test_hint_is_set_once_while_the_pointer_rests_on_the_timeline(window, monkeypatch):
    show_layers(window, 1)
    shown, show = [], ToolState.show_hint
    monkeypatch.setattr(
        ToolState, "show_hint", lambda own, *given: (shown.append(given), show(own, *given))
    )

    def rest(robot):
        robot.mouse_move("//Timeline/**/key 0")
        shown.clear()
        robot.yield_(10)

    window.run(rest)
    assert len(shown) <= 2


def test_window_is_idle_again_after_a_change(window):
    show_layers(window, 3)
    editing.edit_document(window.session, layer_commands.rename_layer(1, "arm"))
    assert count_calls(window) > MOST_CALLS
    window.settle()
    window.frames(30)
    assert count_calls(window, frames=5) <= MOST_CALLS


def test_window_shows_the_frame_of_a_playhead_that_was_moved(window):
    show_layers(window, 2)
    last = window.session.project.document.frames.last
    playback.scrub(window.session, last)
    window.frames(2)
    assert {each.shown.frame for each in window.session.project.runtimes.layers.values()} == {last}


@pytest.mark.usefixtures("everything")
@pytest.mark.parametrize("look", LOOKS)
def test_changed_look_of_a_layer_starts_no_job_of_its_motion(window, bent, monkeypatch, look):
    window.settle()
    jobs, add = [], Jobs.add
    monkeypatch.setattr(Jobs, "add", lambda queue, job: (jobs.append(job.kind), add(queue, job)))
    window.act(editing.edit_document, LOOKS[look](bent.selection.active))
    window.settle()
    assert jobs == []
    # The queue is watched: a key of a pose starts jobs.
    layer = bent.layer
    window.act(editing.edit_document, key_commands.insert_key(layer.id, 30, layer.keys[0].pose))
    window.settle()
    assert jobs


@dataclass(slots=True, kw_only=True, eq=False)
class Part(Revised):
    points: list = field(default_factory=list)
    size: int = 0


@dataclass(slots=True, kw_only=True, eq=False)
class Whole(Revised):
    part: Part = field(default_factory=Part)


def test_revision_counts_changes_of_values_only():
    part = Part(size=2)
    before = part.revision
    part.size, part.points = 3, [1]
    assert part.revision == before + 2
    part.size, part.points = 3, part.points
    assert part.revision == before + 2
    part.size = 4
    part.points = [1]
    assert part.revision == before + 4


def test_revisions_of_a_whole_count_changes_of_its_parts():
    whole, revisions = Whole(), revision_getter(Whole)
    before = revisions(whole)
    assert revisions(whole) == before
    whole.part.size = 1
    assert revisions(whole) != before
