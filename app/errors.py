"""What is told to the person: errors, names of files, and how far long work is.

Errors are messages and no tracebacks. Between what computes for long and whoever waits for it are
many rooms that have nothing to add: so who listens is said once, for a block on the same thread.
"""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass

from engine.errors import EngineError

Listener = Callable[[float], None]
_listener: ContextVar[Listener | None] = ContextVar("listener", default=None)
# What Python makes of the bytes of a file's name that are no UTF-8, on Linux.
_UNREADABLE = re.compile("[\ud800-\udfff]")


class LissomError(Exception):
    """A request that cannot be met; the message tells the person what was wrong and what to do."""


# What a command line, a job or a panel reports as a plain message.
EXPECTED_ERRORS = (LissomError, EngineError)


@dataclass(frozen=True, slots=True)
class ImportSummary:
    """What opening a drawing told, a line each, with the names of the layers that it is about."""

    losses: tuple[str, ...] = ()  # what does not look as it does elsewhere
    matters: tuple[str, ...] = ()  # what was done, and looks the same

    def __bool__(self) -> bool:
        """Tell whether there is anything to be told."""
        return bool(self.losses or self.matters)

    @property
    def lines(self) -> tuple[str, ...]:
        """All of it, losses first."""
        return self.losses + self.matters

    def __add__(self, other: "ImportSummary") -> "ImportSummary":
        """Return both."""
        return ImportSummary(self.losses + other.losses, self.matters + other.matters)


NOTHING_TOLD = ImportSummary()


class Told:
    """What is found while a drawing is read: told once, with the names of all that it is about."""

    def __init__(self) -> None:
        self._losses: dict[str, list[str]] = {}
        self._matters: dict[str, list[str]] = {}

    def lose(self, name: str, what: str) -> None:
        """Tell what of something is not shown as it is elsewhere."""
        self._losses.setdefault(what, []).append(name)

    def note(self, name: str, what: str) -> None:
        """Tell what was done to something, which looks the same."""
        self._matters.setdefault(what, []).append(name)

    @property
    def summary(self) -> ImportSummary:
        """All that was told."""
        losses, matters = (
            tuple(f"{', '.join(names)}: {what}" for what, names in found.items())
            for found in (self._losses, self._matters)
        )
        return ImportSummary(losses, matters)


def shown_name(name: object) -> str:
    """Return a file's name, or a text with names in it, with a � for each byte that is no UTF-8.

    Neither a window nor a file of text takes such a name as it is.
    """
    return _UNREADABLE.sub("\N{REPLACEMENT CHARACTER}", str(name))


@contextmanager
def told_to(listener: Listener) -> Iterator[None]:
    """Let somebody listen to what this thread does in a `with` block.

    Parameters
    ----------
    listener : callable
        Takes the share that is done, from 0 to 1; what it raises ends the work.
    """
    before = _listener.set(listener)
    try:
        yield
    finally:
        _listener.reset(before)


def tell(share: float) -> None:
    """Tell how far the work is, if somebody listens."""
    listener = _listener.get()
    if listener is not None:
        listener(share)
