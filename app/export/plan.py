"""The plan of an export, checked before the first frame is drawn."""

import math
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, NamedTuple

import numpy as np

from app.document import Document
from app.errors import report_progress
from app.export.destination import FrameNames, check_room, find_stale_frames
from app.export.framing import check_largest_size, frame_view, list_added_pixels
from app.export.request import ExportRequest, export_times, exported_frames
from app.export_formats import EXPORT_FORMATS, FormatSettings
from app.motion import BoundingBox, Evaluator, bounding_box, measure_extent
from app.render import View
from app.sound import Soundtrack, find_soundtrack, list_sound_notices
from app.texts import ngettext

# Minimum of bytes per frame pixel: an empty PNG has about as many.
LEAST: Final = 0.001


class FrameTag(NamedTuple):
    """A name for consecutive pictures of an export, given by first and last index."""

    name: str
    first: int
    last: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportPlan(FormatSettings):
    """The contents of an export.

    Parameters
    ----------
    format : str
        A name of `EXPORT_FORMATS`.
    view : View
        Shown part of the plane and size of every frame.
    background : tuple of 3 ints, optional
        Red, green and blue; None keeps transparency.
    times : tuple of float
        The timeline frame of each picture, whole or between two.
    first : int
        Number of the first picture. The following ones count on, whatever the rate.
    span : tuple of int
        First and last timeline frame of the motion of meshes. In a loop the last equals the first.
    fps : float
        Pictures per second.
    timeline_fps : float
        Timeline frames per second at the speed of the export.
    passes : int
        How often the pictures of the motion come.
    canvas : tuple of int
        Width and height of the document's canvas.
    frame_names : FrameNames
        Names of the pictures, if each is a file of its own.
    tags : tuple of FrameTag
        Parts of the motion between markers; without markers the whole motion.
    """

    out: Path
    format: str
    view: View
    background: tuple[int, int, int] | None
    times: tuple[float, ...]
    first: int
    span: tuple[int, int]
    fps: float
    timeline_fps: float
    passes: int
    canvas: tuple[int, int]
    loop: bool
    frame_names: FrameNames
    tags: tuple[FrameTag, ...]
    soundtrack: Soundtrack | None = None  # of the pictures; of meshes, of the span
    notices: tuple[str, ...] = ()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of the pictures in the file, with pixels that the format adds."""
        return EXPORT_FORMATS[self.format].whole_blocks(self.view.size)

    @property
    def names(self) -> list[str]:
        """File names of the pictures, if each is a file of its own."""
        return self.frame_names.of(self.first, len(self.times))


def plan_export(
    document: Document,
    request: ExportRequest,
    evaluator: Evaluator,
    extent: BoundingBox | None = None,
) -> ExportPlan:
    """Plan an export whose request has passed `check_request`.

    Parameters
    ----------
    evaluator : Evaluator
        Used only if the framing depends on the motion.
    extent : BoundingBox, optional
        Box around the whole motion, if already known.

    Raises
    ------
    LissomError
        If the motion fails at some frame.
    """
    settings, frames = request.settings, exported_frames(document, request.settings)
    times = export_times(document, settings, request.fps)
    fps = document.fps if request.fps is None else request.fps
    # The pictures of a loop leave out its last frame, which equals the first.
    end = frames.last if settings.frames is not None else document.frames.last
    is_drawn = EXPORT_FORMATS[settings.format].is_drawn
    passes = settings.repeat if is_drawn and not EXPORT_FORMATS[settings.format].is_still else 1
    seconds = len(times) / fps if is_drawn else (end - frames.first) / fps
    bent = dict.fromkeys(map(document.deform_layer, document.exported_layers))
    rest = np.concatenate([layer.domain.mesh.vertices for layer in bent])
    if settings.framing == "fit" and not document.camera and extent is None:
        extent = measure_extent(document, evaluator, frames, report_progress)
    plan = ExportPlan(
        out=request.out,
        format=settings.format,
        view=frame_view(settings, document, extent or bounding_box(rest)),
        background=_colour(settings.background),
        times=times,
        first=frames.first,
        span=(frames.first, end),
        canvas=document.canvas,
        fps=fps,
        timeline_fps=document.fps * settings.speed,
        passes=passes,
        loop=document.loop,
        frame_names=request.names,
        tags=_tags(document, request, times[: len(times) // passes]),
        soundtrack=find_soundtrack(document, settings, frames.first, seconds, passes=passes),
        **settings.options(),
    )
    if is_drawn:
        check_largest_size(plan.format, plan.view.size)
        width, height = plan.view.size
        check_room(plan.out, int(LEAST * width * height * len(times)))
    return replace(
        plan,
        notices=(
            *_left_frames(plan),
            *list_added_pixels(plan.format, plan.view.size),
            *list_sound_notices(document, settings, plan.soundtrack),
        ),
    )


def _tags(
    document: Document, request: ExportRequest, times: tuple[float, ...]
) -> tuple[FrameTag, ...]:
    found = []
    ends = [*(marker.frame for marker in document.markers[1:]), math.inf]
    for marker, end in zip(document.markers, ends, strict=False):
        inside = [index for index, time in enumerate(times) if marker.frame <= time < end]
        if inside:
            found.append(FrameTag(marker.name, inside[0], inside[-1]))
    return tuple(found) or (FrameTag(request.project, 0, len(times) - 1),)


def _colour(background: str) -> tuple[int, int, int] | None:
    if background == "transparent":
        return None
    red, green, blue = bytes.fromhex(background[1:])
    return red, green, blue


def _left_frames(plan: ExportPlan) -> tuple[str, ...]:
    """Return notices about frames in the folder that this export does not rewrite."""
    others = (
        []
        if EXPORT_FORMATS[plan.format].suffixes
        else find_stale_frames(plan.out, plan.frame_names, plan.names)
    )
    if not others:
        return ()
    which = others[0] if len(others) == 1 else f"{others[0]} … {others[-1]}"
    return (
        ngettext(
            "{folder} contains {count} frame of another export ({names}), which is kept",
            "{folder} contains {count} frames of another export ({names}), which are kept",
            len(others),
        ).format(folder=plan.out, count=len(others), names=which),
    )
