"""What an export will make, settled and checked before the first frame is drawn."""

import importlib.util
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.document import (
    Document,
    ExportSettings,
    FrameRange,
    exported_frames,
    frame_times,
    framed_frames,
)
from app.errors import LissomError
from app.export.destination import check_destination, frame_names, left_frames, replaced
from app.export.framing import frame_view
from app.export.poses import KeptPoses
from app.export_formats import EXPORT_FORMATS
from app.motion import Box, box_around, motion_box
from app.render import View


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportRequest:
    """What the person asks for.

    Parameters
    ----------
    out : Path
        A folder for PNG frames, a file for every other format.
    settings : ExportSettings
        The document's own, or others for this once.
    fps : float, optional
        Pictures per second; the document's rate by default.
    """

    out: Path
    settings: ExportSettings
    fps: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportPlan:
    """What an export makes.

    Parameters
    ----------
    out : Path
    format : str
        A name of `EXPORT_FORMATS`.
    view : View
        What every frame shows, and its size.
    background : tuple of 3 ints, optional
        Red, green and blue; None leaves transparent what is so.
    times : tuple of float
        The frame of the timeline, whole or between two, that each picture shows.
    first : int
        Number of the first picture; the next ones count on from there, whatever the rate.
    fps : float
        Pictures per second.
    loop : bool
        Whether an animation plays for ever, or once.
    notices : tuple of str
        What the person should know about it.
    """

    out: Path
    format: str
    view: View
    background: tuple[int, int, int] | None
    times: tuple[float, ...]
    first: int
    fps: float
    loop: bool
    notices: tuple[str, ...] = ()

    @property
    def names(self) -> list[str]:
        """The file names of the pictures, where each is a file of its own."""
        return frame_names(self.first, len(self.times))


def check_request(document: Document, request: ExportRequest) -> None:
    """Refuse what cannot work, before anything long begins.

    Raises
    ------
    LissomError
        If the output path does not suit the format, the frames are not the animation's, or the
        format cannot be written.
    """
    settings = request.settings
    frames = _frames(document, settings)
    if frames.first not in document.frames or frames.last not in document.frames:
        raise LissomError(
            f"frames {frames.first} to {frames.last} are not all in the animation, which has "
            f"frames {document.frames.first} to {document.frames.last}"
        )
    frame_times(document, frames, request.fps)
    name, format_ = settings.format, EXPORT_FORMATS[settings.format]
    check_destination(request.out, name)
    if not format_.is_transparent and settings.background == "transparent":
        raise LissomError(
            f"{name} has no transparency: choose a background colour such as #ffffff, or the "
            "format apng or webp"
        )
    if missing(name):
        raise LissomError(
            f"{name} needs the library {format_.library}, which is not installed: {missing(name)}"
        )


def replaced_files(document: Document, request: ExportRequest) -> list[str]:
    """Return the names of the files that an export would take the place of."""
    settings = request.settings
    frames = _frames(document, settings)
    count = len(frame_times(document, frames, request.fps))
    return replaced(request.out, settings.format, frame_names(frames.first, count))


def missing(name: str) -> str:
    """Return how to install what a format needs and this machine lacks; empty if it has all."""
    format_ = EXPORT_FORMATS[name]
    is_there = not format_.library or importlib.util.find_spec(format_.library) is not None
    return "" if is_there else format_.remedy


def plan_export(
    document: Document,
    request: ExportRequest,
    poses: Mapping[int, KeptPoses],
    extent: Box | None = None,
) -> ExportPlan:
    """Settle an export whose request has passed `check_request`.

    Parameters
    ----------
    document : Document
    request : ExportRequest
    poses : mapping of int to KeptPoses
        One for each figure, by its id; looked at only where the framing depends on the motion.
    extent : Box, optional
        Around all of the motion, where that is known already.

    Raises
    ------
    LissomError
        If the motion fails at some frame.
    """
    settings = request.settings
    frames = _frames(document, settings)
    times = tuple(frame_times(document, frames, request.fps))
    rest = np.concatenate([figure.domain.mesh.vertices for figure in document.figures])
    if settings.framing == "fit" and extent is None:
        extent = motion_box(
            document,
            framed_frames(document, frames),
            lambda figure, frame: poses[figure].keep(frame),
        )
    plan = ExportPlan(
        out=request.out,
        format=settings.format,
        view=frame_view(settings, document.canvas, extent or box_around(rest)),
        background=_colour(settings.background),
        times=times,
        first=frames.first,
        fps=document.fps if request.fps is None else request.fps,
        loop=document.loop,
    )
    return replace(plan, notices=_left_frames(plan))


def _frames(document: Document, settings: ExportSettings) -> FrameRange:
    return settings.frames or exported_frames(document)


def _colour(background: str) -> tuple[int, int, int] | None:
    if background == "transparent":
        return None
    red, green, blue = bytes.fromhex(background[1:])
    return red, green, blue


def _left_frames(plan: ExportPlan) -> tuple[str, ...]:
    """Tell of frames in the folder that this export will not write again."""
    others = [] if EXPORT_FORMATS[plan.format].suffixes else left_frames(plan.out, plan.names)
    if not others:
        return ()
    which = others[0] if len(others) == 1 else f"{others[0]} … {others[-1]}"
    return (
        f"{plan.out} holds {len(others)} frames of another export ({which}); they stay as they are",
    )
