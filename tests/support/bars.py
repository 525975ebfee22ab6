"""A bar in the window: what most tests of the interface begin with."""

import numpy as np
from harness import Harness

from app.document.commands import figure_commands
from app.document.keyframe import Target
from app.document.model import Document
from app.editor.actions import playback, posing
from app.editor.project import Project
from app.storage.assets import sample_images

BENT = 24  # the frame of the key in which it is bent
WAY = 60 - 90j  # pixels of the picture that it is dragged
NEAR = 3  # pixels, which the solver may leave


def open_bar(window: Harness) -> Project:
    """Open the sample of a bar, and put a handle near each end; the second one is selected."""
    project = window.open(sample_images() / "bar.png")
    width, height = project.document.canvas
    for share in (0.1, 0.9):
        posing.add_handle(window.session, complex(share * width, height / 2))
        window.frames(2)
    window.settle()
    return project


def bend_bar(window: Harness) -> Project:
    """Bend that bar at its right end: keys at frames 0 and 24, the second one is shown."""
    bar = open_bar(window)
    playback.seek(window.session, BENT)
    window.settle()
    width, height = bar.puppet.picture.size
    posing.wish(window.session, {1: Target(position=complex(0.85 * width, 0.9 * height))})
    window.settle()
    return bar


def bend_loosely(window: Harness) -> Project:
    """Bend the bar so, none of whose handles stays in between: that is solved for each frame."""
    bar = bend_bar(window)
    bar.history.extend_step(figure_commands.set_stillness(bar.active, stillness=False))
    window.settle()
    return bar


def drag_bar(window: Harness, bar: Project) -> complex:
    """Drag a handle of the bent bar, let it go at once, and return where it was wished last."""
    playback.scrub(window.session, BENT)
    window.frames(2)
    shown, gesture = bar.puppet.shown, object()
    assert shown is not None
    place = complex(shown.handle_places[1])
    for share in (0.25, 0.5, 0.75, 1.0):
        window.frames()
        wish = {1: Target(position=place + share * WAY)}
        posing.pull(window.session, wish, gesture=gesture)
    posing.let_go(window.session)
    return place + WAY


def check_at_rest(document: Document, goal: complex, *, figure: int = 0, frame: int = BENT) -> None:
    """Fail unless a key has the pose in which the wish of that drag has come to rest."""
    dragged = document.figure(figure)
    pose, place = dragged.key(frame).pose, dragged.handle(1).position
    wished = pose.targets[1].position
    assert abs(wished - goal) < 1e-9, f"{wished} was wished, {goal} by the hand"
    end = complex(dragged.map_of(pose)(np.array([place]))[0])
    assert abs(end - goal) < NEAR, f"it is at {end}, {goal} was wished"
