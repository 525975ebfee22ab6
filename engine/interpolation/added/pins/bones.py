"""Bones during a segment: they keep their lengths, and turn by angles that are blended linearly.

Each bone moves as its points do, by their best rigid motion R(z) = c + u z, |u| = 1. At both
keyframes a bone has an angle against the one before it (the body, for a root), a place at its
joint, and a lack of rigidity f / u − p. In between these three are blended in the axes of the bone
before, so that nothing changes at the keyframes. The body moves as in the base. Where the end of a
chain of two bones is pinned, both bones turn further to bring it there.
"""

from cmath import exp, phase
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import sqrt
from typing import NamedTuple

import numpy as np

from engine.arrays import Complexes


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
    """

    parent: int
    parts: tuple[int, ...]
    joints: tuple[complex, ...]
    end: int


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
    ends : complex128, shape (2, p)
        Places of all points at the keyframes.
    chains : sequence of ChainOfBones
        Each after the chain that carries it.
    """

    rest: Sequence[Complexes]
    ends: Complexes
    chains: Sequence[ChainOfBones]

    @cached_property
    def at_keys(self) -> list[list[RigidPart]]:
        """The motions of all parts at both keyframes."""
        return [self._fit(places) for places in self.ends]

    def wanted(self, time: float, places: Complexes, pinned: Mapping[int, complex]) -> Complexes:
        """Return where the points (p,) are wanted.

        Parameters
        ----------
        places : complex128, shape (p,)
            Of the points in the base.
        pinned : mapping of int to complex
            Targets of pinned points, by number.
        """
        parts: dict[int, RigidPart] = {0: self._fit(places)[0]}
        for chain in self.chains:
            motions = self._blended(chain, time, parts[chain.parent])
            if chain.end in pinned and len(motions) == 2:
                motions = _brought_to(chain, motions, pinned[chain.end])
            parts |= zip(chain.parts, motions, strict=True)
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
            (first, last), (here, there) = (
                [key[number] for key in self.at_keys] for number in (own, earlier)
            )
            angles = first.turn / here.turn, last.turn / there.turn
            turn = motions[-1].turn * angles[0] * exp(1j * time * phase(angles[1] / angles[0]))
            gaps = [
                (part.at(joint) - base.at(joint)) / base.turn
                for part, base in ((first, here), (last, there))
            ]
            gap = motions[-1].turn * ((1 - time) * gaps[0] + time * gaps[1])
            lack = (1 - time) * first.lack + time * last.lack
            motions.append(RigidPart(joint, motions[-1].at(joint) + gap, turn, lack))
        return motions[1:]


def _brought_to(chain: ChainOfBones, motions: list[RigidPart], goal: complex) -> list[RigidPart]:
    """Return the motions of two bones, turned so that their end comes to a goal within reach."""
    root, joint, end = chain.joints
    upper, lower = motions
    start, knee, foot = upper.at(root), lower.at(joint), lower.at(end)
    first, second, way = abs(knee - start), abs(foot - knee), goal - start
    distance = abs(way)
    if not abs(first - second) < distance < first + second:
        return motions
    along = (distance**2 + first**2 - second**2) / (2 * distance)
    side = 1 if ((foot - start).conjugate() * (knee - start)).imag >= 0 else -1
    across = side * sqrt(max(first**2 - along**2, 0.0))
    bent = start + way / distance * complex(along, across)
    return [
        upper.turned(start, start, (bent - start) / (knee - start)),
        lower.turned(knee, bent, (goal - bent) / (foot - knee)),
    ]
