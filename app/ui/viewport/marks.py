"""The renderer's marks on the drawing: handles, anchor, outline, cage and export frame."""

from functools import lru_cache

import numpy as np
from imgui_bundle import ImVec4

from app.document import (
    Clip,
    Track,
    misses_target,
    pinned_handles,
    segment_time_at,
    track_at,
)
from app.editor import Project, Session
from app.editor.tools.tool import scene_outlines
from app.motion import BoundingBox, LayerFrame, MotionPaths
from app.render import Colour, Disc, HandleMark, Line, mark_anchor, mark_handles
from app.ui.style.theme import Palette, interface_scale, pixel_density
from app.ui.viewport.paths import mark_path
from engine.arrays import Booleans
from engine.domain import MeshedDomain
from engine.geometry import deepest_point

FAINT = 3.0  # pixels: radius of a handle of another layer
STILL = 0.5  # pixels of the picture: a shorter path is not drawn
GROUND, GROUND_BELOW = 17.0, 11.0  # pixels: length and distance of an auto-pin's mark
DOT, KEY_DOT = 2.4, 4.4  # pixels: radius of a frame on a path, and of a key


def pixel_scale(session: Session) -> float:
    """Return how many pixels of the picture one pixel of the design takes."""
    return interface_scale(session.settings.preferences.scale) * pixel_density()


def to_rgba(colour: ImVec4, alpha: float = 1.0) -> Colour:
    """Return a colour of the theme as the renderer needs it."""
    return colour.x, colour.y, colour.z, alpha * colour.w


def mark_all(
    session: Session, project: Project, shown: LayerFrame, palette: Palette
) -> tuple[tuple[Line, ...], tuple[Disc, ...]]:
    """Return the lines and discs that mark the shown frame, in drawing order."""
    scale = pixel_scale(session)
    lines: list[Line] = []
    if session.display.overlays.outline:
        lines += _outlines(shown, palette, scale)
    if session.display.overlays.cage:
        lines += _cages(shown, palette, scale)
    dots: tuple[Disc, ...] = ()
    if session.display.overlays.paths and project.timeline.playhead.since is None:
        path_lines, dots = _paths(session, project, palette, scale)
        lines += path_lines
    if project.timeline.playhead.since is None or project.timeline.recording is not None:
        colours = to_rgba(palette.accent), to_rgba(palette.text), to_rgba(palette.desk, 0.8)
        path_lines, path_dots = mark_path(project, *colours, scale)
        lines, dots = [*lines, *path_lines], (*dots, *path_dots)
    if session.export.frame_box is not None:
        lines.append(_frame(session.export.frame_box, palette, scale))
    is_playing = project.timeline.playhead.since is not None and project.timeline.recording is None
    if not session.display.overlays.handles or is_playing or session.tools.motion_setup is not None:
        return tuple(lines), dots
    handle_lines, discs = mark_handles(_handles(session, project, shown), scale=scale)
    anchor = find_anchor(project, shown)
    faint = _others(project, scale)
    lines += _grounds(session, project, shown, scale)
    below = () if anchor is None else mark_anchor(_on(shown, anchor), scale=scale)
    return (*lines, *handle_lines), (*dots, *faint, *below, *discs)


def _handles(session: Session, project: Project, shown: LayerFrame) -> list[HandleMark]:
    layer, targets = shown.clip.layer, find_off_target(project, shown)
    return [
        HandleMark(
            place=_on(shown, place),
            target=_on(shown, targets[handle.id]) if handle.id in targets else None,
            anchor=handle.position == layer.anchor,
            selected=handle.id in project.selection.handles,
            hovered=handle.id == session.tools.hovered,
            locked=handle.locked,
        )
        for handle, place in zip(layer.handles, shown.handle_positions.tolist(), strict=True)
    ]


def find_off_target(project: Project, shown: LayerFrame) -> dict[int, complex]:
    """Return the pose's targets of handles that have not arrived, by handle id.

    Handles with tracks or springs leave their pose's target, and are omitted. So are joints of
    limbs, which follow, unless they are selected. Sliders move all handles away from it.
    """
    solved = None if shown.correction is None else shown.correction.sliders
    if solved is not None and solved.solution.weights.any():
        return _find_off_track(shown)
    layer, targets = shown.clip.layer, shown.pose.targets if shown.pose else {}
    own = {handle for track in _acting(shown) for handle in track.handles} | layer.sprung_handles
    own |= layer.bone_joints - project.selection.handles
    drag = project.visible_drag
    if drag is not None and drag.world_targets is not None:
        targets = drag.world_targets
    places = zip(layer.handles, shown.handle_positions.tolist(), strict=True)
    wanted = ((handle.id, targets.get(handle.id), place) for handle, place in places)
    short = {
        identity: target.position
        for identity, target, place in wanted
        if target is not None and identity not in own
        if misses_target(layer, abs(target.position - place))
    }
    return {**short, **_find_off_track(shown)}


def _find_off_track(shown: LayerFrame) -> dict[int, complex]:
    """Return the track's targets that handles cannot reach, by handle id."""
    layer, found = shown.clip.layer, shown.correction
    if found is None or shown.placeholder is not None:
        return {}
    return {
        i: found.targets[i] for i, miss in shown.track_errors.items() if misses_target(layer, miss)
    }


def _acting(shown: LayerFrame) -> list[Track]:
    """Return the tracks that have a target in the shown frame."""
    clip = shown.clip
    return [track for track in clip.layer.tracks if track_at(track, clip, shown.frame) is not None]


def find_anchor(project: Project, shown: LayerFrame) -> complex | None:
    """Return the anchor's place in the shown frame; None if a handle marks it or none exists."""
    layer, sampler = shown.clip.layer, project.layer_runtime.store.sampler
    rest = layer.anchor
    if rest is None and sampler is not None and sampler.is_for(layer):
        rest = sampler.sites.anchor
    if rest is None and len(project.document.layers) > 1:
        # Before any motion, the anchor is visible so that the layer can be attached there.
        rest = _deepest_point(layer.domain)
    if rest is None or any(handle.position == rest for handle in layer.handles):
        return None
    return complex(shown.mesh.locate_at_rest([rest]).positions_on(shown.positions)[0])


def clear_mark_caches() -> None:
    """Clear the caches after a project was closed."""
    _deepest_point.cache_clear()
    _still.cache_clear()


@lru_cache(maxsize=64)
def _deepest_point(domain: MeshedDomain) -> complex:
    return deepest_point(domain.outline, domain.loops[1:])


@lru_cache(maxsize=4)
def _still(clip: Clip) -> Booleans:
    return pinned_handles(clip)


def find_auto_pinned(shown: LayerFrame) -> frozenset[int]:
    """Return the ids of auto-pinned handles between the two keys around the shown frame.

    Handles that their own tracks move there are omitted.
    """
    clip, still = shown.clip, _still(shown.clip)
    interval = segment_time_at(clip, shown.frame).segment
    if interval >= len(still):
        return frozenset()
    moved = {identity for track in _acting(shown) for identity in track.handles}
    pairs = zip(clip.layer.handles, still[interval].tolist(), strict=True)
    return frozenset(handle.id for handle, stays in pairs if stays and handle.id not in moved)


def _grounds(session: Session, project: Project, shown: LayerFrame, scale: float) -> list[Line]:
    """Return a short line below each auto-pinned handle, like a ground under its foot."""
    per_pixel = scale / project.view_on(session.display.screen).scale
    stays, lines = find_auto_pinned(shown), list[Line]()
    for handle, place in zip(
        shown.clip.layer.handles, shown.handle_positions.tolist(), strict=True
    ):
        if handle.id not in stays:
            continue
        middle = _on(shown, place) - GROUND_BELOW * per_pixel * 1j
        ends = np.array([middle - GROUND / 2 * per_pixel, middle + GROUND / 2 * per_pixel])
        lines += [
            Line(points=ends, colour=(0.0, 0.0, 0.0, 0.5), width=4.5 * scale),
            Line(points=ends, colour=(1.0, 1.0, 1.0, 1.0), width=2.5 * scale),
        ]
    return lines


def _others(project: Project, scale: float) -> tuple[Disc, ...]:
    """Return faint marks of the other layers' handles."""
    return tuple(
        Disc(centre=complex(place), radius=FAINT * scale, fill=(1.0, 1.0, 1.0, 0.35))
        for layer, runtime in project.runtimes.layers.items()
        if layer != project.selection.active and runtime.shown is not None
        for place in runtime.shown.placement.apply(runtime.shown.handle_positions)
    )


def _on(shown: LayerFrame, place: complex) -> complex:
    """Return a place of the layer in scene coordinates."""
    return complex(shown.placement.apply(np.array([place]))[0])


def _frames_of_paths(session: Session, project: Project, paths: MotionPaths) -> Booleans:
    """Return which frames paths cover: the played ones, or some around the playhead."""
    played, reach = project.document.played_frames, session.settings.preferences.path_reach
    frames = (paths.frames >= played.first) & (paths.frames <= played.last)
    return (
        frames & (abs(paths.frames - project.timeline.playhead.frame) <= reach) if reach else frames
    )


def _paths(
    session: Session, project: Project, palette: Palette, scale: float
) -> tuple[list[Line], tuple[Disc, ...]]:
    """Return the paths of the selected handles: a dot for each frame, a larger dot for a key.

    If a parent layer has just moved, there are no paths until they are computed.
    """
    paths = project.measured.paths.value
    if paths is None or len(paths.frames) < 2 or paths.clip.layer.id != project.selection.active:
        return [], ()
    frames = _frames_of_paths(session, project, paths)
    placements = project.placed_at(project.selection.active, paths.frames[frames].tolist())
    if placements is None or np.count_nonzero(frames) < 2:
        return [], ()
    rows = zip(placements, paths.positions[frames], strict=True)
    places = np.array([placement.apply(row) for placement, row in rows])
    keys = np.isin(paths.frames[frames], [key.frame for key in project.layer.keys])
    lines, discs = [], []
    for handle, path in zip(paths.clip.layer.handles, places.T, strict=True):
        # A path that does not move would only be a blot on its handle.
        if handle.id not in project.selection.handles or np.abs(path - path[0]).max() <= STILL:
            continue
        lines.append(Line(points=path, colour=to_rgba(palette.accent, 0.55), width=1.2 * scale))
        discs += [
            Disc(
                centre=place,
                radius=(KEY_DOT if is_key else DOT) * scale,
                fill=to_rgba(palette.text if is_key else palette.accent),
                rim=to_rgba(palette.desk, 0.8),
                rim_width=scale,
            )
            for place, is_key in zip(path.tolist(), keys.tolist(), strict=True)
        ]
    return lines, tuple(discs)


def _outlines(shown: LayerFrame, palette: Palette, scale: float) -> list[Line]:
    return [
        Line(points=points, colour=to_rgba(palette.accent), width=1.5 * scale, closed=True)
        for points in scene_outlines(shown)
    ]


def _cages(shown: LayerFrame, palette: Palette, scale: float) -> list[Line]:
    """Return the cages around the shape at rest and in its holes, moved with the layer."""
    return [
        Line(
            points=shown.placement.apply(cage),
            colour=to_rgba(palette.warning, 0.8),
            width=1.5 * scale,
            dash=5.0 * scale,
            closed=True,
        )
        for cage in shown.mesh.domain.cages
    ]


def _frame(box: BoundingBox, palette: Palette, scale: float) -> Line:
    low, high = box
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag)]
    return Line(
        points=np.array(corners), colour=to_rgba(palette.accent), width=1.5 * scale, closed=True
    )
