"""Memory that is free, given back to the system.

The GNU C library keeps what threads have freed, each thread's apart and in pieces: without this,
each large drawing that is opened after another, and each export, takes more memory.
"""

import ctypes
import sys

from app.editor import Project, Session

REST = 1.0  # seconds
ARENA_MAX = -8  # the C library's number for it


class FreeMemory:
    """What a closed project and finished work have left free, given back to the system."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._due: float | None = None  # none before there is work

    def maintain(self, *, has_closed: bool) -> None:
        """Give it back when a project `has_closed` or nothing went on for a while; once a frame.

        It takes some 10 ms after an export or a drag, which nobody sees in a picture that rests.
        """
        session = self._session
        project = session.project
        is_playing = project is not None and project.playhead.since is not None
        if has_closed:
            give_back()
        if session.jobs.kinds or session.export is not None or is_playing:
            self._due = session.clock() + REST
        elif self._due is not None and session.clock() >= self._due:
            self._due = None
            if project is not None:
                _rest(project)
            give_back()


def _rest(project: Project) -> None:
    """Let go of what in-betweens are made with, of figures that nobody edits: it is soon there."""
    for identity, puppet in project.puppets.items():
        for store in (puppet.store, puppet.fine) if identity != project.active else ():
            if store is not None:
                store.rest()


def share_heap() -> None:
    """Let all threads take memory from one heap; call it before there are others.

    Of a thread's own heap, the C library gives back only what is free between two pieces in use,
    and not what is above them, which may be 64 MB for each.
    """
    _call("mallopt", ARENA_MAX, 1)


def give_back() -> None:
    """Give all memory that is free back to the system."""
    _call("malloc_trim", 0)


def _call(name: str, *arguments: int) -> None:
    """Call a function of the C library, where it has one of this name."""
    if sys.platform == "linux":
        function = getattr(ctypes.CDLL(None), name, None)
        if function is not None:
            function(*arguments)
