"""Bones during a segment: they keep their lengths, and turn by angles that are blended.

Each bone moves as its points do, by their best rigid motion R(z) = c + u z, |u| = 1. At each
keyframe a bone has an angle against the one before it (the body, for a root), a place at its
joint, and a lack of rigidity f / u − p. In between these three are blended in the axes of the bone
before, with the time weights of the base, so that nothing changes at the keyframes and angles go
through them at one velocity where the base does. The body moves as in the base. Where the end of a
chain of two bones is pinned, both bones turn further to bring it there.

A foot, a hand or a head is one more part at the end of a chain, and moves like a bone. With an
angle of its own its angle in the drawing's axes is blended instead. A pinned one goes from place to
place, and from angle to angle, by 3t² − 2t³, or evenly on ground that moves: a foot that stands
does not begin to roll because it rolls after the next keyframe.
"""

from cmath import exp, phase
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from math import pi, sqrt
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes, Floats
from engine.interpolation.time_weights.weights import TimeWeights


class ChainOfBones(NamedTuple):
    """Bones that follow each other, with numbers of rigid parts; part 0 is the body.

    Parameters
    ----------
    parent : int
        The part that carries the root.
    parts : tuple of int
        The parts of the bones.
    joints : tuple of complex
        The root, the joints and the end in the drawing.
    end : int
        Number of the pinned point at the end.
    end_part : int or None
        The rigid part at the end; without it the end is the last point of the last bone.
    has_own_angle : bool
        Whether the end part's angle is blended in the drawing's axes.
    """

    parent: int
    parts: tuple[int, ...]
    joints: tuple[complex, ...]
    end: int
    end_part: int | None = None
    has_own_angle: bool = False


class RigidPart(NamedTuple):
    """A rigid motion of a part, z → place + turn (z − drawn), and what its points lack of it."""

    drawn: complex
    place: complex
    turn: complex
    lack: Complexes

    @classmethod
    def fit(cls, rest: Complexes, places: Complexes) -> "RigidPart":
        centre, mean = complex(rest.mean()), complex(places.mean())
        product = complex(np.vdot(rest - centre, places - mean))
        turn = product / abs(product) if product else 1.0 + 0j
        return cls(centre, mean, turn, (places - mean) / turn - (rest - centre))

    def at(self, z: complex) -> complex:
        return self.place + self.turn * (z - self.drawn)

    def turned(self, about: complex, to: complex, turn: complex) -> "RigidPart":
        """Return the motion followed by a rotation that brings one place to another."""
        place = to + turn * (self.place - about)
        return self._replace(place=place, turn=turn * self.turn)


@dataclass(frozen=True, kw_only=True, eq=False)
class SegmentBones:
    """The bones of a shape in a segment.

    Parameters
    ----------
    rest : sequence of complex128 arrays
        The points of each part in the drawing; those of the body first.
    places : complex128, shape (q, p)
        Places of all points at the keyframes that have a time weight.
    chains : sequence of ChainOfBones
        Each after the chain that carries it.
    revolutions : sequence of int
        Additional whole turns of the body between neighbours of these keyframes, and then from or
        to those of one-sided tangents.
    time_weights : TimeWeights
        Weights of the keyframes; the linear blend of two by default.
    """

    rest: Sequence[Complexes]
    places: Complexes
    chains: Sequence[ChainOfBones]
    revolutions: Sequence[int] = (0,)
    time_weights: TimeWeights = field(default_factory=TimeWeights.straight)

    @cached_property
    def at_keys(self) -> list[list[RigidPart]]:
        """The motions of all parts at the keyframes."""
        return [self._fit(places) for places in self.places]

    @property
    def at_ends(self) -> tuple[list[RigidPart], list[RigidPart]]:
        """The motions of all parts at the two keyframes of the segment."""
        first = self.time_weights.first
        return self.at_keys[first], self.at_keys[first + 1]

    @cached_property
    def _steps(self) -> list[tuple[int, int, int]]:
        """Pairs of keyframes with the whole turns between them; the first of all is known."""
        weights, turns = self.time_weights, list(self.revolutions)
        first, count = weights.first, weights.count - sum(weights.one_sided)
        steps = [(i, i + 1, turns[i]) for i in range(first, count - 1)]
        steps += [(i, i - 1, -turns[i - 1]) for i in range(first, 0, -1)]
        outer = zip(range(count, weights.count), turns[count - 1 :], strict=True)
        for middle, sign, is_apart in zip(
            (first, first + 1), (1, -1), weights.one_sided, strict=True
        ):
            if is_apart:
                other, whole = next(outer)
                steps.append((middle, other, sign * whole))
        return steps

    def wanted(
        self,
        time: float,
        places: Complexes,
        pinned: Mapping[int, complex],
        even: Collection[int] = (),
    ) -> Complexes:
        """Return where the points (p,) are wanted.

        Parameters
        ----------
        places : complex128, shape (p,)
            Of the points in the base.
        pinned : mapping of int to complex
            Targets of pinned points, by number.
        even : collection of int
            Numbers of pinned points that move evenly.
        """
        parts: dict[int, RigidPart] = {0: self._fit(places)[0]}
        for chain in self.chains:
            motions = self._blended(chain, time, parts[chain.parent])
            goal = pinned.get(chain.end)
            share = time if chain.end in even else time * time * (3 - 2 * time)
            if goal is not None and chain.end_part is not None:
                goal = self._pinned_place(chain, share)
            if goal is not None and len(motions) == 2:
                lack = self._end_lack(chain, time, motions[-1])
                motions = _brought_to(chain, motions, goal - lack, self._side(chain))
            parts |= zip(chain.parts, motions, strict=True)
            if chain.end_part is not None:
                is_pinned = goal is not None
                end = self._end(chain, time, motions[-1], share if is_pinned else None)
                parts[chain.end_part] = end if goal is None else end._replace(place=goal)
        # The body's points are where they are.
        wanted = [places[: len(self.rest[0])]]
        for number, rest in enumerate(self.rest[1:], 1):
            part = parts[number]
            wanted.append(part.place + part.turn * (rest - part.drawn + part.lack))
        return np.concatenate(wanted)

    def _fit(self, places: Complexes) -> list[RigidPart]:
        starts = np.cumsum([len(rest) for rest in self.rest])[:-1]
        split = np.split(places, starts)
        return [RigidPart.fit(rest, own) for rest, own in zip(self.rest, split, strict=True)]

    def _blended(self, chain: ChainOfBones, time: float, before: RigidPart) -> list[RigidPart]:
        """Return the motions of a chain's bones, by blended angles."""
        numbers, motions = (chain.parent, *chain.parts), [before]
        for earlier, own, joint in zip(numbers, chain.parts, chain.joints, strict=False):
            motions.append(self._blended_part(own, earlier, joint, time, motions[-1]))
        return motions[1:]

    def _blended_part(
        self, own: int, earlier: int, joint: complex, time: float, before: RigidPart
    ) -> RigidPart:
        """Return the motion of a part on the one before it, which moves by `before`."""
        weights, pairs = self.time_weights(time), [(key[own], key[earlier]) for key in self.at_keys]
        first, here = pairs[self.time_weights.first]
        swept = float(weights @ self._relative_turns(own, earlier))
        turn = before.turn * first.turn / here.turn * exp(1j * swept)
        gaps = np.array([(part.at(joint) - base.at(joint)) / base.turn for part, base in pairs])
        gap = before.turn * complex(weights @ gaps)
        lack = weights @ np.array([part.lack for part, _ in pairs])
        return RigidPart(joint, before.at(joint) + gap, turn, lack)

    def _end(
        self, chain: ChainOfBones, time: float, before: RigidPart, share: float | None
    ) -> RigidPart:
        """Return the motion of the rigid part at a chain's end, at a share of its way if pinned."""
        own, joint = chain.end_part or 0, chain.joints[-1]
        end = self._blended_part(own, chain.parts[-1], joint, time, before)
        if chain.has_own_angle or share is not None:
            numbers = (0, *self._parts_to_end(chain), own)
            swept = self._body_turns + sum(
                self._relative_turns(*pair) for pair in zip(numbers[1:], numbers, strict=False)
            )
            first = self.time_weights.first
            turn = float(
                self.time_weights(time) @ swept if share is None else share * swept[first + 1]
            )
            end = end._replace(turn=self.at_ends[0][own].turn * exp(1j * turn))
        return end

    def _pinned_place(self, chain: ChainOfBones, share: float) -> complex:
        """Return the place of a pinned rigid part after a share of its way."""
        first, last = (key[chain.end_part or 0].at(chain.joints[-1]) for key in self.at_ends)
        return first + share * (last - first)

    def _parts_to_end(self, chain: ChainOfBones) -> tuple[int, ...]:
        """Return the parts between the body and a chain's end."""
        before = next((each for each in self.chains if chain.parent in each.parts), None)
        return (*(self._parts_to_end(before) if before is not None else ()), *chain.parts)

    def _relative_turns(self, own: int, earlier: int) -> Floats:
        """Return by how much a part is turned against another at the keyframes, float64 (q,).

        It is 0 at the segment's first one, and turns the shorter way from there on.
        """
        turns = [key[own].turn / key[earlier].turn for key in self.at_keys]
        return self._unwrapped(turns, is_body=False)

    @property
    def _body_turns(self) -> Floats:
        """Return by how much the body is turned at the keyframes, as for other parts."""
        return self._unwrapped([key[0].turn for key in self.at_keys], is_body=True)

    def _unwrapped(self, turns: Sequence[complex], *, is_body: bool) -> Floats:
        angles = np.zeros(len(turns))
        for known, other, whole in self._steps:
            step = phase(turns[other] / turns[known]) + (2 * pi * whole if is_body else 0.0)
            angles[other] = angles[known] + step
        return angles

    def _side(self, chain: ChainOfBones) -> int:
        """Return the side to which two bones bend at both keyframes, 0 if they change it."""
        sides = {_bend_side(chain, [key[part] for part in chain.parts]) for key in self.at_ends}
        return sides.pop() if len(sides) == 1 else 0

    def _end_lack(self, chain: ChainOfBones, time: float, last: RigidPart) -> complex:
        """Return what the last bone lacks to bring the chain's end to its place."""
        if chain.end_part is None:
            return last.turn * complex(last.lack[-1])
        joint, bone, end = chain.joints[-1], chain.parts[-1], chain.end_part
        lacks = np.array(
            [(key[end].at(joint) - key[bone].at(joint)) / key[bone].turn for key in self.at_keys]
        )
        return complex(last.turn * (self.time_weights(time) @ lacks))


def _bend_side(chain: ChainOfBones, motions: Sequence[RigidPart]) -> int:
    """Return the side of the way from root to end on which the joint of two bones is."""
    root, joint, end = chain.joints
    upper, lower = motions
    start, knee, foot = upper.at(root), lower.at(joint), lower.at(end)
    return 1 if ((foot - start).conjugate() * (knee - start)).imag >= 0 else -1


def _brought_to(
    chain: ChainOfBones, motions: list[RigidPart], goal: complex, side: int
) -> list[RigidPart]:
    """Return the motions of two bones, turned so that their end comes to a goal.

    Their joint stays on a side, and by 0 on its own one. Beyond reach they are straight towards the
    goal, so that nothing jumps where a leg is stretched out.
    """
    root, joint, end = chain.joints
    upper, lower = motions
    start, knee, foot = upper.at(root), lower.at(joint), lower.at(end)
    first, second, way = abs(knee - start), abs(foot - knee), goal - start
    least, most = abs(first - second), first + second
    distance = min(max(abs(way), least), most)
    if not (way and distance):
        return motions
    goal = start + way / abs(way) * distance
    along = (distance**2 + first**2 - second**2) / (2 * distance)
    across = (side or _bend_side(chain, motions)) * sqrt(max(first**2 - along**2, 0.0))
    bent = start + way / abs(way) * complex(along, across)
    return [
        upper.turned(start, start, (bent - start) / (knee - start)),
        lower.turned(knee, bent, (goal - bent) / (foot - knee)),
    ]
