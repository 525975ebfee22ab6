"""Pasting track keys: onto the selected track or, together with poses, by names."""

from collections.abc import Mapping
from dataclasses import replace

from app.document import Track, track_commands
from app.editor.poses.paste_destinations import PasteDestination, PasteMode, find_paste_destinations
from app.editor.project import Project
from app.editor.session import CopiedTrack, Session
from app.editor.timeline_view import TrackRow


def pasteable_tracks(
    session: Session, project: Project, way: PasteMode
) -> Mapping[TrackRow, CopiedTrack]:
    """Return the copied keys of each track, by the row on which they can be pasted.

    Keys of a single track go to the selected track. Otherwise they go with the poses, by names.
    """
    copied, chosen = session.copied_tracks, project.selected_track
    if way == "as it is" and len(copied) == 1 and chosen is not None:
        return {TrackRow(project.active, chosen): copied[0]}
    carried = {}
    for landing in find_paste_destinations(session, project, way):
        ours = {other: identity for identity, other in landing.pairs.items()}
        for each in copied:
            handles = tuple(ours[each_id] for each_id in each.track.handles if each_id in ours)
            if each.layer.id == landing.copied.layer.id and each.track.handles[0] in ours:
                track = _transferred_track(landing, each, way, handles)
                carried[TrackRow(landing.layer.id, handles[0])] = track
    return carried


def _transferred_track(
    landing: PasteDestination, copied: CopiedTrack, way: PasteMode, handles: tuple[int, ...]
) -> CopiedTrack:
    """Return a copied track for other handles of a layer."""
    likeness = landing.pose_transfer(way).similarity
    old = landing.copied.layer.handle(copied.track.handles[0]).position
    new = landing.layer.handle(handles[0]).position
    # Keys relative to the pose are offsets. Keys in the scene are places, with the handle's offset.
    start = (
        -likeness.shift if not copied.track.is_scene_space else new - likeness.apply_to_point(old)
    )
    keys = tuple(
        replace(
            key,
            place=likeness.apply_to_point(key.place) + start,
            turn=-key.turn if likeness.mirrors else key.turn,
            velocity=None
            if key.velocity is None
            else likeness.apply_to_point(key.velocity) - likeness.shift,
        )
        for key in copied.keys
    )
    if landing.is_direct(way):
        keys = copied.keys
    return replace(copied, track=replace(copied.track, handles=handles), keys=keys)


def paste_track(
    session: Session, project: Project, row: TrackRow, copied: CopiedTrack, by: int, gesture: object
) -> None:
    """Paste track keys on a row, `by` frames later, and select them."""
    layer = project.document.layer(row.layer)
    track, name = layer.track_of(row.handle), layer.handle(row.handle).name
    if track is not None and track.is_scene_space != copied.track.is_scene_space:
        session.show_notice(
            f"The keys that were copied are {_kind(copied.track)}, those of {name} are "
            f"{_kind(track)}. Set both alike in the Handle tab, then copy again."
        )
        return
    by += copied.track.delay - (0 if track is None else track.delay)
    keys = tuple(replace(key, frame=key.frame + by) for key in copied.keys)
    if keys[0].frame < 0:
        session.show_notice(f"The track of {name} is too late for a key at this frame.")
        return
    if track is None:
        handles = copied.track.handles if copied.track.handles[0] == row.handle else (row.handle,)
        track = replace(copied.track, handles=handles, keys=keys)
        command = track_commands.put_track(row.layer, track)
    else:
        command = track_commands.put_track_keys(*row, keys)
    project.history.do(command, gesture=gesture)
    frames = frozenset(key.frame for key in keys)
    project.selected_handles, project.selected_keys = (
        frozenset(),
        {**project.selected_keys, row: frames},
    )


def _kind(track: Track) -> str:
    return "planted" if track.is_scene_space else "with the pose"
