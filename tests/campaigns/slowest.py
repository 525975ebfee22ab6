"""Which input of a campaign took longest."""

import time
from collections.abc import Iterable, Iterator
from typing import TypeVar

T = TypeVar("T")
_noted: list[tuple[float, str]] = []


def timed(inputs: Iterable[T]) -> Iterator[T]:
    """Yield inputs, and note how long each is worked on."""
    for each in inputs:
        begun = time.perf_counter()
        yield each
        note(str(getattr(each, "name", each)), time.perf_counter() - begun)


def note(name: str, seconds: float) -> None:
    """Note how long an input took."""
    _noted[:] = [max([*_noted, (seconds, name)])]


def told_slowest() -> dict[str, float]:
    """Return the slowest input since this was asked last, by its name; nothing if there is none."""
    return {f"slowest ({name}), s": seconds for seconds, name in (_noted.pop(),)} if _noted else {}
