"""Posing, drawing, encoding and writing the frames of an export, a few at a time."""

from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from queue import SimpleQueue
from typing import Any, Final, NamedTuple, TypeVar

from app.export.plan import ExportPlan
from app.export.writers.frame_writer import FrameWriter
from app.export.writers.table import open_writer
from app.export_formats import EXPORT_FORMATS
from app.storage import Cancellation
from engine.arrays import Bytes

T = TypeVar("T")

ENCODERS: Final = 2  # threads
AHEAD: Final = 4  # frames posed but not yet drawn
# Frames drawn but not yet written: limited in bytes and in number.
QUEUED_BYTES, MOST_QUEUED = 2**26, 8


class _InFlight(NamedTuple):
    """A frame in the writing queue; `written` completes after it is written."""

    encoded: Future[Any]
    written: Future[None]


def export_frames(
    plan: ExportPlan,
    pose: Callable[[float], T],
    draw: Callable[[T], Bytes],
    *,
    waits: bool = True,
    cancellation: Cancellation | None = None,
) -> Generator[int]:
    """Run the plan, one frame at each step.

    Closing the iterator, or an exception, ends the export. Written PNG frames stay, each of them
    whole; other formats leave no file. The running pose job is not awaited, as it may take long.

    Memory does not grow with the number of frames, except for a sprite sheet, nor with slow
    encoding.

    Parameters
    ----------
    pose : callable
        Returns the input of `draw` for a timeline frame. It is called in order, on a thread of its
        own.
    draw : callable
        Returns the picture, uint8 (h, w, 4) with straight alpha. It is called on the stepping
        thread, which may belong to a window.
    waits : bool
        Whether a step waits for the next drawn frame. Otherwise no step ever waits for another
        thread, not even when the export ends early.

    Yields
    ------
    int
        The number of drawn frames.

    Raises
    ------
    LissomError
        If a frame cannot be drawn or written.
    """
    cancellation = cancellation or Cancellation()
    width, height = plan.view.size
    queued = min(max(1, QUEUED_BYTES // (4 * width * height)), MOST_QUEUED)
    times, total = iter(plan.times), len(plan.times)
    posed: deque[Future[T]] = deque()
    written: deque[Future[None]] = deque()
    opened: Future[FrameWriter] = Future()
    due: SimpleQueue[_InFlight | None] = SimpleQueue()
    poses, encoders, writers = (ThreadPoolExecutor(count) for count in (1, ENCODERS, 1))
    end = writers.submit(_write, plan, cancellation, opened, due)
    is_idle, finishes_frames = False, waits and not EXPORT_FORMATS[plan.format].suffixes
    try:
        yield from wait_some(opened, end, count=0, waits=waits)
        for index in range(total):
            while len(posed) <= AHEAD and (time := next(times, None)) is not None:
                posed.append(poses.submit(pose, time))
            while len(written) >= queued or (written and written[0].done()):
                yield from wait_some(written[0], end, count=index, waits=waits)
                written.popleft()
            yield from wait_some(posed[0], end, count=index, waits=waits)
            frame = draw(posed.popleft().result())
            encoded = encoders.submit(opened.result().encode, frame)
            written.append(Future())
            due.put(_InFlight(encoded, written[-1]))
            yield index + 1
        due.put(None)
        yield from wait_some(end, count=total, waits=waits)
        is_idle = True
    except BaseException:
        if not finishes_frames:
            cancellation.cancel()
        raise
    finally:
        due.put(None)
        poses.shutdown(wait=is_idle, cancel_futures=True)
        encoders.shutdown(wait=is_idle, cancel_futures=True)
        writers.shutdown(wait=is_idle or finishes_frames)


def wait_some(*awaited: Future[Any], count: int, waits: bool) -> Iterator[int]:
    """Wait until one of the jobs is done; without waiting, yield `count` until then.

    Raises
    ------
    Exception
        The exception of a failed job.
    """
    while not waits and not any(each.done() for each in awaited):
        yield count
    for each in wait(awaited, return_when=FIRST_COMPLETED).done:
        each.result()


def _write(
    plan: ExportPlan,
    cancellation: Cancellation,
    opened: Future[FrameWriter],
    due: SimpleQueue[_InFlight | None],
) -> None:
    """Write the queued frames until the queue ends; all file access is on this thread.

    Raises `LissomError` if a file cannot be written, or the export was cancelled.
    """
    with open_writer(plan, cancellation) as writer:
        opened.set_result(writer)
        while (frame := due.get()) is not None:
            cancellation.check()
            writer.add(frame.encoded.result())
            frame.written.set_result(None)
        cancellation.check()
        writer.finish()
