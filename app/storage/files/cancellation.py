"""Files that are being written may be cancelled, by another thread than the one that writes."""

import threading
from contextlib import suppress
from pathlib import Path

from app.errors import CANCELLED, LissomError


class Cancellation:
    """Says whether files that are being written are still wanted: one decision for all of them.

    Until a file takes its place it can be cancelled, and nothing of it stays; later it cannot.
    """

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._parts: set[Path] = set()
        self._is_cancelled = False
        self._is_committed = False

    def cancel(self) -> bool:
        """Let no more files take their places; return whether none has done so yet.

        What is half written is removed at once, so that nobody need wait for whoever writes it.
        """
        with self._lock:
            self._is_cancelled = True
            for part in self._parts:
                with suppress(OSError):  # Windows leaves it to whoever has it open
                    part.unlink(missing_ok=True)
            return not self._is_committed

    def add_part(self, part: Path) -> None:
        """Note the hidden file in which a file is written until it is whole.

        Raises
        ------
        LissomError
            If it was cancelled; the hidden file is its writer's to remove.
        """
        with self._lock:
            self.check()
            self._parts.add(part)

    def check(self) -> None:
        """Go on only if nothing was cancelled.

        Raises
        ------
        LissomError
            If something was.
        """
        if self._is_cancelled:
            raise LissomError(CANCELLED)

    def commit(self) -> None:
        """Let the files that were begun take their places, whatever comes.

        Raises
        ------
        LissomError
            If they were cancelled.
        """
        with self._lock:
            if self._parts:
                self.check()
            self._parts.clear()
            self._is_committed = True
