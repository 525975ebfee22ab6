"""Posing, drawing, encoding and writing the frames of an export, a few at a time."""

from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any, Final, TypeVar

from app.export.plan import ExportPlan
from app.export.writers import FrameWriter, open_writer
from engine.arrays import Bytes

T = TypeVar("T")

ENCODERS: Final = 2  # threads
AHEAD: Final = 4  # frames that are posed but not yet drawn
# Frames that are drawn but not yet written: as many as these bytes hold, and no more than that.
QUEUED_BYTES, MOST_QUEUED = 2**26, 8


def export(
    plan: ExportPlan,
    pose: Callable[[float], T],
    draw: Callable[[T], Bytes],
    *,
    waits: bool = True,
) -> Generator[int]:
    """Make what was planned, one frame at each step.

    Parameters
    ----------
    plan : ExportPlan
    pose : callable
        Returns what `draw` needs of a frame of the timeline. It is called in their order, on a
        thread of its own.
    draw : callable
        Returns the picture, uint8 (h, w, 4) with straight alpha. It is called on the thread that
        takes the steps, which may be the one of a window.
    waits : bool
        Whether a step waits until another frame is drawn. Else it returns at once where there is
        nothing to draw yet, and nowhere does the thread that takes it wait for others.

    Yields
    ------
    int
        The number of frames that are drawn.

    Raises
    ------
    LissomError
        If a frame cannot be drawn or written.

    Notes
    -----
    Closing the iterator, or an exception, ends the export: PNG frames that are written stay, each
    of them whole, and of any other format nothing stays. The memory does not grow with the number
    of frames (that of a sprite sheet does with its size), nor with how slowly they are encoded.
    """
    with (
        open_writer(plan) as writer,
        threads("poses", 1) as poses,
        threads("encoder", ENCODERS) as encoders,
        threads("writer", 1) as writers,
        _stopped_early(writer),
    ):
        width, height = plan.view.size
        queued = min(max(1, QUEUED_BYTES // (4 * width * height)), MOST_QUEUED)
        times = iter(plan.times)
        posed: deque[Future[T]] = deque()
        written: deque[Future[None]] = deque()
        for index in range(len(plan.times)):
            while len(posed) <= AHEAD and (time := next(times, None)) is not None:
                posed.append(poses.submit(pose, time))
            while len(written) >= queued or (written and written[0].done()):
                yield from come(written[0], index, waits=waits)
                written.popleft().result()
            yield from come(posed[0], index, waits=waits)
            frame = draw(posed.popleft().result())
            encoded = encoders.submit(writer.encode, index, frame)
            written.append(writers.submit(_add, writer, encoded))
            yield index + 1
        for due in written:
            yield from come(due, len(plan.times), waits=waits)
            due.result()
        end = writers.submit(writer.finish)
        yield from come(end, len(plan.times), waits=waits)
        end.result()


def come(due: Future[Any], count: int, *, waits: bool) -> Iterator[int]:
    """Go on yielding the count until something is done, unless it may be waited for."""
    while not waits and not due.done():
        yield count


def _add(writer: FrameWriter, encoded: Future[bytes]) -> None:
    writer.add(encoded.result())


@contextmanager
def _stopped_early(writer: FrameWriter) -> Iterator[None]:
    """Let a writer stop where the block ends with an exception, before its threads are awaited."""
    try:
        yield
    except BaseException:
        writer.stop()
        raise


@contextmanager
def threads(name: str, count: int) -> Iterator[ThreadPoolExecutor]:
    """Lend threads; what they have not begun at the end of the block they never do."""
    pool = ThreadPoolExecutor(count, thread_name_prefix=name)
    try:
        yield pool
    finally:
        # Files that are half written are finished first.
        pool.shutdown(cancel_futures=True)
