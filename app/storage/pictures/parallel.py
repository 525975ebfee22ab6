"""Parallel work on several pictures, within the cores and the memory of the machine."""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

from app.errors import LissomError
from app.folders import preferences_file, settings_folder
from app.storage.preferences import load_preferences
from app.texts import N_, _

In = TypeVar("In")
Out = TypeVar("Out")

# Each picture in work takes further memory.
MOST_WORKERS = 4
# Bytes of a large picture; large pictures are processed one at a time.
LARGE = 64_000_000
PIXEL = 4  # bytes
# Default share of the machine's memory for pictures. A machine of unknown memory counts as having
# `USUAL` bytes.
SHARE, USUAL = 0.25, 8_000_000_000
MEMORY_OF_PICTURES = N_(
    "decoded, the picture needs {needed:,.0f} MB of memory, and pictures may use {budget:,.0f} "
    'MB. Scale it down, or raise "memory" in {preferences}'
)


def require_memory(sizes: Iterable[tuple[int, int]]) -> None:
    """Refuse pictures of these widths and heights if decoding them takes too much memory."""
    needed, budget = sum(PIXEL * width * height for width, height in sizes), memory_budget()
    if needed > budget:
        raise LissomError(
            _(MEMORY_OF_PICTURES).format(
                needed=needed / 1e6,
                budget=budget / 1e6,
                preferences=preferences_file(),
            )
        )


def memory_budget() -> int:
    """Return the bytes that the pictures of a file may take."""
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
    """Return the results of a function for all items, in order; the first error is raised.

    Decoders and most of NumPy release the interpreter lock. There are as many threads as cores,
    unless a picture of these widths and heights is large.
    """
    is_large = any(PIXEL * width * height > LARGE for width, height in sizes)
    with ThreadPoolExecutor(1 if is_large else min(MOST_WORKERS, os.cpu_count() or 1)) as pool:
        return list(pool.map(work, items))
