"""Commands on the document's frames, playback, export settings, canvas and markers."""

from collections.abc import Callable, Iterable
from dataclasses import replace
from itertools import pairwise
from typing import Any

from app.document.commands.command import command, with_number
from app.document.commands.keys.retime import TimeScale, nearest_frame
from app.document.commands.keys.stored_keys import KeyRows, put_rows
from app.document.layer import Layer
from app.document.model import Document
from app.document.queries.channel_values.channel_keys import (
    channels_in,
    describe_channel,
    keys_in,
    track_channel,
)
from app.document.rig.applied_motion import AppliedMotion
from app.document.rig.mirror_names import SidePairs
from app.document.settings import ExportSettings, FrameRange, Marker
from app.errors import LissomError
from app.texts import N_, _

KEY_OUTSIDE = N_(
    "The key at frame {frame} would lie outside frames {first} to {last}; move or "
    "delete it first, or set a preview range instead."
)


@command(_("Set frames per second"))
def set_fps(document: Document, fps: float) -> Document:
    return document if fps == document.fps else replace(document, fps=float(fps))


@command(_("Set frames"))
def set_frames(document: Document, frames: FrameRange) -> Document:
    """Set the first and last frame and clip all ranges to them; a key outside is refused."""
    if frames == document.frames:
        return document
    outside = next((frame for frame in document.keyed_range if frame not in frames), None)
    if outside is not None:
        raise LissomError(
            _(KEY_OUTSIDE).format(frame=outside, first=frames.first, last=frames.last)
        )

    def cut(part: FrameRange) -> FrameRange | None:
        if part.last < frames.first or part.first > frames.last:
            return None
        return FrameRange(frames.clamp(part.first), frames.clamp(part.last))

    return replace(document, **{**_mapped_ranges(document, cut), "frames": frames})


def _mapped_ranges(
    document: Document, to: Callable[[FrameRange], FrameRange | None]
) -> dict[str, Any]:
    """Return a document's frames, preview range and export range, mapped by a function."""

    def mapped(part: FrameRange | None) -> FrameRange | None:
        return None if part is None else to(part)

    export = replace(document.export, frames=mapped(document.export.frames))
    return {"frames": to(document.frames), "preview": mapped(document.preview), "export": export}


@command(_("Set preview range"))
def set_preview(document: Document, preview: FrameRange | None) -> Document:
    """Set the range of playback; None plays all frames. Exports ignore the range."""
    return document if preview == document.preview else replace(document, preview=preview)


@command(_("Set loop"))
def set_loop(document: Document, *, loop: bool) -> Document:
    return document if loop == document.loop else replace(document, loop=loop)


@command(_("Set export"))
def set_export(document: Document, export: ExportSettings) -> Document:
    return document if export == document.export else replace(document, export=export)


@command(_("Set name pairs"))
def set_mirror_names(document: Document, pairs: SidePairs) -> Document:
    """Set the words or names for the two sides of layers and handles."""
    return document if pairs == document.pairs else replace(document, pairs=pairs)


@command(_("Set canvas"))
def set_canvas(document: Document, size: tuple[int, int]) -> Document:
    """Set the size of the canvas, whose lower left corner is the origin; layers stay in place."""
    return document if size == document.canvas else replace(document, size=size)


@command(_("Scale time"))
def scale_time(document: Document, factor: float) -> Document:
    """Scale all keys, markers and ranges around the first frame."""
    scale = TimeScale(document.frames.first, factor)
    if factor == 1:
        return document

    def scaled(frames: FrameRange) -> FrameRange:
        return FrameRange(scale(frames.first), scale(frames.last))

    rows = {
        channel: scale.scaled(keys_in(document, channel), describe_channel(document, channel))
        for channel in channels_in(document)
    }
    changes = {layer.id: _scaled_fields(layer, scale, rows) for layer in document.layers}
    document = put_rows(document, rows, changes, **_mapped_ranges(document, scaled))
    sounds = tuple(replace(each, start=scale.scaled_time(each.start)) for each in document.sounds)
    return replace(document, sounds=sounds)


def _scaled_fields(layer: Layer, scale: TimeScale, rows: KeyRows) -> dict[str, Any]:
    """Return a layer's scaled fields; springs keep their frequencies in seconds."""
    return {
        "cycles": tuple(cycle.retimed(scale) for cycle in layer.cycles),
        "motions": tuple(
            motion.moved(scale)
            for motion in layer.motions
            if scale(motion.start) < scale(motion.last)
        ),
        "tracks": tuple(
            replace(
                track,
                keys=rows[track_channel(layer.id, track)],
                delay=nearest_frame(scale.factor * track.delay),
            )
            for track in layer.tracks
        ),
    }


@command(_("Add marker"))
def add_marker(document: Document, frame: int, name: str | None = None) -> Document:
    """Add a marker, by default under a free name."""
    taken = {marker.name for marker in document.markers}
    free = with_number("Marker", taken, len(document.markers) + 1)
    marker = Marker(frame=frame, name=free if name is None else name)
    return _with_markers(document, (*document.markers, marker))


@command(_("Rename marker"))
def rename_marker(document: Document, frame: int, name: str) -> Document:
    return _with_marker(document, frame, replace(document.marker(frame), name=name))


def _with_marker(document: Document, frame: int, changed: Marker) -> Document:
    before = document.marker(frame)
    if changed == before:
        return document
    return _with_markers(
        document, (changed if marker is before else marker for marker in document.markers)
    )


def _with_markers(document: Document, markers: Iterable[Marker]) -> Document:
    ordered = sorted(markers, key=lambda marker: marker.frame)
    for one, other in pairwise(ordered):
        if one.frame == other.frame:
            raise LissomError(
                _(
                    "Two markers would be at frame {frame}; move or delete the marker there first."
                ).format(frame=one.frame)
            )
    return replace(document, markers=tuple(ordered))


@command(_("Apply motion preset"))
def apply_motion(document: Document, moved: Layer, given: AppliedMotion) -> Document:
    """Replace a layer by one with a motion preset; a document without motion becomes its loop."""
    is_new = not _moves(document)
    document = document.with_layer(moved)
    if is_new and given.first == document.frames.first:
        loop = not given.parameters.travel and given.start == given.first
        own = set_frames(FrameRange(given.first, given.last))(document)
        return replace(own, loop=loop)
    return document


def _moves(document: Document) -> bool:
    """Return whether any part of a document has motion."""
    has_time = bool(document.preview or document.markers or document.camera)
    has_time |= any(switch.keys[1:] for switch in document.switch_groups)
    return has_time or any(
        each.keys[1:] or each.tracks or each.cycles or each.channels or each.attachments[1:]
        for each in document.layers
    )
