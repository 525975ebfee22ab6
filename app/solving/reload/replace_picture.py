"""Replacing a layer's picture under its handles, keys and attachments."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.document import Layer, Pose, Target, Track, TrackKey, transfer_painted_stiffness
from app.solving.reload.alignment import PlacedPicture, align_pictures
from app.solving.reload.shifting import shift_layer
from app.solving.resolve_keys import KeyResolver, transfer_target
from app.storage import Picture
from app.texts import _
from engine.arrays import Bytes
from engine.domain import MeshedDomain
from engine.maps import HarmonicMap

NOTED = 0.5  # pixels: a nearer handle has no notice


def start_picture_replacement(
    before: Layer, made: Layer, corner: complex, shift: complex = 0j
) -> KeyResolver:
    """Return a resolver for a layer with another picture.

    `made` is a layer of the new picture, with its lower left corner at 0, which goes to `corner` on
    the canvas. Handles, the anchor and poses move by `shift`. A handle or an anchor beside the new
    shape moves to the nearest point of the shape.
    """
    moved = shift_layer(before, shift)
    domain = made.domain.moved(corner)
    places = _places(moved, domain)
    handles = tuple(replace(handle, position=places[handle.position]) for handle in moved.handles)
    into = moved.without_footage().with_poses(
        (_at_rest(moved, pose, domain, places) for pose in moved.poses),
        picture=made.picture,
        corner=corner,
        cut_out=made.cut_out,
        is_stale=False,
        domain=domain,
        stiffness=transfer_painted_stiffness(moved.stiffness, moved.domain, domain),
        handles=handles,
        tracks=tuple(_replanted(moved, track, places) for track in moved.tracks),
        anchor=None if moved.anchor is None else places[moved.anchor],
        unknown={
            name: value
            for name, value in before.unknown.items()
            if name not in {"picture", "domain"}
        },
    )
    return KeyResolver(before=moved, bounds=before.bounds, new_layer=into, replaces_picture=True)


def find_new_corner(
    before: Layer, picture: Picture, canvas: tuple[int, int], old: Bytes
) -> complex:
    """Return the lower left corner on the canvas of another picture of a layer.

    A picture of the same size has the old one's place, and one of the canvas's size fills the
    canvas. Otherwise the parts coincide that the picture shares with the `old` one (h, w, 4), or
    the centres of what is drawn if they share too little.
    """
    if picture.size == before.picture.size:
        return before.corner
    if picture.size == canvas:
        return 0j
    placed = PlacedPicture(old, before.corner)
    aligned = align_pictures(placed, picture.rgba)
    if aligned is not None:
        return aligned.corner
    by = _middle(placed.content) - _middle(PlacedPicture(picture.rgba, 0j).content)
    return complex(round(by.real), round(by.imag))


def _middle(content: PlacedPicture) -> complex:
    return content.corner + complex(*content.size) / 2


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


def distance_notices(resolver: KeyResolver) -> tuple[str, ...]:
    """Return notices about handles and an anchor that had to move onto the new shape."""
    before, after = resolver.before, resolver.new_layer
    if after is None:
        return ()
    pairs = [
        (_("the handle {name}").format(name=one.name), one.position, other.position)
        for one, other in zip(before.handles, after.handles, strict=True)
    ]
    if before.anchor is not None and after.anchor is not None:
        pairs.append((_("the anchor"), before.anchor, after.anchor))
    text = _("{point} was beside the new shape and moved by {distance:.0f} pixels onto it")
    return tuple(
        text.format(point=point, distance=abs(to - place))
        for point, place, to in pairs
        if abs(to - place) > NOTED
    )
