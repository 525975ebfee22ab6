"""Cancellation of files that another thread writes."""

import threading
from contextlib import suppress
from pathlib import Path

from app.errors import CANCELLED, LissomError
from app.texts import _


class Cancellation:
    """Whether writing is cancelled: one decision for all files of one operation.

    A file can be cancelled until it takes its place, and then leaves no trace.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._parts: set[Path] = set()
        self._is_cancelled = False
        self._is_committed = False

    def cancel(self) -> bool:
        """Forbid further files to take their places; return whether none has done so yet.

        Half-written files are removed at once, so that nobody waits for their writer.
        """
        with self._lock:
            self._is_cancelled = True
            for part in self._parts:
                with suppress(OSError):  # Windows cannot remove an open file; its writer does
                    part.unlink(missing_ok=True)
            return not self._is_committed

    def add_part(self, part: Path) -> None:
        """Register the hidden file into which a file is written.

        Raises `LissomError` if the operation is cancelled. The writer then removes the hidden file.
        """
        with self._lock:
            self.check()
            self._parts.add(part)

    def check(self) -> None:
        """Raise `LissomError` if the operation is cancelled."""
        if self._is_cancelled:
            raise LissomError(_(CANCELLED))

    def commit(self) -> None:
        """Let the begun files take their places. Later cancellation has no effect.

        Raises `LissomError` if the operation is cancelled.
        """
        with self._lock:
            if self._parts:
                self.check()
            self._parts.clear()
            self._is_committed = True
