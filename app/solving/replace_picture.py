"""Replacing a layer's picture under its handles, keys and attachments."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.document import Layer, Pose, Target, Track, TrackKey, transfer_painted_stiffness
from app.solving.resolve_keys import KeyResolver, transfer_target
from engine.arrays import Complexes
from engine.domain import MeshedDomain
from engine.maps import HarmonicMap


def start_picture_replacement(before: Layer, made: Layer, canvas: tuple[int, int]) -> KeyResolver:
    """Return a resolver for a layer with another picture.

    `made` is a layer of the new picture, with its lower left corner at 0. A picture of the same
    size has the old one's place, and one of the canvas's size fills the canvas. Otherwise the
    centres of both shapes coincide. Handles and the anchor keep their places, or move to the
    nearest points of the new shape.
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
    """Return the lower left corner of the new picture, in whole pixels."""
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
    """Return the new places of handles and anchor, by their old places."""
    old = [handle.position for handle in before.handles]
    if before.anchor is not None and before.anchor not in old:
        old.append(before.anchor)
    points = np.array(old, dtype=np.complex128)
    pairs = zip(points.tolist(), domain.nearest(points).tolist(), strict=True)
    return dict(pairs)


def _replanted(before: Layer, track: Track, places: Mapping[complex, complex]) -> Track:
    """Return a track whose scene-space positions move with its handle."""
    place = before.handle(track.handles[0]).position
    if not track.is_scene_space or places[place] == place:
        return track

    def moved(key: TrackKey) -> TrackKey:
        shape = before.map_of(before.nearest_key(key.frame).pose)
        target = transfer_target(Target(position=key.place), shape, place, places[place])
        return replace(key, place=target.position)

    return replace(track, keys=tuple(map(moved, track.keys)))


def _at_rest(
    before: Layer, pose: Pose, domain: MeshedDomain, places: Mapping[complex, complex]
) -> Pose:
    """Return an undeformed pose over the new domain, with its targets moved as the handles are."""
    rest, shape = HarmonicMap.identity(domain.cage, domain.holes), before.map_of(pose)
    targets = {}
    for identity, target in pose.targets.items():
        place = before.handle(identity).position
        targets[identity] = transfer_target(target, shape, place, places[place])
    return replace(pose.with_map(rest), targets=targets)
