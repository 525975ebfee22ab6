"""The person's request for an export: refused if impossible, and its frames."""

from dataclasses import dataclass
from pathlib import Path

from app.document import (
    Document,
    ExportSettings,
    FrameRange,
    export_frame_range,
    frame_times,
)
from app.errors import LIBRARIES, LissomError, install_hint
from app.export.destination import FrameNames, check_destination, find_overwritten_files
from app.export.framing import check_blocks, check_largest_size
from app.export_formats import EXPORT_FORMATS
from app.texts import _


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportRequest:
    """The person's request for an export.

    Parameters
    ----------
    out : Path
        A folder for PNG frames, a file for every other format.
    settings : ExportSettings
        The document's own, or others for this export.
    fps : float, optional
        Pictures per second; the document's rate by default.
    sources : tuple of Path
        The input files, which must not be overwritten.
    """

    out: Path
    settings: ExportSettings
    project: str
    fps: float | None = None
    sources: tuple[Path, ...] = ()

    @property
    def names(self) -> FrameNames:
        return FrameNames(pattern=self.settings.names, project=self.project)


def check_request(document: Document, request: ExportRequest) -> None:
    """Refuse an impossible request before any long computation.

    Raises `LissomError` if the output path does not suit the format, frames lie outside the
    animation, or the format cannot be written.
    """
    settings = request.settings
    if not document.exported_layers:
        raise LissomError(
            _("there is nothing to export: every layer is hidden or a reference; show a layer")
        )
    frames = exported_frames(document, settings)
    if frames.first not in document.frames or frames.last not in document.frames:
        text = (
            _("frame {first} is not in the animation; choose one from {start} to {end}")
            if frames.first == frames.last
            else _(
                "frames {first} to {last} are not all in the animation; choose some from {start} "
                "to {end}"
            )
        )
        raise LissomError(
            text.format(
                first=frames.first,
                last=frames.last,
                start=document.frames.first,
                end=document.frames.last,
            )
        )
    name, format_ = settings.format, EXPORT_FORMATS[settings.format]
    check_destination(request.out, name, _names(document, request), request.sources)
    if settings.size is not None and format_.is_drawn:
        check_largest_size(name, settings.size)
        check_blocks(name, settings.size)
    if request.fps is not None and not format_.is_drawn:
        raise LissomError(
            _("{name} plays at any rate; leave out the frames per second").format(name=name)
        )
    fps = document.fps if request.fps is None else request.fps
    if format_.fastest is not None and fps > format_.fastest:
        raise LissomError(
            _(
                "{name} shows at most {fastest:g} frames a second, not {fps:g}; choose fewer "
                "frames per second, or the format apng or webp"
            ).format(name=name, fastest=format_.fastest, fps=fps)
        )
    if not format_.is_transparent and settings.background == "transparent":
        raise LissomError(
            _(
                "{name} has no transparency: choose a background colour such as #ffffff, or "
                "the format apng or webp"
            ).format(name=name)
        )
    if format_.extra and (remedy := install_hint(format_.extra)):
        raise LissomError(
            _("{name} needs the library {library}, which is not installed: {remedy}").format(
                name=name, library=LIBRARIES[format_.extra], remedy=remedy
            )
        )


def list_overwritten_files(document: Document, request: ExportRequest) -> list[str]:
    """Return the names of existing files that an export replaces."""
    return find_overwritten_files(request.out, request.settings.format, _names(document, request))


def _names(document: Document, request: ExportRequest) -> list[str]:
    """Return the names of the pictures, if each is a file of its own."""
    count = len(export_times(document, request.settings, request.fps))
    return request.names.of(exported_frames(document, request.settings).first, count)


def export_times(
    document: Document, settings: ExportSettings, fps: float | None = None
) -> tuple[float, ...]:
    """Return the timeline frame of each picture, with repeats and at the speed of the export.

    `fps` is the number of pictures per second, by default the document's rate.
    """
    frames, format_ = exported_frames(document, settings), EXPORT_FORMATS[settings.format]
    if format_.is_still or not format_.is_drawn:
        return tuple(frame_times(document, frames, fps))
    if settings.speed != 1:
        fps = (document.fps if fps is None else fps) / settings.speed
    return tuple(frame_times(document, frames, fps)) * settings.repeat


def exported_frames(document: Document, settings: ExportSettings) -> FrameRange:
    frames = settings.frames or export_frame_range(document)
    is_still = EXPORT_FORMATS[settings.format].is_still
    return FrameRange(frames.first, frames.first) if is_still else frames
