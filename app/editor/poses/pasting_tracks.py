"""Pasting track keys: onto the selected track or, together with poses, by names."""

from collections.abc import Mapping
from dataclasses import replace

from app.document import (
    channel_commands,
    track_channel,
    track_commands,
)
from app.editor.parts.clipboard import CopiedTrack
from app.editor.poses.paste_destinations import PasteDestination, PasteMode, find_paste_destinations
from app.editor.project import Project
from app.editor.session import Session
from app.texts import _


def pasteable_tracks(
    session: Session, project: Project, way: PasteMode
) -> Mapping[tuple[int, int], CopiedTrack]:
    """Return the copied keys of each track, by the layer and the handle that can take them.

    Keys of a single track go to the selected track. Otherwise they go with the poses, by names.
    """
    copied, chosen = session.clipboard.tracks, project.selected_track
    if way == "as it is" and len(copied) == 1 and chosen is not None:
        return {(project.selection.active, chosen): copied[0]}
    carried = {}
    for landing in find_paste_destinations(session, project, way):
        ours = {other: identity for identity, other in landing.pairs.items()}
        for each in copied:
            handles = tuple(ours[each_id] for each_id in each.track.handles if each_id in ours)
            if each.layer.id == landing.copied.layer.id and each.track.handles[0] in ours:
                track = _transferred_track(landing, each, way, handles)
                carried[landing.layer.id, handles[0]] = track
    return carried


def _transferred_track(
    landing: PasteDestination, copied: CopiedTrack, way: PasteMode, handles: tuple[int, ...]
) -> CopiedTrack:
    """Return a copied track for other handles of a layer."""
    similarity = landing.pose_transfer(way).similarity
    old = landing.copied.layer.handle(copied.track.handles[0]).position
    new = landing.layer.handle(handles[0]).position
    # Keys relative to the pose are offsets. Keys in the scene are places, with the handle's offset.
    start = (
        -similarity.shift
        if not copied.track.is_scene_space
        else new - similarity.apply_to_point(old)
    )
    keys = tuple(
        replace(
            key,
            place=similarity.apply_to_point(key.place) + start,
            turn=-key.turn if similarity.mirrors else key.turn,
            velocity=None
            if key.velocity is None
            else similarity.apply_to_point(key.velocity) - similarity.shift,
        )
        for key in copied.keys
    )
    if landing.is_direct(way):
        keys = copied.keys
    return replace(copied, track=replace(copied.track, handles=handles), keys=keys)


def paste_track(
    session: Session,
    project: Project,
    onto: tuple[int, int],
    copied: CopiedTrack,
    by: int,
    gesture: object,
) -> None:
    """Paste track keys on a layer's handle, `by` frames later, and select them."""
    identity, handle = onto
    layer = project.document.layer(identity)
    track, name = layer.track_of(handle), layer.handle(handle).name
    if track is not None and track.is_scene_space != copied.track.is_scene_space:
        if copied.track.is_scene_space:
            text = _(
                "The copied keys are planted, but the keys of {handle} go with the pose. "
                "Choose the same for both in the Handle tab, then copy again."
            )
        else:
            text = _(
                "The copied keys go with the pose, but the keys of {handle} are planted. "
                "Choose the same for both in the Handle tab, then copy again."
            )
        session.notices.show(text.format(handle=name))
        return
    by += copied.track.delay - (0 if track is None else track.delay)
    keys = tuple(replace(key, frame=key.frame + by) for key in copied.keys)
    if keys[0].frame < 0:
        text = _(
            "The delay of {handle}'s track is too long for a key at this frame. Shorten the delay."
        )
        session.notices.show(text.format(handle=name))
        return
    if track is None:
        handles = copied.track.handles if copied.track.handles[0] == handle else (handle,)
        track = replace(copied.track, handles=handles, keys=keys)
        command = track_commands.put_track(identity, track)
    else:
        command = channel_commands.insert_keys({track_channel(identity, track): keys})
    project.history.do(command, gesture=gesture)
    frames = frozenset(key.frame for key in keys)
    project.selection.select_keys(
        {**project.selection.keys, track_channel(identity, track): frames}
    )
