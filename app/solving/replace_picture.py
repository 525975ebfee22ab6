"""Another picture under the same handles, keys and joints."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.document import Layer, Pose, Target, Track, TrackKey, transfer_painted_stiffness
from app.solving.resolve_keys import KeyResolver, transfer_target
from engine.arrays import Complexes
from engine.domain import MeshedDomain
from engine.maps import HarmonicMap


def start_picture_replacement(before: Layer, made: Layer, canvas: tuple[int, int]) -> KeyResolver:
    """Return a layer on its way to another picture.

    A picture of the same size lies where the old one did, and one of the canvas's size fills it;
    else the middle of the new shape comes where that of the old one was. Handles and the anchor
    stay where they are, or come to the nearest places of the new shape.

    Parameters
    ----------
    before : Layer
    made : Layer
        The new picture, its lower left corner at 0, as a layer of its own.
    canvas : tuple of int
        Width and height of the scene.
    """
    corner = _corner(before, made, canvas)
    domain = made.domain.moved(corner)
    places = _places(before, domain)
    handles = tuple(replace(handle, position=places[handle.position]) for handle in before.handles)
    into = before.with_poses(
        (_at_rest(before, pose, domain, places) for pose in before.poses),
        picture=made.picture,
        corner=corner,
        cut_out=made.cut_out,
        is_stale=False,
        domain=domain,
        stiffness=transfer_painted_stiffness(before.stiffness, before.domain, domain),
        handles=handles,
        tracks=tuple(_replanted(before, track, places) for track in before.tracks),
        anchor=None if before.anchor is None else places[before.anchor],
        unknown={
            name: value
            for name, value in before.unknown.items()
            if name not in {"picture", "domain"}
        },
    )
    return KeyResolver(before=before, bounds=before.bounds, new_layer=into, replaces_picture=True)


def _corner(before: Layer, made: Layer, canvas: tuple[int, int]) -> complex:
    """Return where the lower left corner of the new picture comes, in whole pixels."""
    if made.picture.size == before.picture.size:
        return before.corner
    if made.picture.size == canvas:
        return 0j
    by = _middle(before.domain.outline) - _middle(made.domain.outline)
    return complex(round(by.real), round(by.imag))


def _middle(outline: Complexes) -> complex:
    x, y = outline.real, outline.imag
    return complex(x.min() + x.max(), y.min() + y.max()) / 2


def _places(before: Layer, domain: MeshedDomain) -> Mapping[complex, complex]:
    """Return where handles and the anchor come, by where they were."""
    old = [handle.position for handle in before.handles]
    if before.anchor is not None and before.anchor not in old:
        old.append(before.anchor)
    points = np.array(old, dtype=np.complex128)
    pairs = zip(points.tolist(), domain.nearest(points).tolist(), strict=True)
    return dict(pairs)


def _replanted(before: Layer, track: Track, places: Mapping[complex, complex]) -> Track:
    """Return a track whose places in the picture are moved as its handle is."""
    place = before.handle(track.handles[0]).position
    if not track.is_scene_space or places[place] == place:
        return track

    def moved(key: TrackKey) -> TrackKey:
        shape = before.map_of(before.nearest_key(key.frame).pose)
        wished = transfer_target(Target(position=key.place), shape, place, places[place])
        return replace(key, place=wished.position)

    return replace(track, keys=tuple(map(moved, track.keys)))


def _at_rest(
    before: Layer, pose: Pose, domain: MeshedDomain, places: Mapping[complex, complex]
) -> Pose:
    """Return a pose over the new domain, at rest, with its wishes moved as the handles are."""
    rest, shape = HarmonicMap.identity(domain.cage, domain.holes), before.map_of(pose)
    targets = {}
    for identity, target in pose.targets.items():
        place = before.handle(identity).position
        targets[identity] = transfer_target(target, shape, place, places[place])
    return replace(pose.with_map(rest), targets=targets)
