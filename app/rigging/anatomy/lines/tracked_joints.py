"""Joints of a body whose legs were followed along the lines of its drawing."""

from collections.abc import Mapping, Sequence

import numpy as np

from app.rigging.anatomy.legs import TrackedLeg, pair_legs
from app.rigging.motions.kinds import BodyKind
from engine.geometry import distance_to_segments

LEG = ("hip", "knee", "foot")
FRONT_LEG = ("shoulder", "elbow", "hand")
# A foot in a tail: the length of the tail over that of the leg, at least, and the foot's distance
# from the tail's middle in lengths of it, at most.
LONG_TAIL, IN_TAIL = 0.6, 0.1
# Of a leg's length: how far below its root two legs seem a tail, whose tip is so near to a foot.
LOW_TAIL, FOOT = 0.15, 0.6
# Of a leg's length: a joint of the trunk so near to the upper leg, so far below its root, is in the
# leg; it moves so far aside.
IN_LEG, BELOW_ROOT, BESIDE_LEG = 0.15, 0.05, 0.25
PELVIS = 0.22  # of a leg's length: height of the hips above the roots of both legs


def with_tracked_legs(
    joints: Mapping[str, complex], kind: BodyKind, legs: Sequence[TrackedLeg], facing: int
) -> dict[str, complex]:
    """Return the joints with these legs in place of those that the silhouette showed.

    `legs` are in order from the left. If their number does not fit the kind, the joints stay.
    """
    if kind.name == "four-legs":
        pairs = pair_legs(legs)
        if not pairs:
            return dict(joints)
        hind, front = pairs if facing > 0 else pairs[::-1]
        found = _placed(joints, {LEG: hind, FRONT_LEG: front}, facing)
        found["hips"] = _beside_legs(joints["hips"], hind, joints["chest"])
        found["chest"] = _beside_legs(joints["chest"], front, joints["hips"])
        return found
    if kind.is_side_view:
        joints = _without_low_tail(joints, legs)
    legs = [leg for leg in legs if not _is_tail(leg, joints)]
    if len(legs) != 2 or not kind.name.startswith("biped"):
        return dict(joints)
    found = _with_arms_apart(joints, legs)
    found = _placed(found, {LEG: legs}, facing if kind.is_side_view else 1)
    if kind.is_side_view:
        found = {name: at for name, at in found.items() if not _is_in_foot(name, at, legs)}
        roots = [leg.root for leg in legs]
        long = float(np.mean([abs(leg.root - leg.foot) for leg in legs]))
        found["hips"] = sum(roots) / len(roots) + 1j * PELVIS * long
    return found


def _beside_legs(place: complex, pair: Sequence[TrackedLeg], towards: complex) -> complex:
    """Return the place of a joint of the trunk, moved out of the upper leg that it lies in."""
    leg = max(pair, key=lambda each: each.root.imag)
    long = abs(leg.root - leg.foot)
    ends = np.array([leg.root]), np.array([leg.knee])
    away = float(distance_to_segments(np.array([place]), *ends).min())
    if away > IN_LEG * long or leg.root.imag - place.imag < BELOW_ROOT * long:
        return place
    return leg.root + BESIDE_LEG * long * float(np.sign((towards - leg.root).real))


def _without_low_tail(
    joints: Mapping[str, complex], legs: Sequence[TrackedLeg]
) -> Mapping[str, complex]:
    """Return joints without a tail that is two legs, which the silhouette joins."""
    tail = [name for name in joints if name.startswith("tail")]
    if len(legs) != 2 or not tail:
        return joints
    start, tip = joints[tail[0]], joints[tail[-1]]
    for leg in legs:
        long = abs(leg.root - leg.foot)
        if start.imag >= leg.root.imag - LOW_TAIL * long or abs(tip - leg.foot) > FOOT * long:
            return joints
    return {name: at for name, at in joints.items() if name not in tail}


def _is_tail(leg: TrackedLeg, joints: Mapping[str, complex]) -> bool:
    """Whether what seems a leg is part of a tail that leans on the ground."""
    tail = np.array([at for name, at in joints.items() if name.startswith("tail")])
    long = float(np.abs(np.diff(tail)).sum())
    if long < LONG_TAIL * abs(leg.root - leg.foot):
        return False
    away = distance_to_segments(np.array([leg.foot]), tail[:-1], tail[1:])
    return float(away.min()) <= IN_TAIL * long


def _is_in_foot(name: str, place: complex, legs: Sequence[TrackedLeg]) -> bool:
    """Whether a tail is a foot that the silhouette showed apart."""
    return name.startswith("tail") and place.imag <= max(leg.foot.imag for leg in legs)


def _placed(
    joints: Mapping[str, complex],
    pairs: Mapping[tuple[str, str, str], Sequence[TrackedLeg]],
    facing: int,
) -> dict[str, complex]:
    """Return the joints with pairs of legs, the leg ahead named L."""
    replaced = {name for names in pairs for name in names}
    found = {name: at for name, at in joints.items() if name.rpartition(".")[0] not in replaced}
    for names, pair in pairs.items():
        for side, leg in zip("LR", pair[::-1] if facing > 0 else pair, strict=False):
            found |= {f"{name}.{side}": at for name, at in zip(names, leg, strict=True)}
    return found


def _with_arms_apart(
    joints: Mapping[str, complex], legs: Sequence[TrackedLeg]
) -> dict[str, complex]:
    """Return the joints of a body on two legs, with a limb that is no leg as an arm."""
    found = dict(joints)
    highest = max(leg.root.imag for leg in legs)
    for side in "LR":
        foot = joints.get(f"foot.{side}")
        if foot is None or foot.imag <= highest:
            continue
        free = next((each for each in "LR" if f"hand.{each}" not in found), None)
        if free is not None:
            found |= {
                f"{arm}.{free}": joints[f"{leg}.{side}"]
                for arm, leg in zip(FRONT_LEG, LEG, strict=True)
                if f"{leg}.{side}" in joints
            }
    return found
