"""Recognition of chains and tails; joints along the paths of chains, tails and limbs."""

from collections.abc import Sequence

import numpy as np

from app.rigging.anatomy.anatomy import joint_share
from app.rigging.anatomy.body_plan import BodyPlan
from engine.arrays import Complexes, Floats, Indices, as_points
from engine.geometry import arc_lengths, contains

# Length over width of a chain, and of a fish with a fin at its end.
LONG, LONG_FISH = 3.4, 1.7
FIN = 0.4  # largest share of a fish's length taken by its fin
ALIKE = 2.0  # largest ratio of the lengths of a fin's two tips
# Share of a shape's area along one path.
ALONG = 0.75
# Distance between joints over the thickness of the shape, if that gives enough joints.
SPACING = 0.9
FEWEST, USUAL, MOST = 4, 7, 16
TURN = 0.8  # largest angle in radians from joint to joint, if that many joints suffice
# The head is the end that is this many times as thick as the other.
THICKER = 1.15
# Radii of a body around the thickest place from which a tail leaves it, to the tail's base.
TAIL_BASE = 1.05
TAIL_BONE, MOST_TAIL_BONES = 1.1, 4  # length of its bones in thicknesses, and their number
ENDS = 0.15  # share of the length at each end
WINDOW = 8  # nodes over which a direction is measured
# Distance of a limb's root from the node it leaves, in radii of the node.
ROOT = 0.8
# An arm leaves the trunk where it is this many times as thick as in its middle. Its shoulder is
# this many of its radii below the outline, and as many inwards of the armpit.
LEAVING, SHOULDER, INWARDS = 1.2, 1.1, 0.3


class JointPath:
    """Nodes in order, and their distances along the path."""

    def __init__(self, plan: BodyPlan, nodes: Indices) -> None:
        self.nodes = nodes
        self.places, self.radii = plan.places[nodes], plan.radii[nodes]
        self.lengths = arc_lengths(self.places)

    def leaving(self, radii: float) -> int:
        """Return the index of the node at which the path leaves the disc around its first one."""
        inside = np.abs(self.places - self.places[0]) <= radii * self.radii[0]
        return min(int(np.flatnonzero(inside)[-1]) + 1, len(self.nodes) - 1)

    def part(self, first: int, last: int) -> tuple[Complexes, Floats, Floats]:
        """Return places, radii and lengths from one node to another."""
        last = max(last, first + 1)
        lengths = self.lengths[first : last + 1]
        return self.places[first : last + 1], self.radii[first : last + 1], lengths - lengths[0]

    def bent(self, first: int, last: int) -> complex:
        """Return the joint of a limb between two nodes."""
        places, radii, lengths = self.part(first, last)
        return complex(places[0]) if len(places) < 3 else _find_bend(places, radii, lengths)


def find_limb(plan: BodyPlan, start: int, end: int, tip: int) -> tuple[complex, complex, complex]:
    """Return the root, the joint and the tip of a limb that leaves the body at a node."""
    way = JointPath(plan, plan.between(start, end))
    root = way.leaving(ROOT)
    nodes = way.nodes.tolist()
    last = nodes.index(tip) if tip in nodes else len(nodes) - 1
    root = min(root, max(last - 2, 0))
    return complex(way.places[root]), way.bent(root, last), complex(way.places[last])


def find_arm(plan: BodyPlan, start: int, end: int, tip: int) -> tuple[complex, complex, complex]:
    """Return the shoulder, the elbow and the hand of an arm that leaves the body at a node.

    The middle line of a lowered arm leaves the trunk at the armpit. The shoulder lies above it, in
    the direction of the upper arm.
    """
    root, elbow, hand = find_limb(plan, start, end, tip)
    way = JointPath(plan, plan.between(start, end))
    outer = slice(int(np.abs(way.places - root).argmin()), int(np.abs(way.places - hand).argmin()))
    thick = float(np.median(way.radii[outer])) if outer.start < outer.stop else 0.0
    is_thin = np.flatnonzero(way.radii[outer] <= LEAVING * thick)
    if not is_thin.size:
        return root, elbow, hand
    leaving = outer.start + int(is_thin[0])
    place, radius = complex(way.places[leaving]), float(way.radii[leaving])
    if place == elbow:
        return root, elbow, hand
    up = (place - elbow) / abs(place - elbow)
    inwards = 1 if (plan.places[start] - elbow).real > 0 else -1
    armpit = place - 1j * inwards * radius * up
    across = inwards * (armpit - place).real + INWARDS * thick
    steps = np.linspace(0.0, plan.tall, 400)
    inside = contains(
        plan.loops[0], as_points(place + steps * up, "The joints of a body"), holes=plan.loops[1:]
    )
    below = steps[max(int((~inside).argmax()) - 1, 0)] - SHOULDER * thick
    # A level arm turns at its armpit, a lowered one below the outline of the shoulder.
    ahead = min(below, across / max(inwards * up.real, 1e-9))
    if ahead <= 0:
        return root, elbow, hand
    shoulder = place + ahead * up
    places = np.append(shoulder, way.places[leaving : outer.stop + 1])
    radii = np.append(radius, way.radii[leaving : outer.stop + 1])
    lengths = arc_lengths(places)
    return shoulder, _find_bend(places, radii, lengths), hand


def _find_bend(places: Complexes, radii: Floats, lengths: Floats) -> complex:
    """Return the joint of a limb along its middle line."""
    share = joint_share(places, radii, lengths)
    return complex(places[np.abs(lengths - share * lengths[-1]).argmin()])


def suggest_chain_joints(plan: BodyPlan) -> dict[str, complex]:
    """Return the joints of a chain, from its leading or fixed end to the other."""
    way = plan.longest()
    nodes = way.tolist()
    first, last = (
        nodes.index(tip) for tip in (plan.handle_node(nodes[0]), plan.handle_node(nodes[-1]))
    )
    fin = find_fin(plan, way)
    if fin is not None:
        # A fin has two tips; the chain ends where the fin begins.
        at = nodes.index(fin)
        first, last = (at, last) if at < len(nodes) / 2 else (first, at)
    places, radii = plan.places[way[first : last + 1]], plan.radii[way[first : last + 1]]
    lengths = arc_lengths(places)
    shares = np.linspace(0, 1, _count(places, radii, lengths))
    is_reversed = _ends_with_its_head(places, radii, lengths)
    if fin is not None:
        is_reversed = fin == nodes[first]
    if is_reversed:
        shares = shares[::-1]
    at_joints = np.interp(shares * lengths[-1], lengths, np.arange(len(places)))
    return {
        f"joint.{number}": complex(places[round(at)])
        for number, at in enumerate(at_joints.tolist(), 1)
    }


def find_tail(plan: BodyPlan, start: int, end: int) -> list[complex]:
    """Return the joints of a tail that leaves the body at a node, from its base to its tip.

    A long, thin tail has more joints.
    """
    way = plan.between(start, end)
    nodes, tip = way.tolist(), plan.handle_node(end)
    places, radii = plan.places[way], plan.radii[way]
    last = nodes.index(tip) if tip in nodes else len(nodes) - 1
    thick = int(radii.argmax())
    within = np.abs(places - places[thick]) <= TAIL_BASE * radii[thick]
    first = min(int(np.flatnonzero(within)[-1]) + 1, max(last - 1, 0))
    places, radii = places[first : last + 1], radii[first : last + 1]
    lengths = arc_lengths(places)
    bones = round(float(lengths[-1]) / (TAIL_BONE * 2 * float(np.median(radii))))
    shares = np.linspace(0.0, 1.0, 1 + min(max(bones, 1), MOST_TAIL_BONES)) * lengths[-1]
    return [complex(places[np.abs(lengths - share).argmin()]) for share in shares]


def name_tail_joints(tail: Sequence[complex]) -> dict[str, complex]:
    """Return the joints of a tail by name."""
    if not tail:
        return {}
    numbered = {f"tail.{number}": at for number, at in enumerate(tail[:-1], 1)}
    return {**numbered, "tail": tail[-1]}


def _count(places: Complexes, radii: Floats, lengths: Floats) -> int:
    """Return the number of joints: more for a long, thin or strongly curved chain."""
    usual = 1 + round(float(lengths[-1]) / (SPACING * 2 * float(np.median(radii))))
    steps = places[WINDOW:] - places[:-WINDOW]
    turning = float(np.abs(np.diff(np.unwrap(np.angle(steps)))).sum())
    return min(MOST, max(min(max(usual, FEWEST), USUAL), 2 + round(turning / TURN)))


def _ends_with_its_head(places: Complexes, radii: Floats, lengths: Floats) -> bool:
    """Whether the last end is the thicker one; of equal ends, the upper or the right one."""
    starts = float(radii[lengths <= ENDS * lengths[-1]].mean())
    ends = float(radii[lengths >= (1 - ENDS) * lengths[-1]].mean())
    if max(starts, ends) >= THICKER * min(starts, ends):
        return ends > starts
    along = complex(places[-1] - places[0])
    return (along.imag if abs(along.imag) > abs(along.real) else along.real) > 0


def is_chain(plan: BodyPlan) -> bool:
    """Whether the whole shape lies along one path that is long, or has the stalk of a fish."""
    if len(plan.anatomy.branches) < 2 or plan.anatomy.holes:
        return False
    way = plan.longest()
    steps = np.abs(np.diff(plan.places[way]))
    radii = plan.radii[way]
    along = float((steps * (radii[1:] + radii[:-1])).sum())
    outline = plan.loops[0]
    area = float((outline.conj() * np.roll(outline, -1)).imag.sum()) / 2
    if along < ALONG * area:
        return False
    length = float(steps.sum()) / (2 * float(radii.max()))
    is_fish = plan.wide > plan.tall and length >= LONG_FISH and find_fin(plan, way) is not None
    return length >= LONG or is_fish


def find_fin(plan: BodyPlan, way: Indices) -> int | None:
    """Return the node of a path at which a fin of two tips begins, None without one."""
    on_way, whole = way.tolist(), plan.length(way)
    for end in set(plan.anatomy.branches) - {on_way[0], on_way[-1]}:
        fork = plan.meeting(on_way[0], on_way[-1], end)
        at = on_way.index(fork)
        own = plan.length(plan.between(fork, end))
        rest = min(plan.length(way[: at + 1]), plan.length(way[at:]))
        if rest <= FIN * whole and 1 / ALIKE <= own / max(rest, 1e-9) <= ALIKE:
            return fork
    return None
