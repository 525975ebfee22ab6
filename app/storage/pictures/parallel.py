"""Work on several pictures at once, on the cores and within the memory of the machine."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from app.errors import LissomError
from app.storage.preferences import load_preferences, settings_folder

In = TypeVar("In")
Out = TypeVar("Out")

# Each picture under work takes some memory of its own.
MOST_WORKERS = 4
# Bytes of larger ones: such are worked on one at a time.
LARGE = 64_000_000
PIXEL = 4  # bytes
# Of the machine's memory, for pictures, where the person has chosen nothing; where the system does
# not tell, the machine is taken to have so many bytes.
SHARE, USUAL = 0.25, 8_000_000_000
MEMORY_OF_PICTURES = (
    "decoded it takes {needed:,.0f} MB of memory, and pictures may take {budget:,.0f} MB; scale it "
    'down, or change "memory" in {preferences}'
)


def require_memory(sizes: Iterable[tuple[int, int]]) -> None:
    """Refuse pictures of these widths and heights if decoded they would take too much memory."""
    needed, budget = sum(PIXEL * width * height for width, height in sizes), memory_budget()
    if needed > budget:
        raise LissomError(
            MEMORY_OF_PICTURES.format(
                needed=needed / 1e6,
                budget=budget / 1e6,
                preferences=settings_folder() / "preferences.json",
            )
        )


def memory_budget() -> int:
    """Return how many bytes the pictures of a file may take."""
    chosen = load_preferences(settings_folder()).memory
    if chosen is not None:
        return chosen * 1_000_000
    try:
        return int(SHARE * os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, OSError, ValueError):
        return int(SHARE * USUAL)


def run_parallel(
    work: Callable[[In], Out], items: Iterable[In], sizes: Iterable[tuple[int, int]]
) -> list[Out]:
    """Return what a function makes of items, in their order; of its errors the first is raised.

    Decoders and most of NumPy let other threads go on, so that these are as many as there are
    cores, unless a picture of these widths and heights is large.
    """
    is_large = any(PIXEL * width * height > LARGE for width, height in sizes)
    with ThreadPoolExecutor(1 if is_large else min(MOST_WORKERS, os.cpu_count() or 1)) as pool:
        return list(pool.map(work, items))
