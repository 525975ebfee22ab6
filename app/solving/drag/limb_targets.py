"""Targets of limbs: joints follow the ends of their chains, and hips carry the body."""

from cmath import phase
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from app.document import Layer, LimbChain, Limbs, Target
from app.rigging import bend_side, solve_chain
from app.solving.drag.limbs import PosedLimbs
from engine.arrays import Complexes
from engine.geometry import Similarity, diameter

# Part of the shape's diameter: places that are off a rigid motion by less move as a whole.
RIGID = 2e-3
WIDE = 2.0  # half widths of a limb: a body is wider


class LimbTargets(NamedTuple):
    """Targets of handles, and the angles wanted of the rigid parts at ends of limbs, by handle."""

    targets: Mapping[int, Target]
    angles: Mapping[int, float]


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
    roots, on_body = _roots(limbs), _handles_of_body(layer, limbs)
    body = sorted(identity for identity in on_body if identity in start)
    moved = [identity for identity in body if start[identity] != targets[identity]]
    if not moved or len(body) < len(on_body):
        return BodyTargets(targets, is_rigid=not moved and bool(body))
    most = RIGID * diameter(layer.domain.outline)
    if roots.issuperset(moved) and not layer.has_parent:
        ways = _places(start, moved), _places(targets, moved)
        motion = Similarity.fit_rigid_motion(*ways)
        if _misfit(motion, *ways) <= most:
            carried = [i for i in body if i not in moved and not layer.is_locked(i)]
            places = motion.apply(_places(start, carried)).tolist()
            targets = {
                **targets,
                **{
                    identity: replace(targets[identity], position=place)
                    for identity, place in zip(carried, places, strict=True)
                },
            }
    ways = _places(start, body), _places(targets, body)
    return BodyTargets(targets, is_rigid=_misfit(Similarity.fit_rigid_motion(*ways), *ways) <= most)


def is_body_held_by_one(layer: Layer, limbs: Limbs, targets: Mapping[int, Target]) -> bool:
    """Return whether the body has a single handle, without a rotation of its own.

    The body then keeps its rotation, which nothing else holds. What is no wider than the limb is
    the limb's own end, which turns with its bone.
    """
    handles = _handles_of_body(layer, limbs)
    if len(handles) != 1 or any(targets[i].rotation is not None for i in handles):
        return False
    first = limbs.limbs[0]
    root, joint = first.places[:2]
    across = np.abs(((limbs.body - root) * (joint - root).conjugate()).imag) / abs(joint - root)
    return bool(across.max(initial=0.0) > WIDE * first.shapes[0].half_width)


def solve_limbs(
    layer: Layer,
    limbs: PosedLimbs,
    start: Mapping[int, Target],
    targets: Mapping[int, Target],
) -> LimbTargets:
    """Return the targets with those of all chains where kinematics has them.

    The joints of a dragged end follow it. Bones beyond a dragged joint turn with it, and a locked
    end stays. The rigid part at an end has the angle of its target. Without one it turns with its
    bone if it is dragged, and otherwise keeps its angle, as a foot on the ground does.
    """
    solved, angles, joints = dict(targets), dict[int, float](), limbs.start.places
    for limb in limbs.limbs.limbs:
        handles = limb.chain.handles
        moved = {i for i in handles if _position(start.get(i)) != targets[i].position}
        place = solved[limb.chain.root].position
        chain = _Chain(limb, joints, start, targets, frozenset(moved), place)
        is_end_locked = layer.is_locked(limb.chain.end)
        found = chain.solved(is_end_locked=is_end_locked)
        for identity, (place, side) in found.items():
            solved[identity] = replace(solved[identity], position=place, side=side)
        end, before = limb.chain.end, limb.chain.handles[-2]
        if end in limbs.start.angles:
            given, is_carried = targets[end].rotation, chain.carries_end and not is_end_locked
            angle = limbs.start.angles[end] if given is None else given
            if is_carried or (given is None and end in moved):
                way = solved[end].position - solved[before].position
                angle += phase(way / (joints[end] - joints[before]))
            angles[end] = angle
            if given is not None:
                solved[end] = replace(solved[end], rotation=angle)
    return LimbTargets(solved, angles)


def straighten_flipping(
    limbs: Limbs, joints: Mapping[int, complex], targets: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return the targets with limbs straight that still bend to the other side.

    A limb changes its side through its straight pose, where its end leaves its target for a while.
    `joints` are the present places of the chains' handles.
    """
    straight = dict(targets)
    for limb in limbs.limbs:
        handles = limb.chain.handles
        wanted, present = (
            [
                bend_side(*(places[i] for i in triple))
                for triple in zip(handles, handles[1:], handles[2:], strict=False)
            ]
            for places in ({i: targets[i].position for i in handles}, joints)
        )
        products = [one * other for one, other in zip(wanted, present, strict=True)]
        if min(products, default=0) < 0 and max(products) <= 0:
            root, end = (targets[i].position for i in (handles[0], handles[-1]))
            way, done = (end - root) / (abs(end - root) or 1.0), 0.0
            for identity, length in zip(handles[1:], limb.lengths, strict=True):
                done += length
                straight[identity] = replace(targets[identity], position=root + done * way)
    return straight


@dataclass(frozen=True, slots=True, eq=False)
class _Chain:
    """A chain at the start of a drag, and where its handles are wanted."""

    limb: LimbChain
    joints: Mapping[int, complex]
    start: Mapping[int, Target]
    targets: Mapping[int, Target]
    moved: frozenset[int]
    root: complex

    @property
    def carries_end(self) -> bool:
        """Whether a dragged joint turns the bones beyond it."""
        _root, *inner, end = self.limb.chain.handles
        return end not in self.moved and not self.moved.isdisjoint(inner)

    def solved(self, *, is_end_locked: bool) -> dict[int, tuple[complex, int | None]]:
        """Return the place and the side of each handle after the root."""
        handles, lengths = self.limb.chain.handles, self.limb.lengths
        if len(lengths) > 2 and any(map(self._is_flipped, handles[1:-1])):
            return self._mirrored().solved(is_end_locked=is_end_locked)
        last = len(lengths)
        if self.carries_end and not is_end_locked:
            last = max(i for i, each in enumerate(handles[1:-1], 1) if each in self.moved)
        side = self._side(last)
        places = solve_chain(
            self.root,
            lengths[:last],
            self.targets[handles[last]].position,
            [*map(self._start, handles[1:last]), self._carried(handles[last])],
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

    def _is_flipped(self, identity: int) -> bool:
        """Whether a joint gets another side than at the start."""
        before, given = self.start.get(identity), self.targets[identity].side
        return given is not None and (before is None or before.side != given)

    def _mirrored(self) -> "_Chain":
        """Return the chain with its joints mirrored at the way from root to end."""
        root, end = (self.joints[i] for i in (self.limb.chain.root, self.limb.chain.end))
        way = end - root
        joints = {
            i: root + way * ((self.joints[i] - root) / way).conjugate()
            for i in self.limb.chain.handles
        }
        return replace(self, joints={**self.joints, **joints}, start=self.targets)

    def _start(self, identity: int) -> complex:
        """Return the place of a handle from which its chain is solved."""
        if identity in self.moved:
            return self.targets[identity].position
        return self._carried(identity)

    def _carried(self, identity: int) -> complex:
        """Return the place of a handle if the chain moves with its root."""
        return self.joints[identity] + self.root - self.joints[self.limb.chain.root]

    def _side(self, last: int) -> int:
        """Return the side to which the joints up to the last one bend."""
        handles = self.limb.chain.handles[: last + 1]
        if len(handles) < 3:
            handles = self.limb.chain.handles
        if len(handles) < 3:
            return 1
        middle = handles[1]
        given = self.targets[middle]
        present = bend_side(*(self.joints[each] for each in handles[:3]))
        sides = [given.side, present, bend_side(*self.limb.places[:3]), 1]
        if middle in self.moved and not self._is_flipped(middle):
            sides.insert(0, bend_side(self.root, given.position, self.targets[handles[2]].position))
        return next(side for side in sides if side)


def _roots(limbs: Limbs) -> set[int]:
    """Return the handles at which chains start from the body."""
    return {limb.chain.root for limb in limbs.limbs if limb.parent is None}


def _handles_of_body(layer: Layer, limbs: Limbs) -> set[int]:
    """Return the handles that hold the body: those of no chain, and the roots."""
    of_chains = {handle for limb in limbs.limbs for handle in limb.chain.handles}
    free = {each.id for each in layer.handles} - of_chains - layer.sprung_handles
    return free | _roots(limbs)


def _position(target: Target | None) -> complex | None:
    return None if target is None else target.position


def _misfit(motion: Similarity, places: Complexes, wanted: Complexes) -> float:
    """Return the largest distance that a rigid motion leaves."""
    return float(np.abs(motion.apply(places) - wanted).max())


def _places(targets: Mapping[int, Target], identities: list[int]) -> Complexes:
    return np.array([targets[identity].position for identity in identities], np.complex128)
