"""The plan of a body: on which legs it stands, where its head is, and to where it looks."""

from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.domain.anatomy.anatomy import Anatomy, neck_along
from engine.domain.anatomy.skeleton import Branch
from engine.geometry import contains

# What is so short, in radii of where it begins, and thins out so much between a quarter and three
# of its length is a corner, not a leg.
SHORT, CORNER = 1.0, 0.5
# Times as far to the side as down: a tail that lies on the ground.
LYING = 1.3
# The ankle and the sole are so high above the lowest place of a leg's middle line, in its radii.
ANKLE, SOLE = 1.1, 0.6
# Toes point somewhere where they reach so far beyond the ankle, in heights of the shape.
TOES = 0.03
# One leg alone is that of a body where its foot reaches so far.
FOOT = 0.06
RISEN = 0.3  # heights by which the head is above the hips
UPRIGHT = 2.0  # widths by which a body is tall at least whose legs are together
# A leg that is lifted begins so near to the one that stands, in radii of where that one begins.
SAME_HIPS = 1.2
# The trunk lies where legs leave it so far apart, in radii of it; where nothing rises above the
# legs, where these stand so far apart in widths of the shape.
LONG_TRUNK, WIDE_STANCE = 1.5, 0.25
# From the front it is so much of a shape that its mirror image covers.
SYMMETRIC = 0.82
# Below that, feet that point away from each other are a foot and a tail.
LOPSIDED = 0.6
SAMPLES = 48  # of the shape's box, along each side
END = 0.35  # parts of what is between the legs: what leaves there is a head or a tail


class PlannedLeg(NamedTuple):
    """A leg: the nodes from where it leaves the rest to its end, and its ankle among them."""

    path: Indices
    ankle: int


class BodyPlan:
    """The legs of a shape, and what is at the ends of its trunk.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the outlines of the holes; y up.
    """

    def __init__(self, loops: Sequence[Complexes]) -> None:
        self.loops = loops
        self.anatomy = Anatomy(loops, opened=True)
        self.places, self.radii = self.anatomy.places, self.anatomy.radii
        outline = loops[0]
        self.low = complex(outline.real.min(), outline.imag.min())
        self.high = complex(outline.real.max(), outline.imag.max())
        self.tall, self.wide = (self.high - self.low).imag, (self.high - self.low).real
        self.legs = self._legs()
        standing = {int(leg.path[-1]) for leg in self.legs}
        self.others = [end for end in self.anatomy.branches if end not in standing]

    def between(self, start: int, end: int) -> Indices:
        """Return the nodes from one to another."""
        _, before = self.anatomy.skeleton.path_distances([start])
        path = [end]
        while path[-1] != start:
            path.append(int(before[path[-1]]))
        return np.array(path[::-1])

    def length(self, path: Indices) -> float:
        """Return how long a path is."""
        return float(np.abs(np.diff(self.places[path])).sum())

    def handle_node(self, end: int) -> int:
        """Return the node by which an end is held, in the middle of a round one."""
        return self.anatomy.tips.get(end, end)

    def meeting(self, one: int, other: int, third: int) -> int:
        """Return the node at which the ways between three others meet."""
        on_way = set(self.between(one, other).tolist())
        return next(int(node) for node in self.between(third, one) if int(node) in on_way)

    def _legs(self) -> list[PlannedLeg]:
        """Return the legs, from the left."""
        near, branches = self.anatomy.skeleton.near, self.anatomy.branches.values()
        limbs = [each for each in branches if len(near[each.path[-1]]) > 2]
        if not limbs:
            return self._legs_together()
        found = [(leg, lowest) for leg, lowest in map(self._leg, limbs) if leg is not None]
        legs = [leg for leg, lowest in found if lowest <= self.anatomy.ground]
        if len(legs) == 1:
            # One that is lifted, as in a run, hangs on the same hips.
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

    def _without_tail(self, legs: list[PlannedLeg]) -> list[PlannedLeg]:
        """Return legs without a tail that lies on the ground as if it were the other foot."""
        if len(legs) != 2:
            return legs
        left, right = (self._toes(leg, -np.inf, np.inf) for leg in legs)
        root = complex(self.places[legs[0].path[0]])
        if not -left > FOOT < right or self._symmetry_about(root.real) >= LOPSIDED:
            return legs
        top = complex(self.places[int(self.places.imag.argmax())])
        return legs[1:] if top.real > root.real else legs[:1]

    def _legs_together(self) -> list[PlannedLeg]:
        """Return the leg of an upright body that has no limbs, but a head, and toes."""
        way = self.longest()
        places, radii = self.places[way], self.radii[way]
        if len(way) < 4 or self.tall < UPRIGHT * self.wide or neck_along(radii) is None:
            return []
        half = int(np.flatnonzero(places.imag <= self.low.imag + self.tall / 2)[-1])
        high = places[: half + 1].imag > places[: half + 1].imag.min() + np.median(radii[:half])
        leg = PlannedLeg(way[half::-1], int(way[max(0, int(high.argmax()) - 1)]))
        return [leg] if abs(self._toes(leg, -np.inf, np.inf)) > FOOT else []

    def _leg(self, branch: Branch) -> tuple[PlannedLeg | None, float]:
        """Return a branch as a leg, None where it is none, and how low it comes."""
        path = np.array(branch.path)
        places, radii, lengths = self.places[path], self.radii[path], np.array(branch.lengths)
        out = lengths[-1] - radii[-1]
        thin, thick = np.interp([0.25 * out, 0.75 * out], lengths, radii)
        lowest = float((places.imag - radii).min())
        if out < lengths[0]:
            return None, lowest  # a corner: it does not leave the disc at its root
        radius = float(np.median(radii[lengths <= out]))

        def reaches(height: float) -> int:
            high = places.imag > places.imag.min() + height * radius
            return max(0, int(high.argmax()) - 1)

        ankle, down = reaches(ANKLE), places[-1] - places[reaches(SOLE)]
        is_corner = out <= SHORT * radii[-1] and thin < CORNER * thick
        is_leg = not is_corner and abs(down.real) <= LYING * down.imag
        return (PlannedLeg(path[::-1], int(path[ankle])) if is_leg else None), lowest

    @cached_property
    def pairs(self) -> tuple[list[PlannedLeg], list[PlannedLeg]]:
        """The legs on the left and on the right, parted where most is between them."""
        feet = np.array([self.places[leg.ankle].real for leg in self.legs])
        parted = int(np.diff(feet).argmax()) + 1
        return self.legs[:parted], self.legs[parted:]

    @cached_property
    def trunk(self) -> Indices:
        """The nodes from where the legs on the left leave the trunk to where those on the right do.

        One alone where they leave at the same place.
        """
        ways = [
            self.between(int(one.path[0]), int(other.path[0]))
            for one in self.pairs[0]
            for other in self.pairs[1]
        ]
        return min(ways, key=self.length)

    def _leaves_at(self, end: int) -> float:
        """Return after which part of the trunk, from the left to the right, something leaves it."""
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
        """Tell whether something leaves a trunk that lies at the end where it looks to."""
        return (self._leaves_at(end) - 0.5) * self.facing > 0

    def thickness(self, end: int) -> float:
        """Return how thick a branch is, halfway."""
        branch = self.anatomy.branches[end]
        lengths = np.array(branch.lengths)
        out = lengths[-1] - self.radii[branch.path[-1]]
        return float(np.interp(0.5 * out, lengths, self.radii[branch.path]))

    def _bulk(self, end: int) -> float:
        """Return how thick at most it is where something reaches out of a trunk that lies."""
        first, last = int(self.trunk[0]), int(self.trunk[-1])
        fork = self.meeting(first, last, end)
        way = self.between(fork, end)
        beyond = np.abs(self.places[way] - self.places[fork]) >= self.radii[fork]
        return float(self.radii[way][beyond].max(initial=0.0))

    @cached_property
    def head_end(self) -> int | None:
        """The end of the axis that is in the head of a body that stands; None without one."""
        if not self.others:
            return None
        return max(self.others, key=lambda end: self.places[end].imag + 2 * self.thickness(end))

    @cached_property
    def hips(self) -> int:
        """The node at which the legs of a body that stands meet; that of one leg hangs there."""
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
        """Which part of the shape is covered by its mirror image, at the hips' middle."""
        return self._symmetry_about(float(self.places[self.hips].real))

    def _symmetry_about(self, middle: float) -> float:
        """Return which part of the shape is covered by its mirror image at an upright line."""
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
        """Return the longest way from end to end, from the lower end, or from the left one."""
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
        """Where it looks: 1 is to the right and -1 to the left."""
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

        Outlines tell that better than middle lines, which end in one of a foot's corners.
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
        crossings = _crossings(self.loops[0], (ankle.imag + lowest) / 2)
        before, after = crossings[crossings <= ankle.real], crossings[crossings > ankle.real]
        if not (before.size and after.size):
            return 0.0
        ends = max(float(before.max()), left) + min(float(after.min()), right)
        return float(ends - 2 * ankle.real) / self.tall


def _crossings(outline: Complexes, height: float) -> Floats:
    """Return where an outline crosses a level line, from the left."""
    start, end = outline, np.roll(outline, -1)
    crossing = (start.imag > height) != (end.imag > height)
    start, end = start[crossing], end[crossing]
    share = (height - start.imag) / (end.imag - start.imag)
    return np.sort(start.real + share * (end.real - start.real))
