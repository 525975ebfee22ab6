"""Updates of tracks, springs and bones after handles change."""

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from app.document.channels.tracks import Track, TrackKey
from app.document.layer import Layer
from app.document.rig.mirror_names import SidePairs, mirrored_handles


def without_handles(layer: Layer, gone: Collection[int]) -> Layer:
    """Return the layer without tracks, springs and bones of deleted handles."""
    tracks = (track_without_handles(layer, track, gone) for track in layer.tracks)
    springs = (
        replace(spring, root=None) if spring.root in gone else spring
        for spring in layer.springs
        if spring.handle not in gone
    )
    bones = (bone for bone in layer.bones if not set(bone.ends) & set(gone))
    return replace(
        layer,
        tracks=tuple(filter(None, tracks)),
        springs=tuple(springs),
        bones=tuple(bones),
    )


def with_moved_handle(layer: Layer, identity: int, position: complex) -> Layer:
    """Return the layer with scene-space tracks adjusted to a handle's new position."""
    old = layer.handle(identity).position
    tracks = (
        _rebased_track(layer, track, old, position) if track.handles[0] == identity else track
        for track in layer.tracks
    )
    return replace(layer, tracks=tuple(tracks))


def mirrored_track(layer: Layer, track: Track, pairs: SidePairs) -> Track:
    """Return a track mirrored at the layer's axis, for the partners of its handles."""
    axis = layer.axis
    partners = mirrored_handles(layer.handles, axis, layer.domain.outline, pairs)
    # Handles that lie close together may have the same partner.
    handles = tuple(dict.fromkeys(partners.get(handle, handle) for handle in track.handles))
    old, new = (layer.handle(each[0]).position for each in (track.handles, handles))
    # A drawing is rarely symmetric: the offset of the partner from the mirror image of the handle.
    beside = new - _reflected(old, axis)
    keys = (
        replace(
            key,
            place=_reflected(key.place, axis) + beside
            if track.is_scene_space
            else _reflected(key.place, 0.0),
            turn=0.0 - key.turn,
            velocity=None if key.velocity is None else _reflected(key.velocity, 0.0),
        )
        for key in track.keys
    )
    return replace(track, handles=handles, keys=tuple(keys))


def _reflected(place: complex, axis: float) -> complex:
    return complex(2 * axis - place.real, place.imag)


def track_without_handles(layer: Layer, track: Track, gone: Collection[int]) -> Track | None:
    """Return a track without some handles; None if no handle is left."""
    handles = tuple(handle for handle in track.handles if handle not in gone)
    return track_for_handles(layer, track, handles) if handles else None


def track_for_handles(layer: Layer, track: Track, handles: tuple[int, ...]) -> Track:
    """Return a track with the same displacements for other handles."""
    changed = replace(track, handles=handles)
    old, new = (layer.handle(each.handles[0]).position for each in (track, changed))
    return _rebased_track(layer, changed, old, new)


def _rebased_track(layer: Layer, track: Track, old: complex, new: complex) -> Track:
    """Return a track of one point of the drawing, moved to another point.

    The positions of a scene-space track shift by the distance of the two points in the pose of the
    layer's nearest key. Displacements in pose space stay the same.
    """
    if not track.is_scene_space or old == new:
        return track

    def moved(key: TrackKey) -> TrackKey:
        shape = layer.map_of(layer.nearest_key(key.frame).pose)
        before, after = shape(np.array([old, new])).tolist()
        return replace(key, place=key.place + after - before)

    return replace(track, keys=tuple(map(moved, track.keys)))
