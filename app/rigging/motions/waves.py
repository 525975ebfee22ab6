"""Motions of chains: waves along the chain."""

import cmath
import math
from dataclasses import dataclass
from itertools import pairwise

from app.rigging.motions.body import Body
from app.rigging.motions.motion import JointPose, MotionInstance, MotionTemplate, Parameters
from app.rigging.motions.timing import EVEN, Timing

# A thick chain swings less: between links as long as half its width, it turns by so much at most.
THICK_TURN = 0.3  # radians
SAMPLES = 16  # of a cycle


@dataclass(frozen=True, slots=True, kw_only=True)
class Wave(MotionTemplate):
    """Links that swing one after the other, from the first joint to the last one."""

    degrees: float  # amplitude of each link
    waves: float  # number of waves on the chain at a time
    # Amplitude of the first link, as a share of the last link's.
    first: float = 1.0
    held: bool = False  # whether the first joint stays in place; else the mean of all joints
    needed: tuple[str, ...] = ("joint.1", "joint.2", "joint.3")

    def instantiate(
        self, body: Body, parameters: Parameters, _timing: Timing = EVEN
    ) -> MotionInstance:
        return _WaveInstance(self, body, parameters)


class _WaveInstance(MotionInstance):
    def __init__(self, template: Wave, body: Body, parameters: Parameters) -> None:
        self.template, self.parameters, self.facing = template, parameters, body.facing
        self.names = tuple(body.joints)
        self.rest = tuple(body.joints.values())
        self.most = math.radians(template.degrees) * self._fitting_share(_half_width(body))

    def pose_at(self, phase: float) -> JointPose:
        template = self.template
        most = self.facing * self.most * self.parameters.size
        places = [self.rest[0]]
        for bone, turn in zip(self._bones(), self._turns_at(phase), strict=True):
            places.append(places[-1] + bone * cmath.exp(1j * most * turn))
        if not template.held:
            off = sum(a - b for a, b in zip(self.rest, places, strict=True)) / len(places)
            places = [place + off for place in places]
        return JointPose(dict(zip(self.names, places, strict=True)), {}, frozenset())

    def _bones(self) -> list[complex]:
        return [end - start for start, end in pairwise(self.rest)]

    def _turns_at(self, phase: float) -> list[float]:
        """Return the turns of the links as shares of the largest."""
        template, links = self.template, len(self.rest) - 1
        # The amplitude grows towards the tip, faster with more energy.
        growth = (1 - template.first) * self.parameters.energy
        shares = [number / max(1, links - 1) for number in range(links)]
        return [
            (template.first + growth * share)
            * math.sin(math.tau * (phase - template.waves * share))
            for share in shares
        ]

    def _fitting_share(self, half_width: float) -> float:
        """Return the share of the swing at which a chain of this width bends well, at most 1."""
        lengths = [abs(bone) for bone in self._bones()]
        room = [THICK_TURN * min(pair) / half_width for pair in pairwise(lengths)]
        bends = [
            max(abs(after - before) for before, after in at_joint)
            for at_joint in zip(
                *(pairwise(self._turns_at(number / SAMPLES)) for number in range(SAMPLES)),
                strict=True,
            )
        ]
        full = math.radians(self.template.degrees)
        shares = [most / (full * bend) for most, bend in zip(room, bends, strict=True) if bend > 0]
        return float(min([1.0, *shares]))


def _half_width(body: Body) -> float:
    """Return half the width of a chain's drawing across its line from end to end."""
    places = list(body.joints.values())
    way = places[-1] - places[0]
    box = body.box[1] - body.box[0]
    across = 1j * way / abs(way) if way else 1j
    wide = abs(across.real) * box.real + abs(across.imag) * box.imag
    along = [(place * across.conjugate()).real for place in places]
    return max((wide - (max(along) - min(along))) / 2, 1e-9 * abs(box))
