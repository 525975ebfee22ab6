"""Parts of a shape: a middle, a trunk, a head on a neck, and tips of limbs."""

from collections.abc import Sequence

import numpy as np

from app.rigging.anatomy.medial_axis import medial_axis
from app.rigging.anatomy.skeleton import Skeleton
from engine.arrays import Complexes, Floats, Indices
from engine.geometry import diameter

# Of the largest radius, which may be the head's: least radius of nodes of the body.
THICK = 0.4
# A neck has at most this part of the radius of the head beyond it. A head has at least this part of
# the middle's radius.
NECK, LEAST_HEAD = 0.8, 0.55
LONGEST_EAR = 2.5  # radii of the head: largest distance of its ears' tips from its middle
FORK = 0.5  # of the middle's radius: least radius of the trunk where limbs leave it
# Two parts of the body get separate handles if they are this many radii apart.
APART = 0.9
# Of the height: feet are this near to the ground.
GROUND = 0.12
# On the path to a head, the neck has at most these parts of the radius beyond it and before it. The
# part beyond it has at least this part of the first radius.
NARROWED, HARDLY_NARROWED, SMALLEST_HEAD = 0.93, 0.97, 0.3
BENT = 0.44  # least angle of a bent limb, in radians
THICKENED = 1.45  # factor by which a limb becomes thicker at a joint
MARGIN = 0.35  # of a limb, at either end: no joint there
STEP = 0.2  # of a limb, before and after a place: where its bend is measured


class Anatomy:
    """A skeleton with its middle, trunk and head.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the outlines of the holes; y up.
    opened : bool
        Whether cycles around holes are cut open, so that limbs that touch still count as limbs.
    """

    def __init__(self, loops: Sequence[Complexes], *, opened: bool = False) -> None:
        self.holes = len(loops) - 1
        bottom, top = loops[0].imag.min(), loops[0].imag.max()
        self.ground = float(bottom + GROUND * (top - bottom))
        self.skeleton = Skeleton(medial_axis(loops), diameter(loops[0]))
        if opened:
            self.skeleton.open_rings(self.ground)
        else:
            self.skeleton.cut_pinches()
        self.branches = self.skeleton.cut_spurs()
        self.tips = {end: self.skeleton.tip(branch) for end, branch in self.branches.items()}
        self.places, self.radii = self.skeleton.axis.places, self.skeleton.axis.radii
        self.kept = np.array(sorted(self.skeleton.near))
        thick = self.kept[self.radii[self.kept] >= THICK * self.radii[self.kept].max()]
        # In a shape without limbs the middle is nearest to all ends.
        goals = list(self.tips.values()) or self.kept.tolist()
        farthest = np.max(
            [self.skeleton.path_distances([goal])[0][thick] for goal in goals], axis=0
        )
        self.middle = int(thick[farthest.argmin()])
        _, self.before = self.skeleton.path_distances([self.middle])
        self.neck, self.head = self._neck_and_head()
        self.in_head = self._in_head()
        self.trunk = self._trunk()

    def path(self, node: int) -> Indices:
        path = [node]
        while path[-1] != self.middle:
            path.append(int(self.before[path[-1]]))
        return np.array(path[::-1])

    def _neck_and_head(self) -> tuple[int, int | None]:
        """Find the widest part above the middle and beyond a neck; both as nodes."""
        neck, head = self.middle, None
        widest = LEAST_HEAD * self.radii[self.middle]
        for end in self.tips:
            path = self.path(end)
            radii = self.radii[path]
            is_wide = (np.minimum.accumulate(radii) <= NECK * radii) & (radii > widest)
            wide = int(np.where(is_wide, radii, 0.0).argmax())
            found = int(path[wide])
            is_above = self.places[found].imag > self.places[self.middle].imag
            if is_wide[wide] and is_above and self._ends_at(found, int(path[max(wide - 1, 0)])):
                away = np.abs(self.places[path[:wide]] - self.places[found])
                outside = np.flatnonzero(away >= radii[wide])
                neck = int(path[outside[-1]]) if outside.size else self.middle
                head, widest = found, self.radii[found]
        return neck, head

    def _in_head(self) -> set[int]:
        """Return the nodes beyond the neck. If the middle is in the head, all limbs begin there."""
        if self.head is None:
            return set()
        return self._beyond(int(self.path(self.head)[1]) if self.neck == self.middle else self.neck)

    def _ends_at(self, head: int, neck: int) -> bool:
        """Whether no limb reaches far out of a possible head, as it would out of a chest."""
        beyond = self._beyond(neck)
        tips = [self.places[tip] for tip in self.tips.values() if tip in beyond]
        reach = LONGEST_EAR * self.radii[head]
        return bool(np.all(np.abs(np.array(tips) - self.places[head]) <= reach))

    def _beyond(self, neck: int) -> set[int]:
        """Return the nodes whose path from the middle leads through a node."""
        found, ahead = {neck}, [neck]
        while ahead:
            node = ahead.pop()
            further = self.skeleton.near[node] - {int(self.before[node])} - found
            found |= further
            ahead += further
        return found

    def _trunk(self) -> list[int]:
        """Return the trunk's nodes for handles: two if limbs leave it far apart, else its middle.

        The first is nearer to the neck, or higher.
        """
        forks = [
            node
            for node, others in self.skeleton.near.items()
            if len(others) > 2
            and node not in self.in_head
            and self.radii[node] >= FORK * self.radii[self.middle]
        ]
        if len(forks) > 1:
            between = np.array([self.skeleton.path_distances([fork])[0][forks] for fork in forks])
            one, other = np.unravel_index(between.argmax(), between.shape)
            pair = [forks[one], forks[other]]
            if between[one, other] >= APART * self.radii[pair].max():
                first = self.places[self.neck] if self.head is not None else 1e9j
                return sorted(pair, key=lambda node: float(abs(self.places[node] - first)))
        return [self.middle]


def neck_along(radii: Floats) -> int | None:
    """Return the index of the narrowest radius with larger ones on both sides, if any."""
    after, before = np.maximum.accumulate(radii[::-1])[::-1], np.maximum.accumulate(radii)
    is_narrow = (radii <= NARROWED * after) & (radii <= HARDLY_NARROWED * before)
    is_narrow &= after >= SMALLEST_HEAD * radii[0]
    narrowness = np.where(is_narrow, radii / after * np.sqrt(radii / before), np.inf)
    at = int(narrowness.argmin())
    return at if is_narrow[at] else None


def joint_share(places: Complexes, radii: Floats, lengths: Floats) -> float:
    """Return the share of a limb at which it bends most, or becomes thicker; else one half."""
    bend = bend_share(places, lengths)
    if bend is not None:
        return bend
    shares = _joint_shares()
    after, before = (shares + step for step in (STEP / 2, -STEP / 2))
    growth = _along(after, lengths, radii) / _along(before, lengths, radii)
    thickened = _most_within(growth, THICKENED)
    return 0.5 if thickened is None else thickened


def bend_share(places: Complexes, lengths: Floats) -> float | None:
    """Return the share of a limb at which it bends most; None for a straight limb."""
    shares = _joint_shares()
    before, here, after = (
        _along(shares + step, lengths, places.real)
        + 1j * _along(shares + step, lengths, places.imag)
        for step in (-STEP, 0.0, STEP)
    )
    return _most_within(np.abs(np.angle((after - here) / (here - before))), BENT)


def _joint_shares() -> Floats:
    """Return the shares of a limb at which a joint may be."""
    return np.linspace(MARGIN, 1 - MARGIN, 29)


def _along(shares: Floats, lengths: Floats, values: Floats) -> Floats:
    return np.asarray(np.interp(shares * lengths[-1], lengths, values))


def _most_within(measure: Floats, least: float) -> float | None:
    """Return the share with the largest measure; none at an end, which is a hand or a shoulder."""
    most = int(measure.argmax())
    shares = _joint_shares()
    return float(shares[most]) if measure[most] >= least and 0 < most < len(shares) - 1 else None
