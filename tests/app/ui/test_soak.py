"""Minutes of `python -m tests.campaigns --only soak`, by the window's clock: all is given back."""

import gc
import weakref

import harness
import numpy as np
import pytest
from held import held, in_use

from app.document import shape_commands
from app.document.commands.layers import layer_commands
from app.editor.actions import editing, playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import nudge_handles
from app.editor.actions.project_files import saving
from app.storage.assets import sample_images
from app.ui.window import memory
from tests.campaigns import soak

RATE = 3  # frames a second by the window's clock, so that minutes cost little
USUAL = (1280, 800)


@pytest.fixture
def slow_window(window, monkeypatch):
    monkeypatch.setattr(harness, "FRAME", 1 / RATE)
    monkeypatch.setattr(soak, "RATE", RATE)
    window.resize(soak.SIZE)
    yield window
    window.resize(USUAL)


@pytest.mark.parametrize("ways", [1, pytest.param(soak.WAYS, marks=pytest.mark.long)])
def test_what_is_used_for_minutes_on_end_is_given_back(slow_window, bar, tmp_path, ways):
    editing.edit_layer(slow_window.session, shape_commands.set_variant, "nu")
    slow_window.settle()

    def use_in_every_way():
        # At the same frames each time, around which there are as many ghosts.
        rng = np.random.default_rng(0)
        for way in range(ways):
            soak.use(slow_window, rng, tmp_path, way, drags=1)
        return held(slow_window.gl)

    first, begun, document = use_in_every_way(), slow_window.clock.now, bar.document
    last = use_in_every_way()
    assert slow_window.clock.now - begun > 15 * ways  # seconds
    assert bar.document is document
    # A texture may wait for the next frame, and a cache may be full a little later.
    assert last.files <= first.files
    assert last.threads <= first.threads
    assert last.opengl <= first.opengl + 2
    assert last.cached <= first.cached + 2


@pytest.mark.usefixtures("painted")
def test_a_project_that_was_closed_is_let_go(slow_window, tmp_path):
    project = slow_window.open(sample_images() / "bar.png")
    soak.export(slow_window, tmp_path, "png")
    history = weakref.ref(project.history)
    del project
    opengl = held(slow_window.gl).opengl
    saving.set_project(slow_window.session, None)
    slow_window.frames(2)
    assert history() is None
    assert held(slow_window.gl).opengl < opengl


def test_the_mesh_of_a_project_that_was_closed_is_let_go(window):
    """Also where something of it is in front, and the anchor and the status bar were shown."""
    project = window.open(sample_images() / "bar.png")
    window.act(add_handle, project.layer.domain.mesh.vertices.mean())
    window.act(
        editing.edit_document, layer_commands.set_depth(project.selection.active, 0, 1.0, None)
    )
    window.settle()
    shown = project.layer_runtime.shown
    mesh = shown.mesh.domain.mesh
    assert shown.vertices.triangles is not mesh.triangles
    vertices = weakref.ref(mesh.vertices)
    del project, shown, mesh
    saving.set_project(window.session, None)
    window.frames(2)
    gc.collect()
    assert vertices() is None


def test_messages_that_are_gone_leave_nothing(window):
    def tell_some():
        for number in range(20):
            window.session.notices.show(f"message {number}")
            window.frames(2)
            window.session.notices.toasts = []
            window.frames(1)
        return in_use()

    first = tell_some()
    # A window of ImGui's takes 7 KB.
    assert tell_some() - first < 0.05


def test_what_is_free_is_given_back_once_after_work_has_come_to_rest(slow_window, bar, monkeypatch):
    window, given = slow_window, []
    monkeypatch.setattr(memory, "trim_heap", lambda: given.append(window.clock.now))
    second = round(1 / harness.FRAME)

    def rest():
        del given[:]
        window.frames(2 * second)
        return len(given)

    before = bar.document
    window.act(nudge_handles, 20j)
    window.settle()
    assert bar.document is not before
    # The last work may have ended some frames ago.
    ended = window.clock.now
    window.frames(2 * second)
    assert len(given) == 1
    assert given[0] - ended <= memory.REST
    assert rest() == 0
    playback.toggle_play(window.session)
    assert rest() == 0
    playback.stop_playback(window.session)
    assert rest() == 1
    saving.set_project(window.session, None)
    window.frames()
    assert given
