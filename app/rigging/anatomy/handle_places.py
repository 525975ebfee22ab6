"""Suggested handles: on the body, at the tips of limbs, and at their joints."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.rigging.anatomy.anatomy import NECK, Anatomy, joint_share
from app.rigging.anatomy.names import Limb, SuggestedHandle, name_legs, name_limbs
from engine.arrays import Complexes, Indices
from engine.geometry import arc_lengths

CORNERS_OF_A_RING = 4
# The handle of a head or another round end lies this far above its middle, in radii: not in a face.
CROWN = 0.65
LEAST_NECK = 0.4  # radii: least distance of the neck's handle from the trunk's handles
# A round end has at least this part of the middle's radius, and this many times the radius before
# it.
ROUND_END, SWOLLEN = 0.55, 1.15
# Least length of limbs with a joint, in radii, and of legs; each further length of the third number
# adds a joint.
JOINTED, JOINTED_LEG, SUPPLE = 5.0, 2.4, 14.0
MOST_JOINTS = 3
CLEAR = 1.2  # radii: least distance of a joint from other handles
# On a head, a tip with at most this part of its thickness is an ear or a horn.
THIN_ON_HEAD = 0.45


def suggest_handles(loops: Sequence[Complexes]) -> list[SuggestedHandle]:
    """Suggest handles on the body and its head, and at the tips and joints of limbs.

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
    Cycles around holes are cut where the shape only touches itself. Spurs of the medial axis that
    hardly reach out of the body are cut off, the least one first; the remaining branches are limbs.
    The middle is the node that is nearest to all tips, among nodes where the shape is thick.
    """
    body = _Body(loops)
    found = body.trunk_and_head()
    limbs = list(body.limbs())
    legs = [limb for limb in limbs if limb.is_leg]
    if len(legs) < 2:
        legs = []
    found += name_legs(legs)
    others = [limb for limb in limbs if limb not in legs]
    found += name_limbs(others, complex(body.places[body.middle]))
    around = body.around_holes([handle.place for handle in found])
    found += [SuggestedHandle(place, f"around {number}") for number, place in enumerate(around, 1)]
    return found


class _Body(Anatomy):
    """A shape's anatomy, and its handles."""

    def trunk_and_head(self) -> list[SuggestedHandle]:
        """Return the handles of trunk, neck and head, the last above a possible face."""
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
            # The head rotates where the neck enters its disc; a wide neck may have a face there.
            if narrow <= NECK * self.radii[self.head] and apart > LEAST_NECK * narrow:
                found.append(SuggestedHandle(complex(head - up), "neck"))
            found.append(SuggestedHandle(complex(head + CROWN * up), "head"))
        return found

    def limbs(self) -> Iterator[Limb]:
        trunk = np.unique([self.middle, *self.trunk])
        taken = list(self.places[self.trunk])
        for end, tip in self.tips.items():
            path = self.path(tip)
            if end in self.in_head:
                # Thin tips are ears and horns; a thick one is a nose.
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
        """Return the place of a limb tip's handle; in a round end beyond the middle, off a face."""
        places, radii = self.places[path], self.radii[path]
        wide = int(np.where(np.abs(places - places[-1]) <= 2 * radii[-1], radii, 0.0).argmax())
        inner = np.flatnonzero(np.abs(places[:wide] - places[wide]) >= radii[wide])
        is_round = radii[wide] >= SWOLLEN * radii[: wide + 1].min()
        if not (is_round and inner.size and radii[wide] >= ROUND_END * self.radii[self.middle]):
            return complex(places[-1])
        onward = places[wide] - places[inner[-1]]
        return complex(places[wide] + CROWN * radii[wide] * onward / abs(onward))

    def _joints(self, limb: Indices, least: float) -> list[int]:
        """Return the nodes for handles between the body and a limb's tip."""
        places, radii = self.places[limb], self.radii[limb]
        if len(limb) < 3:
            return []
        lengths = arc_lengths(places)
        slenderness = lengths[-1] / float(np.interp(lengths[-1] / 3, lengths, radii))
        if slenderness < least:
            return []
        count = min(MOST_JOINTS, 1 + int(slenderness / SUPPLE))
        shares = np.arange(1, count + 1) / (count + 1)
        if count == 1:
            shares = np.array([joint_share(places, radii, lengths)])
        return [int(limb[np.abs(lengths - share * lengths[-1]).argmin()]) for share in shares]

    def around_holes(self, held: Sequence[complex]) -> Iterator[complex]:
        """Yield more places, until cycles around holes have handles all around."""
        ring = np.array(self.skeleton.ring_nodes(), dtype=np.intp)
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
            away = self.skeleton.path_distances(chosen)[0][ring]
            # With four handles each half of a ring has one at its ends and in its middle.
            if away.max() < 0.75 * around / CORNERS_OF_A_RING:
                return
            chosen.append(int(ring[away.argmax()]))
            yield complex(self.places[chosen[-1]])
