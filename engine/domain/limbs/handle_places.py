"""Where handles are useful: on the body, at the tips of its limbs, and where these bend."""

from collections.abc import Iterator, Sequence

import numpy as np

from engine.arrays import Complexes, Floats, Indices
from engine.domain.limbs.medial_axis import medial_axis
from engine.domain.limbs.names import Limb, SuggestedHandle, named_legs, named_limbs
from engine.domain.limbs.skeleton import Skeleton
from engine.geometry import box_diagonal

# Of the largest radius, which may be that of a head: what belongs to the body.
THICK = 0.4
CORNERS_OF_A_RING = 4
# A neck is so much narrower than the head beyond it, which is at least so wide as parts of the
# middle's radius.
NECK, LEAST_HEAD = 0.8, 0.55
# Its handle is so far above the middle of a head or of another round end, in radii: not in a face.
CROWN = 0.65
LEAST_NECK = 0.4  # radii by which the neck is away from the trunk's handles, to have one
# A round end has at least such a part of the middle's radius, and so many times that before it.
ROUND_END, SWOLLEN = 0.55, 1.15
# Limbs that are so many radii long have a joint, legs sooner; each so many more give one more.
JOINTED, JOINTED_LEG, SUPPLE = 5.0, 2.4, 14.0
MOST_JOINTS = 3
CLEAR = 1.2  # radii by which a joint is away from other handles
BENT = 0.44  # from what angle on a limb is bent, in radians
THICKENED = 1.45  # or thicker by what factor
MARGIN = 0.35  # parts of a limb, on either side, in which no joint is
STEP = 0.2  # parts of a limb, before and after a place, over which it bends
# On a head, what is at most such a part as thick is an ear or a horn.
THIN_ON_HEAD = 0.45
LONGEST_EAR = 2.5  # radii of the head that tips on it are away from its middle
FORK = 0.5  # parts of the middle's radius: where limbs leave the trunk it is at least so thick
# Two parts of the body have a handle each where they are so many radii apart.
APART = 0.9
# Parts of the height: feet are so near to the ground.
GROUND = 0.12


def suggest_handles(loops: Sequence[Complexes]) -> list[SuggestedHandle]:
    """Return places for handles: on the body and its head, at the tips and joints of limbs.

    Parameters
    ----------
    loops : sequence of complex128
        The outline, counter-clockwise, and the outlines of the holes; y up.

    Returns
    -------
    list of SuggestedHandle
        All inside, with different names, those of the body first.

    Notes
    -----
    Ways around holes are cut where the shape only touches itself. Spurs of the medial axis that
    reach out of the body by little are cut off, the least one first; what is left are limbs. The
    middle is the node that is nearest to all tips, among those where the shape is thick.
    """
    body = _Body(loops)
    found = body.trunk_and_head()
    limbs = list(body.limbs())
    legs = [limb for limb in limbs if limb.is_leg]
    if len(legs) < 2:
        legs = []
    found += named_legs(legs)
    others = [limb for limb in limbs if limb not in legs]
    found += named_limbs(others, complex(body.places[body.middle]))
    around = body.around_holes([handle.place for handle in found])
    found += [SuggestedHandle(place, f"around {number}") for number, place in enumerate(around, 1)]
    return found


class _Body:
    """A skeleton, its middle, and what is its trunk and its head."""

    def __init__(self, loops: Sequence[Complexes]) -> None:
        self.holes = len(loops) - 1
        self.skeleton = Skeleton(medial_axis(loops), box_diagonal(loops[0]))
        self.skeleton.cut_pinches()
        branches = self.skeleton.cut_spurs()
        self.tips = {end: self.skeleton.tip(branch) for end, branch in branches.items()}
        self.places, self.radii = self.skeleton.axis.places, self.skeleton.axis.radii
        self.kept = np.array(sorted(self.skeleton.near))
        thick = self.kept[self.radii[self.kept] >= THICK * self.radii[self.kept].max()]
        # A shape without limbs is nearest to all of its ends.
        goals = list(self.tips.values()) or self.kept.tolist()
        farthest = np.max([self.skeleton.ways([goal])[0][thick] for goal in goals], axis=0)
        self.middle = int(thick[farthest.argmin()])
        _, self.before = self.skeleton.ways([self.middle])
        self.neck, self.head = self._neck_and_head()
        self.in_head = self._in_head()
        self.trunk = self._trunk()
        bottom, top = loops[0].imag.min(), loops[0].imag.max()
        self.ground = float(bottom + GROUND * (top - bottom))

    def _path(self, node: int) -> Indices:
        """Return the nodes from the middle to one."""
        path = [node]
        while path[-1] != self.middle:
            path.append(int(self.before[path[-1]]))
        return np.array(path[::-1])

    def _neck_and_head(self) -> tuple[int, int | None]:
        """Find the widest part above the middle and beyond a neck; both as nodes."""
        neck, head = self.middle, None
        widest = LEAST_HEAD * self.radii[self.middle]
        for end in self.tips:
            path = self._path(end)
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
        """Return the nodes beyond the neck; all limbs begin in it where it is the middle."""
        if self.head is None:
            return set()
        return self._beyond(
            int(self._path(self.head)[1]) if self.neck == self.middle else self.neck
        )

    def _ends_at(self, head: int, neck: int) -> bool:
        """Tell whether no limb reaches far out of what may be a head, as out of a chest."""
        beyond = self._beyond(neck)
        tips = [self.places[tip] for tip in self.tips.values() if tip in beyond]
        reach = LONGEST_EAR * self.radii[head]
        return bool(np.all(np.abs(np.array(tips) - self.places[head]) <= reach))

    def _beyond(self, neck: int) -> set[int]:
        """Return the nodes whose way from the middle leads through one."""
        found, ahead = {neck}, [neck]
        while ahead:
            node = ahead.pop()
            further = self.skeleton.near[node] - {int(self.before[node])} - found
            found |= further
            ahead += further
        return found

    def _trunk(self) -> list[int]:
        """Return the nodes that hold the trunk: two where limbs leave it far apart, or its middle.

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
            between = np.array([self.skeleton.ways([fork])[0][forks] for fork in forks])
            one, other = np.unravel_index(between.argmax(), between.shape)
            pair = [forks[one], forks[other]]
            if between[one, other] >= APART * self.radii[pair].max():
                first = self.places[self.neck] if self.head is not None else 1e9j
                return sorted(pair, key=lambda node: float(abs(self.places[node] - first)))
        return [self.middle]

    def trunk_and_head(self) -> list[SuggestedHandle]:
        """Return the handles of trunk, neck and head, the last above what may be a face."""
        names = ["chest", "hips"] if len(self.trunk) > 1 else ["body"]
        found = [
            SuggestedHandle(complex(self.places[node]), name)
            for node, name in zip(self.trunk, names, strict=True)
        ]
        if self.head is not None:
            neck, head = self.places[[self.neck, self.head]]
            up = self.radii[self.head] * (head - neck) / abs(head - neck)
            apart = np.abs(self.places[self.trunk] - (head - up)).min()
            narrow = self.radii[self.neck]
            # The head turns where the neck enters its disc; a wide one may have a face there.
            if narrow <= NECK * self.radii[self.head] and apart > LEAST_NECK * narrow:
                found.append(SuggestedHandle(complex(head - up), "neck"))
            found.append(SuggestedHandle(complex(head + CROWN * up), "head"))
        return found

    def limbs(self) -> Iterator[Limb]:
        """Yield the limbs."""
        trunk = np.unique([self.middle, *self.trunk])
        taken = list(self.places[self.trunk])
        for end, tip in self.tips.items():
            path = self._path(tip)
            if end in self.in_head:
                # Ears and horns; what is thick is a nose.
                if self.radii[tip] <= THIN_ON_HEAD * self.radii[self.head]:
                    yield Limb(complex(self.places[tip]), [], is_leg=False)
                continue
            away = np.abs(self.places[path][:, None] - self.places[trunk])
            leaving = int(np.flatnonzero((away <= self.radii[trunk]).any(axis=1))[-1])
            place = self._end(path)
            start = self.places[path[leaving]]
            is_leg = (
                place.imag <= self.ground and (start - place).imag > abs((start - place).real) / 2
            )
            joints = []
            for joint in self._joints(path[leaving:], JOINTED_LEG if is_leg else JOINTED):
                at, radius = complex(self.places[joint]), self.radii[joint]
                if all(abs(at - other) > CLEAR * radius for other in [*taken, place]):
                    joints.append(at)
            taken += [place, *joints]
            yield Limb(place, joints, is_leg)

    def _end(self, path: Indices) -> complex:
        """Return where a limb's tip is held; a round end beyond its middle, where a face may be."""
        places, radii = self.places[path], self.radii[path]
        wide = int(np.where(np.abs(places - places[-1]) <= 2 * radii[-1], radii, 0.0).argmax())
        inner = np.flatnonzero(np.abs(places[:wide] - places[wide]) >= radii[wide])
        is_round = radii[wide] >= SWOLLEN * radii[: wide + 1].min()
        if not (is_round and inner.size and radii[wide] >= ROUND_END * self.radii[self.middle]):
            return complex(places[-1])
        onward = places[wide] - places[inner[-1]]
        return complex(places[wide] + CROWN * radii[wide] * onward / abs(onward))

    def _joints(self, limb: Indices, least: float) -> list[int]:
        """Return the nodes at which a limb is held between the body and its tip."""
        places, radii = self.places[limb], self.radii[limb]
        if len(limb) < 3:
            return []
        lengths = np.append(0.0, np.cumsum(np.abs(np.diff(places))))
        slenderness = lengths[-1] / float(np.interp(lengths[-1] / 3, lengths, radii))
        if slenderness < least:
            return []
        count = min(MOST_JOINTS, 1 + int(slenderness / SUPPLE))
        shares = np.arange(1, count + 1) / (count + 1)
        if count == 1:
            shares = np.array([self._joint_share(places, radii, lengths)])
        return [int(limb[np.abs(lengths - share * lengths[-1]).argmin()]) for share in shares]

    @staticmethod
    def _joint_share(places: Complexes, radii: Floats, lengths: Floats) -> float:
        """Return the part of a limb after which it bends most, or becomes thicker; or a half."""
        shares = np.linspace(MARGIN, 1 - MARGIN, 29)

        def at(share: Floats, values: Floats) -> Floats:
            return np.asarray(np.interp(share * lengths[-1], lengths, values))

        def place(share: Floats) -> Complexes:
            return at(share, places.real) + 1j * at(share, places.imag)

        here = place(shares)
        bends = np.abs(np.angle((place(shares + STEP) - here) / (here - place(shares - STEP))))
        growth = at(shares + STEP / 2, radii) / at(shares - STEP / 2, radii)
        for measure, least in ((bends, BENT), (growth, THICKENED)):
            most = int(measure.argmax())
            # What is most at an end belongs to a hand or a shoulder.
            if measure[most] >= least and 0 < most < len(shares) - 1:
                return float(shares[most])
        return 0.5

    def around_holes(self, held: Sequence[complex]) -> Iterator[complex]:
        """Yield more places, until ways around holes are held all around."""
        ring = np.array(self.skeleton.ring(), dtype=np.intp)
        if not ring.size:
            return
        on_ring = set(ring.tolist())
        around = sum(
            abs(self.places[node] - self.places[other])
            for node in on_ring
            for other in self.skeleton.near[node] & on_ring
        ) / (2 * max(1, self.holes))
        nearest = np.abs(self.places[self.kept] - np.array(held)[:, None]).argmin(axis=1)
        chosen = self.kept[nearest].tolist()
        while True:
            away = self.skeleton.ways(chosen)[0][ring]
            # In four places each half of a ring is held at its ends and in its middle.
            if away.max() < 0.75 * around / CORNERS_OF_A_RING:
                return
            chosen.append(int(ring[away.argmax()]))
            yield complex(self.places[chosen[-1]])
