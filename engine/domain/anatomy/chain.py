"""What is a chain, and its joints along the longest way through it."""

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.domain.anatomy.body_plan import BodyPlan

# So many times as long as it is wide a shape is a chain, and a fish where it has a fin at its end.
LONG, LONG_FISH = 3.4, 1.7
FIN = 0.4  # parts of the way along a fish that its fin takes at most
ALIKE = 2.0  # times by which the two tips of a fin are as long as each other
# Parts of a shape's area that are along one path.
ALONG = 0.75
# From joint to joint it is so many times as far as the shape is thick, if there are enough of them.
SPACING = 0.9
FEWEST, USUAL, MOST = 4, 7, 16
TURN = 0.8  # radians by which it turns from joint to joint at most, if that many suffice
# An end is the head where it is so many times as thick as the other one.
THICKER = 1.15
ENDS = 0.15  # parts of the way that are its ends
WINDOW = 8  # nodes over which it has a direction


def suggest_chain_joints(plan: BodyPlan) -> dict[str, complex]:
    """Return joints from the end that leads, or by which it hangs, to the other."""
    way = plan.longest()
    nodes = way.tolist()
    first, last = (
        nodes.index(tip) for tip in (plan.handle_node(nodes[0]), plan.handle_node(nodes[-1]))
    )
    fin = find_fin(plan, way)
    if fin is not None:
        # A fin has two tips; the chain ends where it begins.
        at = nodes.index(fin)
        first, last = (at, last) if at < len(nodes) / 2 else (first, at)
    places, radii = plan.places[way[first : last + 1]], plan.radii[way[first : last + 1]]
    lengths = np.append(0.0, np.cumsum(np.abs(np.diff(places))))
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


def _count(places: Complexes, radii: Floats, lengths: Floats) -> int:
    """Return how many joints a chain has: more where it is long and thin, or turns a lot."""
    usual = 1 + round(float(lengths[-1]) / (SPACING * 2 * float(np.median(radii))))
    steps = places[WINDOW:] - places[:-WINDOW]
    turning = float(np.abs(np.diff(np.unwrap(np.angle(steps)))).sum())
    return min(MOST, max(min(max(usual, FEWEST), USUAL), 2 + round(turning / TURN)))


def _ends_with_its_head(places: Complexes, radii: Floats, lengths: Floats) -> bool:
    """Tell whether the last end is the thicker one; of two alike, the upper or the right one."""
    starts = float(radii[lengths <= ENDS * lengths[-1]].mean())
    ends = float(radii[lengths >= (1 - ENDS) * lengths[-1]].mean())
    if max(starts, ends) >= THICKER * min(starts, ends):
        return ends > starts
    along = complex(places[-1] - places[0])
    return (along.imag if abs(along.imag) > abs(along.real) else along.real) > 0


def is_chain(plan: BodyPlan) -> bool:
    """Tell whether all of it is along one path that is long, or has the stalk of a fish."""
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
    """Return the node of a way at which a fin of two tips begins, None without one."""
    on_way, whole = way.tolist(), plan.length(way)
    for end in set(plan.anatomy.branches) - {on_way[0], on_way[-1]}:
        fork = plan.meeting(on_way[0], on_way[-1], end)
        at = on_way.index(fork)
        own = plan.length(plan.between(fork, end))
        rest = min(plan.length(way[: at + 1]), plan.length(way[at:]))
        if rest <= FIN * whole and 1 / ALIKE <= own / max(rest, 1e-9) <= ALIKE:
            return fork
    return None
