"""Commands on the scene: how long it is, what of it plays, and how, and what is exported."""

from dataclasses import replace

from app.document.commands.command import command
from app.document.commands.key_commands import require_factor, scaled, stretched
from app.document.model import Document
from app.document.settings import ExportSettings, FrameRange
from app.errors import LissomError


@command("Set frames per second")
def set_fps(document: Document, fps: float) -> Document:
    """Set how fast the animation plays."""
    return document if fps == document.fps else replace(document, fps=float(fps))


@command("Set frames")
def set_frames(document: Document, frames: FrameRange) -> Document:
    """Set the first and last frame; keys may not be left outside. The work range is cut to them."""
    if frames == document.frames:
        return document
    keys = (key for figure in document.figures for key in figure.keys)
    outside = next((key.frame for key in keys if key.frame not in frames), None)
    if outside is not None:
        raise LissomError(
            f"The key at frame {outside} would lie outside frames {frames.first} to {frames.last}; "
            "move or delete it first, or set a work range instead."
        )
    work = document.work
    if work is not None:
        apart = work.last < frames.first or work.first > frames.last
        cut = FrameRange(frames.clamp(work.first), frames.clamp(work.last))
        work = None if apart else cut
    return replace(document, frames=frames, work=work)


@command("Set work range")
def set_work_range(document: Document, work: FrameRange | None) -> Document:
    """Set the part of the frames that plays, or None for all of them."""
    return document if work == document.work else replace(document, work=work)


@command("Set loop")
def set_loop(document: Document, *, loop: bool) -> Document:
    """Set whether the end leads back to the beginning."""
    return document if loop == document.loop else replace(document, loop=loop)


@command("Set export")
def set_export(document: Document, export: ExportSettings) -> Document:
    """Set what the next export makes."""
    return document if export == document.export else replace(document, export=export)


@command("Scale time")
def scale_time(document: Document, factor: float) -> Document:
    """Make the whole animation longer or shorter: its keys, its frames and its work range."""
    require_factor(factor)
    if factor == 1:
        return document
    first = document.frames.first

    def scale(frames: FrameRange) -> FrameRange:
        return FrameRange(scaled(frames.first, first, factor), scaled(frames.last, first, factor))

    return replace(
        document,
        figures=tuple(stretched(figure, first, factor) for figure in document.figures),
        frames=scale(document.frames),
        work=None if document.work is None else scale(document.work),
    )
