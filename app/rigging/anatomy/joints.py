"""Joints of a kind of body, found in a shape."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from app.rigging.anatomy.anatomy import bend_share, neck_along
from app.rigging.anatomy.body_plan import BodyPlan
from app.rigging.anatomy.chain import (
    ROOT,
    JointPath,
    find_arm,
    find_limb,
    find_tail,
    name_tail_joints,
    suggest_chain_joints,
)
from app.rigging.anatomy.legs import PlannedLeg, TrackedLeg
from app.rigging.motions.body import other_side
from app.rigging.motions.kinds import BodyKind
from engine.arrays import Complexes
from engine.geometry import contains

CROWN = 0.65  # radii above the middle of a head, off the face
# A head without a neck is the first node whose disc comes this near to the top, in heights.
BELOW_TOP = 0.08
THICK_TRUNK = 0.85  # of a lying trunk: thickness at its hips and its chest
# The chest is the last place where the trunk has this part of the hips' thickness, at most at this
# share of it.
THICK_HEAD = 0.5  # of a lying trunk: thickness of the head over the chest's
THICK_CHEST, HIGHEST_CHEST = 0.6, 0.75
LOWEST_ARM = 0.35  # share from hips to neck below which a limb is a tail
LEAST_NECK = 0.2  # share from chest to head: least distance of a neck from the chest
LEAST_TAIL = 0.12  # heights of the shape
APART = 0.5  # radii of the hips: least distance of the chest
CROTCH = 1.3  # radii of a leg from the crotch up to the hips


def suggest_joints(
    loops: Sequence[Complexes],
    kind: BodyKind,
    legs: Sequence[TrackedLeg] = (),
    *,
    has_arm_lines: bool = False,
) -> Mapping[str, complex]:
    """Suggest the joints of a kind of body in a shape.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the outlines of the holes; y up.
    legs : sequence of TrackedLeg
        Legs, from the left, that lines in the picture part.
    has_arm_lines : bool
        Whether lines in the picture part lowered arms from the trunk, so that they turn in their
        shoulders; else arms turn at the armpits.

    Returns
    -------
    mapping of str to complex
        Places inside the shape by the names of joints, in the kind's order, without limbs that were
        not found. From the front `.L` is the side on the right of the picture. From the side it
        means the legs ahead, or of four legs the outer ones.
    """
    plan = BodyPlan(loops, legs)
    if not kind.parents:
        return {}
    if "joint.1" in kind.parents:
        found = suggest_chain_joints(plan)
    elif kind.name == "four-legs":
        found = _lying(plan)
    else:
        is_frontal = kind.name == "biped-front"
        found = _standing(plan, is_frontal=is_frontal, has_arm_lines=has_arm_lines)
        if is_frontal and plan.has_half_a_pair:
            found |= _missing_limbs(found, plan.middle)
    places = np.array(list(found.values()), dtype=np.complex128)
    inside = contains(loops[0], places, holes=loops[1:])
    nodes = plan.places[plan.anatomy.kept]
    for at in np.flatnonzero(~inside):
        places[at] = nodes[np.abs(nodes - places[at]).argmin()]
    by_name = dict(zip(found, places.tolist(), strict=True))
    return {name: by_name[name] for name in kind.parents if name in by_name}


def _leg(plan: BodyPlan, start: int, leg: PlannedLeg) -> tuple[complex, complex, complex]:
    """Return the root, the joint and the tip of a leg.

    The leg turns where it leaves the fork, so that the legs of one drawing can pass each other.
    """
    return find_limb(plan, start, int(leg.path[-1]), leg.ankle)


def _head(plan: BodyPlan, way: JointPath, *, is_frontal: bool) -> tuple[dict[str, complex], int]:
    """Return the joints of head and neck, and the index of the node at which the trunk ends."""
    radii = way.radii
    at = neck_along(radii)
    if at is not None:
        blob = at + int(radii[at:].argmax())
        middle, radius = way.places[blob], radii[blob]
        outside = np.flatnonzero(np.abs(way.places[:blob] - middle) >= radius)
        neck = int(outside[-1]) if outside.size else at
        up = (middle - way.places[neck]) / abs(middle - way.places[neck])
        joints = {"neck": complex(way.places[neck]), "head": complex(middle + CROWN * radius * up)}
        return joints, neck
    tip = plan.handle_node(int(way.nodes[-1]))
    last = way.nodes.tolist().index(tip) if tip in way.nodes else len(way.nodes) - 1
    first = way.leaving(ROOT)
    if not is_frontal and last > first + 3:
        places, _, lengths = way.part(first, last)
        share = bend_share(places, lengths)
        if share is not None:
            neck = first + int(np.abs(lengths - share * lengths[-1]).argmin())
            joints = {"neck": complex(way.places[neck]), "head": complex(way.places[last])}
            return joints, neck
    if plan.is_lying:
        thick = np.flatnonzero(radii >= THICK_HEAD * radii[0])
        at = int(thick[-1]) if thick[-1] > first else last
        return {"head": complex(way.places[at])}, at
    tops = way.places.imag + radii
    at = int(np.flatnonzero(tops >= tops.max() - BELOW_TOP * plan.tall)[0])
    return {"head": complex(way.places[at] + 0.4j * radii[at])}, at


def _standing(
    plan: BodyPlan, *, is_frontal: bool, has_arm_lines: bool = False
) -> dict[str, complex]:
    """Return the joints of a body that stands on two legs."""
    hips, end = plan.hips, plan.head_end
    way = JointPath(plan, plan.between(hips, end) if end is not None else np.array([hips]))
    found, top = _head(plan, way, is_frontal=is_frontal)
    legs = plan.legs if len(plan.legs) < 2 else [plan.legs[0], plan.legs[-1]]
    found["hips"] = _hips(plan, hips, legs)
    limbs = [(hips, _leg(plan, hips, leg)) for leg in legs]
    found |= _sides(plan, limbs, ("hip", "knee", "foot"), is_frontal=is_frontal)
    find = find_arm if has_arm_lines else find_limb
    arms, tail = _arms_and_tail(plan, way, top, find, is_frontal=is_frontal)
    arms += [(hips, find_limb(plan, hips, int(leg.path[-1]), leg.ankle)) for leg in plan.legs[1:-1]]
    found |= _sides(plan, arms, ("shoulder", "elbow", "hand"), is_frontal=is_frontal)
    found |= name_tail_joints(tail)
    roots = [limb[0] for _, limb in arms]
    found["chest"] = _chest(way, top, found["hips"], roots)
    return _with_neck_apart(found)


def _sides(
    plan: BodyPlan,
    limbs: list[tuple[int, tuple[complex, complex, complex]]],
    names: tuple[str, str, str],
    *,
    is_frontal: bool,
) -> dict[str, complex]:
    """Return the joints of one pair of limbs, the longest found.

    From the front each side has its own limb. From the side the leg ahead goes with the arm behind.
    """

    def reach(limb: tuple[int, tuple[complex, complex, complex]]) -> float:
        _, (root, joint, tip) = limb
        return abs(joint - root) + abs(tip - joint)

    by_side: dict[str, tuple[complex, complex, complex]] = {}
    if is_frontal:
        for start, limb in sorted(limbs, key=reach):
            by_side["L" if limb[2].real >= plan.places[start].real else "R"] = limb
    else:
        longest = sorted(limbs, key=reach)[-2:]
        ahead = sorted(longest, key=lambda limb: -plan.facing * limb[1][2].real)
        order = "LR" if names[0] == "hip" else "RL"
        by_side = {side: limb for side, (_, limb) in zip(order, ahead, strict=False)}
    return {
        f"{name}.{side}": place
        for side, limb in by_side.items()
        for name, place in zip(names, limb, strict=True)
    }


def _missing_limbs(found: Mapping[str, complex], middle: float) -> dict[str, complex]:
    """Return limbs of one side only, as short legs may be, mirrored about an upright line."""
    return {
        other_side(name): 2 * middle - place.conjugate()
        for name, place in found.items()
        if other_side(name) not in found
    }


def _arms_and_tail(
    plan: BodyPlan,
    way: JointPath,
    top: int,
    find: Callable[[BodyPlan, int, int, int], tuple[complex, complex, complex]],
    *,
    is_frontal: bool,
) -> tuple[list[tuple[int, tuple[complex, complex, complex]]], list[complex]]:
    """Return the limbs that leave the trunk above, and the joints of the longest one below."""
    nodes, arms, tails = way.nodes.tolist(), [], []
    for end in plan.others:
        if end == plan.head_end:
            continue
        fork = plan.meeting(nodes[0], nodes[-1], end)
        at = nodes.index(fork)
        if at > top:
            continue
        limb = find(plan, fork, end, plan.handle_node(end))
        share = way.lengths[at] / max(way.lengths[top], 1e-9)
        root, _, tip = limb
        # On a short trunk all limbs leave at one place.
        is_level = (root - plan.places[fork]).imag >= -0.5 * plan.radii[fork]
        is_behind = (tip.real - plan.places[nodes[0]].real) * plan.facing < 0
        if share >= LOWEST_ARM or (is_level and (is_frontal or not is_behind)):
            arms.append((fork, limb))
        elif abs(tip - root) >= LEAST_TAIL * plan.tall:
            tails.append((abs(tip - root), find_tail(plan, fork, end)))
    return arms, max(tails, key=lambda tail: tail[0])[1] if tails else []


def _hips(plan: BodyPlan, node: int, legs: list[PlannedLeg]) -> complex:
    """Return the place of the hips, above the crotch."""
    place, radius = complex(plan.places[node]), float(plan.radii[node])
    if len(legs) < 2:
        return place
    roots = np.array([_leg(plan, node, leg)[0] for leg in legs])
    down = roots.mean() - place
    if abs(down) < 1e-9:
        return place
    thick = max(float(np.median(plan.radii[leg.path])) for leg in legs)
    above = min(radius, max(CROTCH * thick, APART * radius))
    return place + (radius - above) * complex(down / abs(down))


def _chest(way: JointPath, top: int, hips: complex, roots: list[complex]) -> complex:
    """Return the place of the chest: between the arms, or where the trunk is last thick."""
    trunk = slice(0, top + 1)
    places, radii, lengths = way.places[trunk], way.radii[trunk], way.lengths[trunk]
    if roots:
        at = int(np.abs(places - sum(roots) / len(roots)).argmin())
    else:
        thick = (radii >= THICK_CHEST * radii[0]) & (lengths <= HIGHEST_CHEST * lengths[-1])
        at = int(np.flatnonzero(thick)[-1])
    highest = int(np.flatnonzero(lengths <= HIGHEST_CHEST * lengths[-1])[-1])
    at = min(at, highest)
    while at < highest and abs(places[at] - hips) < APART * radii[0]:
        at += 1
    return complex(places[at])


def _with_neck_apart(found: dict[str, complex]) -> dict[str, complex]:
    """Return joints without a neck that is at the chest, or beyond the head."""
    if "neck" not in found:
        return found
    chest, neck, head = (found[name] for name in ("chest", "neck", "head"))
    if abs(neck - chest) >= LEAST_NECK * abs(head - chest):
        return found
    return {name: place for name, place in found.items() if name != "neck"}


def _in_trunk(plan: BodyPlan, fork: int) -> complex:
    """Return the place in a lying trunk above the fork of two legs, where the trunk is thick."""
    trunk = plan.trunk if int(plan.trunk[0]) == fork else plan.trunk[::-1]
    half = trunk[: max(len(trunk) // 2, 1)]
    thick = plan.radii[half] >= THICK_TRUNK * plan.radii[trunk].max()
    return complex(plan.places[half[int(thick.argmax())] if thick.any() else half[-1]])


def _lying(plan: BodyPlan) -> dict[str, complex]:
    """Return the joints of a body with legs below both ends of a lying trunk."""
    if len(plan.legs) < 2:
        return _standing(plan, is_frontal=False)
    found: dict[str, complex] = {}
    hind, front = (0, -1) if plan.facing > 0 else (-1, 0)
    hips, chest = int(plan.trunk[hind]), int(plan.trunk[front])
    for trunk_joint, start, pair, names in (
        ("hips", hips, plan.pairs[hind], ("hip", "knee", "foot")),
        ("chest", chest, plan.pairs[front], ("shoulder", "elbow", "hand")),
    ):
        found[trunk_joint] = _in_trunk(plan, start)
        # The outer legs are usually those on the near side.
        outer = pair if (start == hips) == (plan.facing > 0) else pair[::-1]
        for side, leg in zip("LR", (outer[0], outer[-1])[: len(outer)], strict=False):
            limb = _leg(plan, start, leg)
            found |= {f"{name}.{side}": place for name, place in zip(names, limb, strict=True)}
    ahead = [end for end in plan.others if plan.ahead(end)]
    behind = [end for end in plan.others if not plan.ahead(end)]
    if ahead:
        tip = max(ahead, key=lambda end: plan.facing * plan.places[end].real)
        found |= _head(plan, JointPath(plan, plan.between(chest, tip)), is_frontal=False)[0]
    if behind:
        tails = [find_tail(plan, hips, end) for end in behind]
        found |= name_tail_joints(max(tails, key=lambda tail: abs(tail[-1] - tail[0])))
    return _with_neck_apart(found)
