"""Drawing, encoding and writing the frames of an export, a few at a time."""

import importlib
from collections import deque
from collections.abc import Callable, Generator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import ExitStack
from typing import IO, Final

from app.errors import LissomError
from app.export.apng import ApngWriter
from app.export.frame_writer import FrameWriter
from app.export.gif import GifWriter
from app.export.plan import ExportPlan
from app.export.png import PngSequence
from app.export.spritesheet import SpritesheetWriter
from app.export.webp import WebpWriter
from app.storage import atomic_file
from engine.arrays import Bytes

Draw = Callable[[float], Bytes]
"""Returns the picture, uint8 (h, w, 4) with straight alpha, of a frame of the timeline."""

ENCODERS: Final = 2  # threads
AHEAD: Final = 4  # frames that are drawn but not yet encoded


def export(plan: ExportPlan, draw: Draw) -> Generator[int]:
    """Make what was planned, one frame at each step.

    Parameters
    ----------
    plan : ExportPlan
    draw : callable
        It is called on the thread that takes the steps, which may be the one of a window.

    Yields
    ------
    int
        The number of frames that are drawn, after each of them.

    Raises
    ------
    LissomError
        If a frame cannot be drawn or written.

    Notes
    -----
    Closing the iterator, or an exception, ends the export: PNG frames that are written stay, each
    of them whole, and of any other format nothing stays. The memory does not grow with the number
    of frames (that of a sprite sheet does with its size).
    """
    if plan.format == "png":
        _make_folder(plan)
        yield from _write(plan, draw, PngSequence(plan))
    else:
        with atomic_file(plan.out) as file, ExitStack() as cleanup:
            yield from _write(plan, draw, _writer(file, plan, cleanup))


def _write(plan: ExportPlan, draw: Draw, writer: FrameWriter) -> Generator[int]:
    waiting: deque[Future[bytes]] = deque()
    encoders = ThreadPoolExecutor(ENCODERS, thread_name_prefix="encoder")
    try:
        for index, time in enumerate(plan.times):
            waiting.append(encoders.submit(writer.encode, index, draw(time)))
            while len(waiting) > AHEAD or (waiting and waiting[0].done()):
                writer.add(waiting.popleft().result())
            yield index + 1
        while waiting:
            writer.add(waiting.popleft().result())
    finally:
        # Files that are half written are finished first.
        encoders.shutdown(cancel_futures=True)
    writer.finish()


def _writer(file: IO[bytes], plan: ExportPlan, cleanup: ExitStack) -> FrameWriter:
    match plan.format:
        case "apng":
            return ApngWriter(file, plan)
        case "gif":
            return GifWriter(file, plan)
        case "webp":
            return WebpWriter(file, plan)
        case "spritesheet":
            return SpritesheetWriter(file, plan)
    # Not imported at the top: it needs an extra, and loading it takes long.
    video = importlib.import_module("app.export.video").VideoWriter(file, plan)
    cleanup.callback(video.close)
    return video  # type: ignore[no-any-return]


def _make_folder(plan: ExportPlan) -> None:
    try:
        plan.out.mkdir(exist_ok=True)
    except OSError as error:
        raise LissomError(f"cannot make the folder {plan.out}: {error.strerror}") from error
