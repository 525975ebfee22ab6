"""The plan of a body: its legs, its head, and its facing."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from app.rigging.anatomy.anatomy import Anatomy, neck_along
from app.rigging.anatomy.legs import PlannedLeg, TrackedLeg, pair_legs, plan_leg
from engine.arrays import Complexes, Indices
from engine.geometry import contains, crossings_at

# Toes point to a side if they reach this far beyond the ankle, in heights of the shape.
TOES = 0.03
# A single leg counts as a body's leg if its foot reaches this far.
FOOT = 0.06
RISEN = 0.3  # heights from hips to head, at least
UPRIGHT = 2.0  # height over width of a body whose legs are together, at least
# Distance of the roots of a lifted and a standing leg, in radii of the latter, at most.
SAME_HIPS = 1.2
# A trunk lies if legs leave it this far apart, in its radii. Without a part above the legs, they
# must be this far apart in widths of the shape.
LONG_TRUNK, WIDE_STANCE = 1.5, 0.25
# A shape is seen from the front if its mirror image covers this part of it.
SYMMETRIC = 0.82
# Below this symmetry, feet that point away from each other are a foot and a tail.
LOPSIDED = 0.6
SAMPLES = 48  # of the shape's box, along each side
END = 0.35  # of the trunk between the legs: a head or a tail leaves it within this share


class BodyPlan:
    """The legs of a shape, and the ends of its trunk.

    `loops` are the outline, counter-clockwise, and the outlines of the holes; y up. `tracked` are
    legs, from the left, that lines part: two pairs of them count if the shape itself shows no legs.
    """

    def __init__(self, loops: Sequence[Complexes], tracked: Sequence[TrackedLeg] = ()) -> None:
        self.loops = loops
        self.anatomy = Anatomy(loops, opened=True)
        self.places, self.radii = self.anatomy.places, self.anatomy.radii
        outline = loops[0]
        self.low = complex(outline.real.min(), outline.imag.min())
        self.high = complex(outline.real.max(), outline.imag.max())
        self.tall, self.wide = (self.high - self.low).imag, (self.high - self.low).real
        self.middle = (self.low.real + self.high.real) / 2
        self.legs, ends = self._legs(), list(self.anatomy.branches)
        if len(self.legs) < 2 and pair_legs(tracked) and not self.is_mirrored:
            self.legs = self._legs_between_lines(tracked)
            lowest = min(leg.root.imag for leg in tracked)
            ends = [end for end in ends if self.places[end].imag > lowest]
        standing = {int(leg.path[-1]) for leg in self.legs}
        self.others = [end for end in ends if end not in standing]

    @cached_property
    def is_mirrored(self) -> bool:
        """Whether the shape is upright and its own mirror image, as bodies from the front are."""
        return self.tall > self.wide and self._symmetry_about(self.middle) >= SYMMETRIC

    @property
    def has_half_a_pair(self) -> bool:
        """Whether one of two mirrored legs was found: a single one, beside the middle."""
        if len(self.legs) != 1 or not self.is_mirrored:
            return False
        tip = self.legs[0].path[-1]
        return bool(abs(self.places[tip].real - self.middle) > self.radii[tip])

    def between(self, start: int, end: int) -> Indices:
        _, before = self.anatomy.skeleton.path_distances([start])
        path = [end]
        while path[-1] != start:
            path.append(int(before[path[-1]]))
        return np.array(path[::-1])

    def length(self, path: Indices) -> float:
        return float(np.abs(np.diff(self.places[path])).sum())

    def handle_node(self, end: int) -> int:
        """Node to put a handle on for this end: the centre of a round end, else the tip."""
        return self.anatomy.tips.get(end, end)

    def meeting(self, one: int, other: int, third: int) -> int:
        """Return the node at which the paths between three nodes meet."""
        on_way = set(self.between(one, other).tolist())
        return next(int(node) for node in self.between(third, one) if int(node) in on_way)

    def _legs(self) -> list[PlannedLeg]:
        """Return the legs, from the left."""
        near, branches = self.anatomy.skeleton.near, self.anatomy.branches.values()
        limbs = [each for each in branches if len(near[each.path[-1]]) > 2]
        if not limbs:
            return self._legs_together()
        planned = (plan_leg(limb, self.places, self.radii) for limb in limbs)
        found = [(leg, lowest) for leg, lowest in planned if leg is not None]
        legs = [leg for leg, lowest in found if lowest <= self.anatomy.ground]
        if len(legs) == 1:
            # A lifted leg, as in a run, has the same hips.
            hips = legs[0].path[0]
            reach = SAME_HIPS * self.radii[hips]
            middle = self.low.imag + self.tall / 2
            legs += [
                leg
                for leg, lowest in found
                if leg is not legs[0]
                and lowest < middle
                and abs(self.places[leg.path[0]] - self.places[hips]) <= reach
            ][:1]
        return self._without_tail(sorted(legs, key=lambda leg: float(self.places[leg.ankle].real)))

    def _legs_between_lines(self, tracked: Sequence[TrackedLeg]) -> list[PlannedLeg]:
        """Return the paths along which lines part legs, from one root for each pair."""
        nodes, legs = self.anatomy.kept, list[PlannedLeg]()
        for pair in pair_legs(tracked):
            roots, feet = (np.array([leg[at] for leg in pair]) for at in (0, -1))
            root, *ends = (
                int(nodes[np.abs(self.places[nodes] - place).argmin()])
                for place in (roots.mean(), *feet)
            )
            legs += [PlannedLeg(self.between(root, end), end) for end in ends]
        return legs

    def _without_tail(self, legs: list[PlannedLeg]) -> list[PlannedLeg]:
        """Return legs without a tail that lies on the ground like a second foot."""
        if len(legs) != 2:
            return legs
        left, right = (self._toes(leg, -np.inf, np.inf) for leg in legs)
        root = complex(self.places[legs[0].path[0]])
        if not -left > FOOT < right or self._symmetry_about(root.real) >= LOPSIDED:
            return legs
        top = complex(self.places[int(self.places.imag.argmax())])
        return legs[1:] if top.real > root.real else legs[:1]

    def _legs_together(self) -> list[PlannedLeg]:
        """Return the single leg of an upright body that has a head and toes but no limbs."""
        way = self.longest()
        places, radii = self.places[way], self.radii[way]
        if len(way) < 4 or self.tall < UPRIGHT * self.wide or neck_along(radii) is None:
            return []
        half = int(np.flatnonzero(places.imag <= self.low.imag + self.tall / 2)[-1])
        high = places[: half + 1].imag > places[: half + 1].imag.min() + np.median(radii[:half])
        leg = PlannedLeg(way[half::-1], int(way[max(0, int(high.argmax()) - 1)]))
        return [leg] if abs(self._toes(leg, -np.inf, np.inf)) > FOOT else []

    @cached_property
    def pairs(self) -> tuple[list[PlannedLeg], list[PlannedLeg]]:
        """The legs on the left and on the right, separated at the largest gap."""
        feet = np.array([self.places[leg.ankle].real for leg in self.legs])
        parted = int(np.diff(feet).argmax()) + 1
        return self.legs[:parted], self.legs[parted:]

    @cached_property
    def trunk(self) -> Indices:
        """The nodes between the roots of the left and of the right legs.

        One node if they have the same root.
        """
        ways = [
            self.between(int(one.path[0]), int(other.path[0]))
            for one in self.pairs[0]
            for other in self.pairs[1]
        ]
        return min(ways, key=self.length)

    def _leaves_at(self, end: int) -> float:
        """Return the share of the trunk, from the left, at which a branch leaves it."""
        first, last = int(self.trunk[0]), int(self.trunk[-1])
        ways = (self.places[[self.meeting(first, last, end), last]] - self.places[first]).real
        return float(ways[0] / (ways[1] if abs(ways[1]) > 1e-9 else 1e-9))

    @cached_property
    def is_lying(self) -> bool:
        """Whether the trunk lies, with legs below both of its ends."""
        if len(self.legs) < 2:
            return False
        long = LONG_TRUNK if len(self.legs) == 2 else LONG_TRUNK / 2
        if self.length(self.trunk) >= long * self.radii[self.trunk[[0, -1]]].min():
            shares = [self._leaves_at(end) for end in self.others]
            return any(not END < share < 1 - END for share in shares) or not shares
        if len(self.legs) > 2:
            return self.symmetry < SYMMETRIC
        feet = self.places[[self.legs[0].ankle, self.legs[-1].ankle]].real
        hips = self.places[self.trunk[0]]
        tops = [self.places[self.between(int(self.trunk[0]), end)] for end in self.others]
        rises = any((way.imag - hips.imag).max() > self.tall / 5 for way in tops)
        return bool(feet[1] - feet[0] >= WIDE_STANCE * self.wide and not rises)

    def ahead(self, end: int) -> bool:
        """Whether a branch leaves a lying trunk at the end that the body faces."""
        return (self._leaves_at(end) - 0.5) * self.facing > 0

    def thickness(self, end: int) -> float:
        """Return the radius of a branch at its middle."""
        branch = self.anatomy.branches[end]
        lengths = np.array(branch.lengths)
        out = lengths[-1] - self.radii[branch.path[-1]]
        return float(np.interp(0.5 * out, lengths, self.radii[branch.path]))

    def _bulk(self, end: int) -> float:
        """Return the largest radius where a branch leaves a lying trunk."""
        first, last = int(self.trunk[0]), int(self.trunk[-1])
        fork = self.meeting(first, last, end)
        way = self.between(fork, end)
        beyond = np.abs(self.places[way] - self.places[fork]) >= self.radii[fork]
        return float(self.radii[way][beyond].max(initial=0.0))

    @cached_property
    def head_end(self) -> int | None:
        """The end of the axis in the head of a standing body; None without a head."""
        if not self.others:
            return None
        return max(self.others, key=lambda end: self.places[end].imag + 2 * self.thickness(end))

    @cached_property
    def hips(self) -> int:
        """The node at which the legs of a standing body meet; of a single leg its root."""
        tip = self.head_end
        if not self.legs:
            longest = self.longest()
            return int(longest[len(longest) // 3])
        if tip is None:
            return int(self.trunk[0]) if len(self.legs) > 1 else int(self.legs[0].path[0])
        if len(self.legs) == 1:
            return int(self.legs[0].path[0])
        return self.meeting(tip, self.legs[0].ankle, self.legs[-1].ankle)

    @cached_property
    def symmetry(self) -> float:
        """Share of the shape covered by its mirror image, about the middle of the hips."""
        return self._symmetry_about(float(self.places[self.hips].real))

    def _symmetry_about(self, middle: float) -> float:
        """Return the share of the shape covered by its mirror image about an upright line."""
        steps = (np.arange(SAMPLES) + 0.5) / SAMPLES
        grid: Complexes = self.low + steps * self.wide + 1j * steps[:, None] * self.tall
        inside = grid[contains(self.loops[0], grid.ravel()).reshape(grid.shape)]
        return float(contains(self.loops[0], 2 * middle - inside.conj()).mean())

    @property
    def is_upright(self) -> bool:
        """Whether the head is well above the hips."""
        tip = self.head_end
        if tip is None:
            return False
        return float((self.places[tip] - self.places[self.hips]).imag) >= RISEN * self.tall

    def longest(self) -> Indices:
        """Return the longest path from end to end, from the lower or the left end."""
        ends = list(self.anatomy.branches)
        if len(ends) < 2:
            return np.array([self.anatomy.middle])
        ways = [self.between(one, other) for one in ends for other in ends if one < other]
        way = max(ways, key=self.length)
        along = self.places[way[-1]] - self.places[way[0]]
        lead = along.imag if abs(along.imag) > abs(along.real) else along.real
        return way if lead >= 0 else way[::-1]

    @cached_property
    def facing(self) -> int:
        """Facing: 1 is to the right and -1 to the left."""
        votes = 2.0 * sum(np.sign(toes) * (abs(toes) > TOES) for toes in self.toes)
        if self.is_lying:
            thick = [
                (self._bulk(end), 1 if self._leaves_at(end) > 0.5 else -1)
                for end in self.others
                if not END < self._leaves_at(end) < 1 - END
            ]
            if thick:
                most, side = max(thick)
                others = [each for each, way in thick if way != side]
                votes += side * (1.0 if others and most < 1.25 * max(others) else 5.0)
        elif self.head_end is not None:
            ahead = self.places[self.head_end].real - self.places[self.hips].real
            votes += float(np.clip(6 * ahead / self.tall, -1, 1))
        return 1 if votes >= 0 else -1

    @cached_property
    def toes(self) -> list[float]:
        """How far feet reach to the right of their ankles, less how far to the left, in heights.

        Outlines show this better than middle lines, which end in one of a foot's corners.
        """
        if not self.legs:
            return []
        ankles = self.places[[leg.ankle for leg in self.legs]].real
        bounds = [-np.inf, *((ankles[1:] + ankles[:-1]) / 2).tolist(), np.inf]
        ends = zip(self.legs, bounds[:-1], bounds[1:], strict=True)
        return [self._toes(leg, left, right) for leg, left, right in ends]

    def _toes(self, leg: PlannedLeg, left: float, right: float) -> float:
        """Return how far a foot reaches to the right, within bounds."""
        ankle = self.places[leg.ankle]
        lowest = (self.places[leg.path].imag - self.radii[leg.path]).min()
        crossings = crossings_at(self.loops[:1], (ankle.imag + lowest) / 2)
        before, after = crossings[crossings <= ankle.real], crossings[crossings > ankle.real]
        if not (before.size and after.size):
            return 0.0
        ends = max(float(before.max()), left) + min(float(after.min()), right)
        return float(ends - 2 * ankle.real) / self.tall
