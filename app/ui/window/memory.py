"""Returns free memory to the system.

The GNU C library keeps freed memory of each thread, in pieces. Without this module, each large
drawing that is opened and each export would take more memory.
"""

import ctypes
import sys

from app.editor import Session

REST = 1.0  # seconds
WORK = 4.0  # seconds from one time to the next, while workers run and the person does nothing
ARENA_MAX = -8  # number of the option in the C library


class FreeMemory:
    """Returns memory to the system after a project was closed or work has finished."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._due: float | None = None  # None before the first work
        self._given = 0.0

    def update(self, *, has_closed: bool) -> None:
        """Return memory when a project `has_closed` or after a pause; once a frame.

        The call takes some 10 ms after an export or a drag, invisible while the picture rests.
        During long preparation it also runs from time to time.
        """
        session, project, now = self._session, self._session.project, self._session.clock()
        is_playing = project is not None and project.timeline.playhead.since is not None
        if has_closed:
            self._give(now)
        if session.jobs.kinds or session.export.run is not None or is_playing:
            self._due = now + REST
            is_watched = is_playing or (project is not None and project.drag is not None)
            if now >= self._given + WORK and not is_watched:
                self._give(now)
        elif self._due is not None and now >= self._due:
            self._due = None
            if project is not None:
                project.free_memory()
            self._give(now)

    def _give(self, now: float) -> None:
        self._given = now
        trim_heap()


def limit_arenas() -> None:
    """Make all threads share one heap. Call this before other threads start.

    Of a thread's own heap, the C library returns only free memory between two used pieces. The
    memory above them stays, up to 64 MB a thread.
    """
    _call("mallopt", ARENA_MAX, 1)


def trim_heap() -> None:
    _call("malloc_trim", 0)


def _call(name: str, *arguments: int) -> None:
    """Call a function of the C library, if it exists."""
    if sys.platform == "linux":
        function = getattr(ctypes.CDLL(None), name, None)
        if function is not None:
            function(*arguments)
