"""The path of the selected track with its keys, and the trail of a recorded drag."""

import numpy as np

from app.document import Track, track_display_frame
from app.editor import Project
from app.editor.actions.tracking.track_space import track_target
from app.render import Colour, Disc, Line
from engine.arrays import Complexes

MOST = 500  # drawn frames of a path at most; a longer animation shows every second, third …
DOT, KEY_DOT = 1.8, 4.4  # pixels: radius of a frame on a path, and of a key


def find_path_keys(project: Project) -> list[tuple[int, Complexes]]:
    """Return frame and scene place, (1,), of the selected track's keys.

    Keys whose place is not computed yet are omitted.
    """
    track = _chosen(project)
    if track is None:
        return []
    document = project.document
    frames = {track_display_frame(document, track, key.frame) for key in track.keys}
    return _places(project, track, sorted(frame for frame in frames if frame in document.frames))


def mark_path(
    project: Project, accent: Colour, key: Colour, rim: Colour, scale: float
) -> tuple[list[Line], tuple[Disc, ...]]:
    """Return the path of the selected track, and the trail of a recorded drag."""
    lines, discs, track, take = (
        list[Line](),
        list[Disc](),
        _chosen(project),
        project.timeline.recording,
    )
    if take is not None and len(take.samples) > 1:
        trail = np.array([sample.place for sample in take.samples])
        lines.append(Line(points=trail, colour=(*key[:3], 0.35 * key[3]), width=3.0 * scale))
    if track is None or (take is not None and not take.is_written):
        return lines, ()
    first, last = project.clip.frames.first, project.clip.frames.last
    frames = range(first, last + 1, 1 + (last - first) // MOST)
    path = _places(project, track, list(frames))
    if len(path) > 1:
        points = np.concatenate([place for _, place in path])
        lines.append(Line(points=points, colour=(*accent[:3], 0.7 * accent[3]), width=1.4 * scale))
    for radius, fill, places in ((DOT, accent, path), (KEY_DOT, key, find_path_keys(project))):
        discs += [
            Disc(
                centre=complex(place[0]),
                radius=radius * scale,
                fill=fill,
                rim=rim,
                rim_width=scale,
            )
            for _, place in places
        ]
    return lines, tuple(discs)


def _chosen(project: Project) -> Track | None:
    handle = project.selected_track
    return None if handle is None else project.layer.track_of(handle)


def _places(project: Project, track: Track, frames: list[int]) -> list[tuple[int, Complexes]]:
    """Return the scene places of a track's first handle, by frame, as far as they are computed."""
    shown = project.layer_runtime.shown
    if shown is None:
        return []
    if not track.is_scene_space and project.placed_at(project.selection.active, frames) is None:
        return []
    targets = [track_target(project, track, frame) for frame in frames]
    # A scene-space track is independent of its layer's placement.
    placements = project.placements(frames, shown.placement)
    return [
        (frame, placement.apply(np.array([place])))
        for frame, place, placement in zip(frames, targets, placements, strict=True)
        if place is not None
    ]
