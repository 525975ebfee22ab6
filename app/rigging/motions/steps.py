"""Steps: the position of a foot over a cycle, and the bend of its leg."""

import cmath
import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

from app.rigging.motions.body import Body, other_side, without_side
from app.rigging.motions.curves import bump, hermite
from app.rigging.motions.kinds import near_side
from app.rigging.motions.timing import SAME_PHASE, Timing

# A leg drawn with at least this bend keeps its side; a straighter leg bends as usual for its kind.
BENT = 0.21  # radians
# Smaller steps: by this factor each time, lower down to one share before they are shorter down to
# another.
SMALLER, LOWEST_STEP, SMALLEST = 0.92, 0.6, 0.3
ASIDE = 0.01  # of a leg's length: the least distance of a knee from its straight line


@dataclass(frozen=True, slots=True, kw_only=True)
class Gait:
    """Pattern of steps: each foot stands for a share of the cycle, then it swings ahead."""

    stance: float  # share of the cycle that a foot stands
    stride: float  # distance that the body moves in a cycle, in lengths of a leg
    # Phase at which each foot comes down.
    landings: tuple[tuple[str, float], ...]
    lift: float = 0.0  # height of a foot in the middle of its swing, in lengths of a leg
    gathered: float = 0.2  # share by which feet move from their drawn places to below the hips
    # Of a leg's length: its largest reach, short of straight, so that the knee does not snap.
    straight: float = 0.985
    is_treadmill: bool = True  # whether, in place, feet slide back on the ground as on a treadmill
    roll: float = 0.0  # degrees by which a foot points down when it leaves the ground
    # Of a leg's length, by which it is shorter where it is folded most. A leg that folds swings
    # about its root, as in a run, so that its foot goes along with a body in the air.
    fold: float = 0.0
    crest: float = 0.5  # share of its swing after which a leg is folded most
    # Share of the ground's speed at which a foot leaves the ground, and comes down.
    follow: float = 1.0
    behind: float = 0.0  # share of a step by which the middle of a stance is behind the leg's root

    def smaller(self, share: float) -> "Gait":
        """Return the gait with a share of its steps."""
        return replace(
            self, stride=share * self.stride, lift=share * self.lift, fold=share * self.fold
        )

    def smaller_gaits(self) -> Iterator["Gait"]:
        """Yield the gait with smaller and smaller steps: first they are lower, then shorter too."""
        lower, low = self, 1.0
        while low > LOWEST_STEP:
            lower = replace(self, lift=low * self.lift, fold=low * self.fold)
            yield lower
            low *= SMALLER
        share = SMALLER
        while share > SMALLEST:
            yield lower.smaller(share)
            share *= SMALLER

    def stands(self, foot: str, phase: float) -> bool:
        return self.swung(foot, phase) == 0.0

    def lifted(self, foot: str, phase: float) -> float:
        """Return the height of a foot as a share of its greatest height."""
        return bump(self.swung(foot, phase))

    def folded(self, foot: str, phase: float) -> float:
        """Return by how much of its length a leg is folded."""
        return self.fold * bump(self.swung(foot, phase) ** (math.log(0.5) / math.log(self.crest)))

    def swing(self, foot: str, phase: float, start: float, end: float) -> float:
        """Return a quantity that runs from one value to another as a foot swings."""
        speed = self.follow * (1 - self.stance) / self.stance
        return hermite(self.swung(foot, phase), start, end, -speed * (end - start))

    def swing_ends(self, foot: str) -> tuple[float, float]:
        """Return the phases at which a foot leaves the ground and comes down."""
        landing = dict(self.landings)[foot]
        return (landing + self.stance) % 1.0, landing

    def rolled(self, foot: str, phase: float) -> float:
        """Return by how many degrees a foot points down; negative, up, before it comes down."""
        share = self.swung(foot, phase)
        return self.roll * (bump(share / 0.7) - 0.4 * bump((share - 0.5) / 0.5))

    def swung(self, foot: str, phase: float) -> float:
        """Return the finished share of a foot's swing, 0 while the foot stands."""
        own = (phase - dict(self.landings)[foot]) % 1.0
        is_standing = own <= self.stance + SAME_PHASE or own >= 1 - SAME_PHASE
        return 0.0 if is_standing else (own - self.stance) / (1 - self.stance)

    def ahead(self, foot: str, phase: float, timing: Timing) -> float:
        """Return how far a foot is ahead of the middle of its stance, in strides."""
        landing = dict(self.landings)[foot]
        own = timing.between(landing, phase)
        stance = 1.0 if self.stance >= 1 else timing.between(landing, landing + self.stance)
        # The middle of the stance does not depend on the frames of the keys.
        start = self.stance / 2 + (stance - self.stance) / 2
        swung = self.swung(foot, phase)
        if swung == 0.0:
            return start - (own if own <= stance + SAME_PHASE else own - 1)
        return hermite(swung, start - stance, start, self.follow * (stance - 1))


class BodyLeg(NamedTuple):
    """A leg at rest: joints from root to tip, lengths, and the side to which it bends."""

    joints: tuple[str, ...]
    lengths: tuple[float, ...]
    bend: int

    @property
    def length(self) -> float:
        """Reach of the straight leg."""
        return sum(self.lengths)


def find_leg(body: Body, tip: str, *, is_as_drawn: bool = False) -> BodyLeg:
    """Return the leg that ends at a foot, or at a hand of a body that walks on its hands.

    It bends to the side on which it is drawn, if it stands as it is drawn, or is clearly bent and
    seen from the side. There both legs of a pair bend alike, as the near one is drawn: the other is
    partly hidden. From the front, knees bend outwards.
    """
    joints = body.limb_joints(tip)
    lengths = tuple(abs(body.joints[b] - body.joints[a]) for a, b in pairwise(joints))
    turn = _drawn_turn(body, tip)
    other = other_side(tip)
    if body.kind.is_side_view and other in body.joints and not is_as_drawn:
        near = tip if tip.endswith(near_side(body.facing)) else other
        of_near, of_other = _drawn_turn(body, near), _drawn_turn(body, other_side(near))
        turn = of_near if abs(of_near) >= BENT else (of_near + of_other) / 2
    bend = -1 if turn > 0 else 1
    is_clear = abs(turn) >= BENT and body.kind.is_side_view
    if not is_clear and not (is_as_drawn and turn):
        bend = _usual_bend(body, tip)
    return BodyLeg(joints, lengths, bend)


def _drawn_turn(body: Body, tip: str) -> float:
    """Return the angle from a leg's upper bone to its lower one as drawn, in radians."""
    places = [body.joints[name] for name in body.limb_joints(tip)]
    if len(places) != 3:
        return 0.0
    return cmath.phase((places[2] - places[1]) / (places[1] - places[0]))


def _usual_bend(body: Body, tip: str) -> int:
    """Return the side to which a leg bends: 1 is counter-clockwise from root to tip."""
    if body.kind.name == "biped-front":
        middle = body.joints[next(iter(body.joints))].real
        return -1 if body.joints[tip].real < middle else 1
    # A hock points backwards, knees and wrists forwards.
    is_hock = body.kind.name == "four-legs" and without_side(tip) == "foot"
    return -body.facing if is_hock else body.facing


def bend_straight_legs(body: Body) -> dict[str, complex]:
    """Return the joints with those of nearly straight legs a little on their usual side.

    A leg begins to bend to the side on which its knee is drawn, however little that is.
    """
    joints = dict(body.joints)
    tips = ("foot", "hand") if body.kind.name == "four-legs" else ("foot",)
    for tip in (f"{name}.{side}" for name in tips for side in "LR"):
        leg = find_leg(body, tip) if tip in joints else None
        if leg is None or len(leg.joints) != 3:
            continue
        root, knee, end = (joints[name] for name in leg.joints)
        way = (end - root) / abs(end - root)
        local = (knee - root) / way
        if local.imag * leg.bend < ASIDE * leg.length:
            aside = leg.bend * ASIDE * leg.length
            joints[leg.joints[1]] = root + way * complex(local.real, aside)
    return joints


def solve_leg_ik(leg: BodyLeg, root: complex, tip: complex) -> dict[str, complex]:
    """Return the positions of the joints between a root and a tip, at the leg's own lengths.

    If the tip is out of reach, the leg is straight towards it.
    """
    if len(leg.lengths) < 2:
        return {}
    upper, lower = leg.lengths
    away = min(max(abs(tip - root), abs(upper - lower) + 1e-9), upper + lower)
    cosine = (upper**2 + away**2 - lower**2) / (2 * upper * away)
    turn = leg.bend * math.acos(min(max(cosine, -1.0), 1.0))
    direction = (tip - root) / abs(tip - root)
    return {leg.joints[1]: root + upper * direction * cmath.exp(1j * turn)}


def required_drop(leg: BodyLeg, root: complex, tip: complex, straight: float) -> float:
    """Return how much a root must come down so that its leg reaches the tip."""
    reach = straight * leg.length if len(leg.lengths) > 1 else leg.length
    beside = min(abs((root - tip).real), reach)
    return max(0.0, (root - tip).imag - math.sqrt(reach**2 - beside**2))
