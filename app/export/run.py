"""Posing, drawing, encoding and writing the frames of an export, a few at a time."""

from collections import deque
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from queue import SimpleQueue
from typing import Any, Final, NamedTuple, TypeVar

from app.export.plan import ExportPlan
from app.export.writers import FrameWriter, open_writer
from app.export_formats import EXPORT_FORMATS
from app.storage import Cancellation
from engine.arrays import Bytes

T = TypeVar("T")

ENCODERS: Final = 2  # threads
AHEAD: Final = 4  # frames that are posed but not yet drawn
# Frames that are drawn but not yet written: as many as these bytes hold, and no more than that.
QUEUED_BYTES, MOST_QUEUED = 2**26, 8


class _InFlight(NamedTuple):
    """A frame that is to be written, and what is done when it is."""

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
        nothing to draw yet, and nowhere does the thread that takes it wait for others, not even
        where the export ends early.
    cancellation : Cancellation, optional
        By which it can be cancelled before the iterator is closed.

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
    of them whole, and of any other format nothing stays. The pose under way is left to itself, as
    it may take long. The memory does not grow with the number of frames (that of a sprite sheet
    does with its size), nor with how slowly they are encoded.
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
    """Go on yielding the count until one of some is done, unless they may be waited for.

    Raises
    ------
    Exception
        What one of them failed with.
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
    """Write what is due until nothing more is; on the one thread that has the files in its hands.

    Raises
    ------
    LissomError
        If something cannot be written, or was cancelled.
    """
    with open_writer(plan, cancellation) as writer:
        opened.set_result(writer)
        while (frame := due.get()) is not None:
            cancellation.check()
            writer.add(frame.encoded.result())
            frame.written.set_result(None)
        cancellation.check()
        writer.finish()
