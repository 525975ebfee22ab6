"""Onion skins: the layers as they are before and after the shown frame."""

from functools import partial
from itertools import takewhile

from app.document import (
    TRANSFORM,
    CompositeGroup,
    Layer,
    composite_layers,
    is_visible,
    segment_time_at,
    without_foreign_clips,
)
from app.editor import Project, Session
from app.render import Ghost
from app.render.gpu.mesh import PosedMesh
from app.ui.viewport.picture.gpu_resources import GpuResources

GHOST_BEFORE, GHOST_AFTER = (0.93, 0.36, 0.36), (0.30, 0.62, 0.98)
GHOST_OPACITY = 0.38


def make_ghosts(session: Session, project: Project, drawing: GpuResources) -> tuple[Ghost, ...]:
    """Return the onion skins of all layers that are visible then and look different."""
    if project.timeline.playhead.since is not None or project.layer_runtime.shown is None:
        return ()
    preferences, now = session.settings.preferences, int(project.layer_runtime.shown.frame)
    ghosts = []
    sides = (
        (-1, preferences.ghosts_before, GHOST_BEFORE),
        (1, preferences.ghosts_after, GHOST_AFTER),
    )
    number = 0
    for direction, count, tint in sides:
        for step in range(count, 0, -1):
            number += 1
            at = now + direction * step * preferences.ghost_step
            frame = project.document.loop_frame(at)
            poses = {
                layer.id: _ghost(project, drawing, layer, now, at, number)
                for layer in project.document.layers
                if not project.document.is_deform_group(layer.id)
            }
            seen = {layer: pose for layer, pose in poses.items() if pose is not None}
            if seen:
                # What is clipped to a layer that looks the same has a ghost, too.
                hidden = {
                    each.id
                    for each in project.document.layers
                    if not is_visible(project.document, each, frame)
                }
                cut = without_foreign_clips(project.document, seen.keys() | hidden)
                meshes = composite_layers(cut, seen, frame)
                ghosts.append(Ghost(meshes=meshes, tint=tint, opacity=GHOST_OPACITY / step**0.5))
    return tuple(ghosts)


def _ghost(
    project: Project, drawing: GpuResources, layer: Layer, now: int, at: int, number: int
) -> PosedMesh | None:
    """Return a layer at another frame; None if it looks the same or is not visible there.

    If a parent layer has just moved, the ghost is omitted until its place is computed.
    """
    document = project.document
    bent = document.deform_layer(layer).id
    runtime = project.runtimes.layers[bent]
    # During a drag, in-betweens arrive later. Until then the last ones stay.
    known = runtime.store.whole
    if known is None or (at not in known.frames and not known.loop):
        return None
    placed = project.placed_at(layer.id, [now, at])
    if project.layer_list.solo and layer.id not in project.layer_list.solo:
        return None
    was_seen, is_seen = (is_visible(document, layer, document.loop_frame(f)) for f in (now, at))
    stays = (
        segment_time_at(known, at) == segment_time_at(known, now)
        and placed
        and placed[0] == placed[1]
    )
    if placed is None or not is_seen or (was_seen and stays):
        return None
    correction = runtime.corrected.at(known, at) if runtime.corrected else None
    find = partial(runtime.store.vertices, known, at, correction=correction)
    of = runtime.store.mesh, known, at, correction
    vertices = drawing.ghost(bent, number, of, find)
    if vertices is None:
        return None
    drawn = drawing.drawn_mesh(layer.id, runtime.store.mesh, number)
    return drawn.pose(vertices, placement=placed[1])


def count_meshes_behind(session: Session, project: Project, meshes: int) -> int:
    """Return how many meshes lie behind the ghosts: all, or only a background's."""
    if session.settings.preferences.ghosts_in_front:
        return meshes
    document, shows = project.document, project.runtimes.layers
    frame = max((each.shown.frame for each in shows.values() if each.shown), default=0)
    still = {
        each.id: each.still and each.deform_group is None and not each.keys_of(TRANSFORM)
        for each in document.layers
        if (shown := shows[each.id].shown) is not None
        and is_visible(document, each, shown.frame)
        and (not project.layer_list.solo or each.id in project.layer_list.solo)
    }
    return sum(1 for _ in takewhile(_is_still, composite_layers(document, still, frame)))


def _is_still(part: bool | CompositeGroup[bool]) -> bool:  # noqa: FBT001 - of a composition
    return all(map(_is_still, part.parts)) if isinstance(part, CompositeGroup) else part
