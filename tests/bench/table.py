"""How a measurement is taken and shown."""

import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One measured thing: its name, seconds (None for a plain fact), and a remark."""

    name: str
    seconds: float | None
    note: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Rows measured side by side in one run; the ratios are to the first row with a time."""

    title: str
    rows: tuple[Row, ...]

    def __str__(self) -> str:
        """Lay the table out for a terminal."""
        times = [row.seconds for row in self.rows if row.seconds is not None]
        width = max(len(row.name) for row in self.rows)
        lines = [self.title]
        for row in self.rows:
            if row.seconds is None:
                figures = " " * 21
            else:
                figures = f"{1e3 * row.seconds:10.3f} ms {row.seconds / times[0]:7.2f}x"
            lines.append(f"  {row.name:<{width}} {figures}  {row.note}".rstrip())
        return "\n".join(lines)


def row_of(name: str, times: Sequence[float]) -> Row:
    """Return the median of some times, and what most of them keep."""
    most = float(np.quantile(times, 0.95))
    return Row(name=name, seconds=statistics.median(times), note=f"95 % within {1e3 * most:.1f} ms")


def row_at_most(name: str, times: Sequence[float]) -> Row:
    """Return the median of some times, and the longest."""
    most = max(times)
    return Row(name=name, seconds=statistics.median(times), note=f"at most {1e3 * most:.1f} ms")


def measure(
    function: Callable[[], object],
    *,
    repeats: int = 5,
    clock: Callable[[], float] = time.process_time,
) -> float:
    """Return the median time of a call in seconds, after one call to warm up.

    The clock counts the processor's time: BLAS runs on one thread here, so that it equals the time
    on an idle machine and hardly changes on a busy one. Where threads work, hand in
    `time.perf_counter`.
    """
    function()
    times = []
    for _ in range(repeats):
        start = clock()
        function()
        times.append(clock() - start)
    return statistics.median(times)
