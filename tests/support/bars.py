"""A bar in the window: what most tests of the interface begin with."""

from dataclasses import replace
from typing import Literal

import numpy as np
from harness import Harness
from interpolation_shapes import around, subdivided

from app.document import History, channel_commands, clip_of, pose_channel
from app.document.commands import scene_commands, shape_commands
from app.document.keyframe import Target
from app.document.layer import new_layer
from app.document.model import Document
from app.document.settings import FrameRange
from app.editor.actions import playback
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import drag_handles, release_drag, set_targets
from app.editor.project import Project
from app.editor.work.layer_runtime import LayerRuntime
from app.storage.assets import sample_images
from engine.domain.build import MeshedDomain
from engine.domain.meshing.triangulation import triangulate

BENT = 24  # the frame of the key in which it is bent
LAST, HALF = 8, 4  # frames: of that key in few frames, and half way to it
WAY = 60 - 90j  # pixels of the picture that it is dragged
LONGEST, OFFSET = 130.0, 12.0  # pixels: of the edges of its outline, and to its cage
NEAR = 3  # pixels, which the solver may leave


def open_bar(window: Harness, *shares: float) -> Project:
    """Open the sample of a bar, and put handles at shares of its length; the last one is selected.

    By default there is one near each end.
    """
    project = window.open(sample_images() / "bar.png")
    take_few_corners(project)
    window.settle()
    width, height = project.document.canvas
    for share in shares or (0.1, 0.9):
        add_handle(window.session, complex(share * width, height / 2))
        window.frames(2)
    window.settle()
    return project


def take_few_corners(project: Project) -> None:
    """Put a bar that was just opened within a cage of 20 corners, where it got 46.

    Poses and frames of it are solved several times as fast.
    """
    layer, history = project.layer, project.history
    x, y = layer.domain.outline.real, layer.domain.outline.imag
    low, high = x.min() + 1j * y.min(), x.max() + 1j * y.max()
    corners = np.array([low, high.real + 1j * low.imag, high, low.real + 1j * high.imag])
    outline = subdivided(corners, LONGEST)
    mesh = triangulate(outline, layer.meshing.triangles)
    domain = MeshedDomain(outline=outline, cage=around(outline, OFFSET), mesh=mesh)
    layer = replace(new_layer(layer.picture, domain, layer.meshing), id=layer.id, name=layer.name)
    document = project.document.with_layer(layer)
    project.history = History(document, saved=history.is_saved)
    picture = project.layer_runtime.picture
    project.runtimes.layers[layer.id] = LayerRuntime.of(clip_of(document, layer.id), picture)


def bend_bar(
    window: Harness, last: int | None = None, held: Literal["auto-pins", "loose"] = "auto-pins"
) -> Project:
    """Bend that bar at its right end: keys at frames 0 and 24, the second one is shown.

    Parameters
    ----------
    last : int, optional
        The frame of the second key, after which there is none.
    held : {"auto-pins", "loose"}
        Handles stay between the keys where both have them at one place, which is solved for each
        frame; or none does.
    """
    if last is not None:
        bar = window.again(bend_bar, None, held)
        if last != BENT:
            bar.history.do(
                channel_commands.move_keys(
                    {pose_channel(bar.selection.active): {BENT}}, last - BENT
                )
            )
        bar.history.do(scene_commands.set_frames(FrameRange(0, last)))
        playback.seek(window.session, last)
    elif held == "loose":
        bar = window.again(bend_bar, None, "auto-pins")
        bar.history.extend_step(shape_commands.set_auto_pins(bar.selection.active, enabled=False))
    else:
        bar = window.again(open_bar)
        playback.seek(window.session, BENT)
        window.settle()
        width, height = bar.layer_runtime.picture.size
        set_targets(window.session, {1: Target(position=complex(0.85 * width, 0.9 * height))})
    window.settle()
    return bar


def drag_bar(window: Harness, bar: Project) -> complex:
    """Drag a handle of the bent bar, let it go at once, and return where it was wished last."""
    playback.scrub(window.session, BENT)
    window.frames(2)
    shown, gesture = bar.layer_runtime.shown, object()
    assert shown is not None
    place = complex(shown.handle_positions[1])
    for share in (0.25, 0.5, 0.75, 1.0):
        window.frames()
        wish = {1: Target(position=place + share * WAY)}
        drag_handles(window.session, wish, gesture=gesture)
    release_drag(window.session)
    return place + WAY


def check_at_rest(document: Document, goal: complex, *, layer: int = 0, frame: int = BENT) -> None:
    """Fail unless a key has the pose in which the wish of that drag has come to rest."""
    dragged = document.layer(layer)
    pose, place = dragged.key(frame).pose, dragged.handle(1).position
    wished = pose.targets[1].position
    assert abs(wished - goal) < 1e-9, f"{wished} was wished, {goal} by the hand"
    end = complex(dragged.map_of(pose)(np.array([place]))[0])
    assert abs(end - goal) < NEAR, f"it is at {end}, {goal} was wished"
