"""The kind and the joints of a layer, guessed from its shape and its picture."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from app.cut_out import build_picture_domain, subject_mask, texture
from app.document import Layer
from app.rigging import (
    Body,
    BodyKind,
    NearLimb,
    bend_straight_legs,
    find_kind,
    find_near_arm,
    guess_facing,
    guess_kind,
    guess_near_limbs,
    move_off_arm,
    name_near_limbs,
    near_side,
    suggest_joints,
    track_legs,
    with_near_arm,
    with_shoulders,
    with_tracked_legs,
)
from engine.arrays import Bytes, Complexes
from engine.geometry import diameter

FEWEST_TRIANGLES = 1_000  # of a domain of which only the outline is used
APART = 0.01  # of the drawing's diameter: joints that would meet are moved this far apart


class JointGuess(NamedTuple):
    """Joints of a kind of body by name, at rest.

    `unsure` are the ends of the near limbs of pairs of which either limb may be the near one.
    """

    joints: Mapping[str, complex]
    unsure: tuple[str, ...] = ()


def guess_layer_kind(layer: Layer, rgba: Bytes | None) -> BodyKind:
    """Return the kind of body that a layer looks like."""
    loops = _find_loops(layer, rgba)
    return guess_kind(loops, () if rgba is None else track_legs(loops, rgba, layer.corner))


def guess_joints(layer: Layer, kind: str, rgba: Bytes | None) -> JointGuess:
    """Return the joints of a kind of body in a layer: by the outline, and lines in the picture."""
    body, loops = find_kind(kind), _find_loops(layer, rgba)
    if rgba is None or "foot.L" not in body.parents:
        return JointGuess(suggest_joints(loops, body))
    legs = track_legs(loops, rgba, layer.corner)
    joints = suggest_joints(loops, body, legs)
    joints = with_shoulders(joints, body, loops, rgba, layer.corner)
    facing = guess_facing(body, joints, loops[0])
    tracked = with_tracked_legs(joints, body, legs, facing)
    places = layer.domain.nearest(_place_apart(layer, np.array([*tracked.values()]))).tolist()
    joints = dict(zip(tracked, places, strict=True))
    found: tuple[NearLimb, ...] = ()
    if body.is_side_view:
        facing = guess_facing(body, joints, loops[0])
        found = guess_near_limbs(loops, joints, rgba, layer.corner)
        joints = name_near_limbs(joints, found, facing)
        arm = None
        if body.name == "biped-side":
            shown = texture(rgba, subject_mask(rgba, layer.cut_out))
            arm = find_near_arm(loops, joints, facing, shown, layer.corner)
        if arm is not None:
            joints = with_near_arm(joints, arm, facing)
            joints = move_off_arm(joints, arm, loops, near_side(facing))
            found = tuple(limb for limb in found if not limb.near.startswith("hand"))
        joints = _with_bent_legs(layer, body, joints, facing)
    unsure = (limb.near.rpartition(".")[0] for limb in found if not limb.is_sure)
    ordered = {name: joints[name] for name in body.parents if name in joints}
    return JointGuess(ordered, tuple(f"{end}.{near_side(facing)}" for end in unsure))


def _find_loops(layer: Layer, rgba: Bytes | None) -> tuple[Complexes, ...]:
    """Return the loops of a layer without the slits that part limbs, which its picture shows."""
    lines = tuple(line for line in layer.cut_out.cut_lines if line.covered == "none")
    if rgba is None or len(lines) == len(layer.cut_out.cut_lines):
        return layer.domain.loops
    domain, _ = build_picture_domain(
        rgba,
        triangles=FEWEST_TRIANGLES,
        detail=layer.meshing.detail,
        cut_out=replace(layer.cut_out, cut_lines=lines),
    )
    return domain.moved(layer.corner).loops


def _with_bent_legs(
    layer: Layer, kind: BodyKind, joints: Mapping[str, complex], facing: int
) -> dict[str, complex]:
    """Return the joints with straight legs bent a little to their usual sides, on the drawing."""
    outline = layer.domain.outline
    box = (
        complex(outline.real.min(), outline.imag.min()),
        complex(outline.real.max(), outline.imag.max()),
    )
    bent = bend_straight_legs(Body(kind=kind, joints=joints, box=box, facing=facing))
    inside = layer.domain.contains(np.array([*bent.values()])).tolist()
    pairs = zip(bent.items(), inside, strict=True)
    return {name: place if is_inside else joints[name] for (name, place), is_inside in pairs}


def _place_apart(layer: Layer, places: Complexes) -> Complexes:
    """Return places of joints, those at one place beside each other: no two handles may meet."""
    step = APART * diameter(layer.domain.outline)
    moved = places.copy()
    for index in range(1, len(moved)):
        while np.abs(moved[:index] - moved[index]).min() < step / 2:
            moved[index] += step
    return moved
