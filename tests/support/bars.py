"""A bar in the window: what most tests of the interface begin with."""

from harness import Harness

from app.document.keyframe import Target
from app.editor.actions import playback, posing
from app.editor.project import Project
from app.storage.assets import sample_images


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
    playback.seek(window.session, 24)
    window.settle()
    width, height = bar.puppet.picture.size
    posing.wish(window.session, {1: Target(position=complex(0.85 * width, 0.9 * height))})
    window.settle()
    return bar
