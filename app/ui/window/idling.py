"""The pace of the window's frames: full while anything changes, slow at rest."""

from imgui_bundle import hello_imgui

from app.editor import FileDialog, Session
from app.editor.actions.updates import stage_jobs

# Input and running jobs wake the window at once.
IDLE_FPS = 0.2
AWAKE = 0.5  # seconds of full frame rate after that, for its consequences
LOOK = 2.0  # seconds between two looks at the times of drawings' files
REPEATS = 2  # frames after which further frames would show nothing new


class FramePace:
    """Keeps the window awake while anything changes. Finds frames that can wait."""

    def __init__(self) -> None:
        self._next_look = 0.0
        self._awake_until = 0.0
        self._idle_frames = 0

    @property
    def awaits_worker(self) -> bool:
        """Whether further frames would repeat the shown one and slow down the worker."""
        return self._idle_frames >= REPEATS

    def begin_frame(self, session: Session) -> bool:
        """Return whether it is time to look for changed files of drawings."""
        now = session.clock()
        if _is_busy(session):
            self._awake_until = now + AWAKE
        if now < self._awake_until:
            hello_imgui.request_refresh()
        is_due = now >= self._next_look
        if is_due:
            self._next_look = now + LOOK
        return is_due

    def end_frame(self, session: Session) -> None:
        self._idle_frames = self._idle_frames + 1 if _awaits_in_between(session) else 0


def _is_busy(session: Session) -> bool:
    """Return whether something changes without input."""
    project = session.project
    is_moving = project is not None and project.timeline.playhead.since is not None
    # The system's dialog has its own input. Its answer is polled.
    asks_system = session.dialogs.uses_system and isinstance(session.dialogs.current, FileDialog)
    is_working = bool(session.jobs.kinds) or session.export.run is not None
    if project is not None:
        is_working |= bool(project.layer_setup.stale or project.pending.deferred)
    return is_moving or is_working or asks_system or bool(session.notices.toasts)


def _awaits_in_between(session: Session) -> bool:
    """Return whether a placeholder stands for an in-between, and nothing else is active."""
    project = session.project
    if project is None or project.timeline.playhead.since is not None:
        return False
    if session.tools.active_tool or session.export.run:
        return False
    if session.notices.toasts or session.dialogs.current:
        return False
    if {stage_jobs.GLIMPSING, stage_jobs.SKETCHING}.isdisjoint(session.jobs.kinds):
        return False
    shows = [runtime.shown for runtime in project.runtimes.layers.values()]
    return any(shown is not None and not shown.is_current for shown in shows)
