"""The bent bar in few frames, for tests that look at in-betweens: less of them is worked out."""

from bars import BENT, bend_bar, bend_loosely
from harness import Harness

from app.document.commands import key_commands, scene_commands
from app.document.settings import FrameRange
from app.editor.actions import playback
from app.editor.project import Project

LAST, HALF = 8, 4  # frames: of the second key, which is the last one, and half way to it


def bend_until(window: Harness, last: int, *, loosely: bool = False) -> Project:
    """Bend the bar by a key at a frame, which is shown, with no frame after it."""
    bent = window.again(bend_loosely if loosely else bend_bar)
    if last != BENT:
        bent.history.do(key_commands.move_keys(bent.active, {BENT}, last - BENT))
    bent.history.do(scene_commands.set_frames(FrameRange(0, last)))
    playback.seek(window.session, last)
    window.settle()
    return bent


def bend_briefly(window: Harness) -> Project:
    """Bend the bar within few frames."""
    return bend_until(window, LAST)


def bend_loosely_and_briefly(window: Harness) -> Project:
    """Bend the bar so, none of whose handles stays in between: that is solved for each frame."""
    return bend_until(window, LAST, loosely=True)
