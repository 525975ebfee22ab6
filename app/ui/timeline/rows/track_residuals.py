"""Target errors of tracks, where the limits prevent their targets."""

from collections.abc import Mapping

from app.document import Layer, Track, misses_target
from app.editor import Project
from app.texts import _, ngettext


def find_residuals(project: Project, layer: Layer, track: Track) -> Mapping[int, float]:
    """Return the largest target error of the track's handles in pixels, by frame."""
    corrected = project.runtimes.layers[layer.id].corrected
    if corrected is None or not track.enabled:
        return {}
    lacks = {
        frame: max((missed.get(handle, 0.0) for handle in track.handles), default=0.0)
        for frame, missed in corrected.misses.items()
    }
    return {frame: lack for frame, lack in lacks.items() if misses_target(layer, lack)}


def describe_residual(project: Project, layer: Layer, track: Track, frame: int) -> str:
    """Describe the target error of a track at a frame; empty if there is none."""
    miss = find_residuals(project, layer, track).get(frame)
    if miss is None:
        return ""
    corrected = project.runtimes.layers[layer.id].corrected
    correction = corrected.at(corrected.clip, frame) if corrected else None
    limits = correction.limits if correction else ()
    if limits:
        text = ngettext(
            "Misses its track by {error:.0f} px at frame {frame}; limit: {limits}",
            "Misses its track by {error:.0f} px at frame {frame}; limits: {limits}",
            len(limits),
        )
    else:
        text = _("Misses its track by {error:.0f} px at frame {frame}: the shape is too stiff")
    return text.format(error=miss, frame=frame, limits=", ".join(map(_, limits)))
