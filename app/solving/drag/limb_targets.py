"""Targets of limbs: joints follow the ends of their chains, and hips carry the body."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from app.document import Layer, LimbChain, Limbs, Target
from app.rigging import bend_side, solve_chain
from engine.arrays import Complexes
from engine.geometry import diameter

# Part of the shape's diameter: places that are off a rigid motion by less move as a whole.
RIGID = 2e-3


class BodyTargets(NamedTuple):
    """The targets after the body was carried, and whether it moves only as a whole."""

    targets: Mapping[int, Target]
    is_rigid: bool


def carry_body(
    layer: Layer, limbs: Limbs, start: Mapping[int, Target], targets: Mapping[int, Target]
) -> BodyTargets:
    """Move the handles of the body along with dragged roots of limbs.

    The body's handles are those of no chain, and the roots. Locked handles stay, and so does
    everything as long as a handle of the body itself is dragged, or the layer is attached.
    """
    of_chains = {handle for limb in limbs.limbs for handle in limb.chain.handles}
    roots = {limb.chain.root for limb in limbs.limbs if limb.parent is None}
    free = {each.id for each in layer.handles} - of_chains - layer.sprung_handles
    body = sorted(identity for identity in free | roots if identity in start)
    moved = [identity for identity in body if start[identity] != targets[identity]]
    if not moved or len(body) < len(free | roots):
        return BodyTargets(targets, is_rigid=not moved and bool(body))
    most = RIGID * diameter(layer.domain.outline)
    if roots.issuperset(moved) and not layer.has_parent:
        motion = _RigidMotion.fit(_places(start, moved), _places(targets, moved))
        if motion.misfit <= most:
            carried = [i for i in body if i not in moved and not layer.is_locked(i)]
            places = motion.apply(_places(start, carried)).tolist()
            targets = {
                **targets,
                **{
                    identity: replace(targets[identity], position=place)
                    for identity, place in zip(carried, places, strict=True)
                },
            }
    whole = _RigidMotion.fit(_places(start, body), _places(targets, body))
    return BodyTargets(targets, is_rigid=whole.misfit <= most)


def solve_limbs(
    layer: Layer,
    limbs: Limbs,
    joints: Mapping[int, complex],
    start: Mapping[int, Target],
    targets: Mapping[int, Target],
) -> Mapping[int, Target]:
    """Return the targets with those of all chains where kinematics has them.

    `joints` are the places of the chains' handles at the start. The joints of a dragged end follow
    it. Bones beyond a dragged joint turn with it, and a locked end stays.
    """
    solved = dict(targets)
    for limb in limbs.limbs:
        moved = {i for i in limb.chain.handles if start.get(i) != targets[i]}
        place = solved[limb.chain.root].position
        chain = _Chain(limb, joints, start, targets, frozenset(moved), place)
        found = chain.solved(is_end_locked=layer.is_locked(limb.chain.end))
        for identity, (place, side) in found.items():
            solved[identity] = replace(solved[identity], position=place, side=side)
    return solved


@dataclass(frozen=True, slots=True, eq=False)
class _Chain:
    """A chain at the start of a drag, and where its handles are wanted."""

    limb: LimbChain
    joints: Mapping[int, complex]
    start: Mapping[int, Target]
    targets: Mapping[int, Target]
    moved: frozenset[int]
    root: complex

    def solved(self, *, is_end_locked: bool) -> dict[int, tuple[complex, int | None]]:
        """Return the place and the side of each handle after the root."""
        handles, lengths = self.limb.chain.handles, self.limb.lengths
        pulled = [i for i, each in enumerate(handles[1:-1], 1) if each in self.moved]
        if not pulled or handles[-1] in self.moved or is_end_locked:
            last = len(lengths)
        else:
            last = pulled[-1]
        side = self._side(last)
        places = solve_chain(
            self.root,
            lengths[:last],
            self.targets[handles[last]].position,
            [self._start(each) for each in handles[1 : last + 1]],
            side,
        )
        if last < len(lengths):
            before = (self.root, *places)[-2]
            turn = (places[-1] - before) / (
                self.joints[handles[last]] - self.joints[handles[last - 1]]
            )
            turn /= abs(turn)
            rest = [self.joints[each] - self.joints[handles[last]] for each in handles[last + 1 :]]
            places += [places[-1] + turn * way for way in rest]
        sides = [side if len(lengths) == 2 else None] * (len(lengths) - 1) + [None]
        return dict(zip(handles[1:], zip(places, sides, strict=True), strict=True))

    def _start(self, identity: int) -> complex:
        """Return the place of a handle from which its chain is solved."""
        if identity in self.moved:
            return self.targets[identity].position
        return self.joints[identity] + self.root - self.joints[self.limb.chain.root]

    def _side(self, last: int) -> int:
        """Return the side to which the joints up to the last one bend."""
        handles = self.limb.chain.handles[: last + 1]
        if len(handles) < 3:
            handles = self.limb.chain.handles
        if len(handles) < 3:
            return 1
        middle = handles[1]
        given, before = self.targets[middle], self.start.get(middle)
        present = bend_side(*(self.joints[each] for each in handles[:3]))
        sides = [given.side, present, bend_side(*self.limb.places[:3]), 1]
        if middle in self.moved and (before is None or before.side == given.side):
            sides.insert(0, bend_side(self.root, given.position, self.targets[handles[2]].position))
        return next(side for side in sides if side)


class _RigidMotion(NamedTuple):
    """The rigid motion that brings places nearest to others, and the largest distance left."""

    centre: complex
    turn: complex
    wanted: complex
    misfit: float

    @classmethod
    def fit(cls, places: Complexes, wanted: Complexes) -> "_RigidMotion":
        centre, to = complex(places.mean()), complex(wanted.mean())
        product = complex(np.vdot(places - centre, wanted - to))
        turn = product / abs(product) if product else 1.0
        misfit = np.abs(wanted - to - turn * (places - centre)).max()
        return cls(centre, turn, to, float(misfit))

    def apply(self, places: Complexes) -> Complexes:
        moved: Complexes = self.wanted + self.turn * (places - self.centre)
        return moved


def _places(targets: Mapping[int, Target], identities: list[int]) -> Complexes:
    return np.array([targets[identity].position for identity in identities], np.complex128)
