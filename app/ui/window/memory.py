"""Memory that is free, given back to the system.

The GNU C library keeps what threads have freed, each thread's apart and in pieces: without this,
each large drawing that is opened after another, and each export, takes more memory.
"""

import ctypes
import sys

from app.editor import Session

REST = 1.0  # seconds
WORK = 4.0  # seconds from one time to the next, while workers go on unwatched
ARENA_MAX = -8  # the C library's number for it


class FreeMemory:
    """What a closed project and finished work have left free, given back to the system."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._due: float | None = None  # none before there is work
        self._given = 0.0

    def update(self, *, has_closed: bool) -> None:
        """Give it back when a project `has_closed` or nothing went on for a while; once a frame.

        It takes some 10 ms after an export or a drag, which nobody sees in a picture that rests;
        now and then, too, while much is prepared.
        """
        session, project, now = self._session, self._session.project, self._session.clock()
        is_playing = project is not None and project.playhead.since is not None
        if has_closed:
            self._give(now)
        if session.jobs.kinds or session.export is not None or is_playing:
            self._due = now + REST
            is_watched = is_playing or (project is not None and project.is_posing)
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
    """Let all threads take memory from one heap; call it before there are others.

    Of a thread's own heap, the C library gives back only what is free between two pieces in use,
    and not what is above them, which may be 64 MB for each.
    """
    _call("mallopt", ARENA_MAX, 1)


def trim_heap() -> None:
    """Give all memory that is free back to the system."""
    _call("malloc_trim", 0)


def _call(name: str, *arguments: int) -> None:
    """Call a function of the C library, where it has one of this name."""
    if sys.platform == "linux":
        function = getattr(ctypes.CDLL(None), name, None)
        if function is not None:
            function(*arguments)
