"""Motions of chains: waves along the chain."""

import cmath
import math
from dataclasses import dataclass

from app.rigging.motions.body import Body
from app.rigging.motions.motion import JointPose, MotionInstance, MotionTemplate, Parameters
from app.rigging.motions.timing import EVEN, Timing


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

    def pose_at(self, phase: float) -> JointPose:
        template, links = self.template, len(self.rest) - 1
        most = self.facing * math.radians(template.degrees) * self.parameters.size
        # The amplitude grows towards the tip, faster with more energy.
        growth = (1 - template.first) * self.parameters.energy
        places = [self.rest[0]]
        for number in range(links):
            share = number / max(1, links - 1)
            swing = most * (template.first + growth * share)
            turn = swing * math.sin(math.tau * (phase - template.waves * share))
            bone = self.rest[number + 1] - self.rest[number]
            places.append(places[-1] + bone * cmath.exp(1j * turn))
        if not template.held:
            off = sum(a - b for a, b in zip(self.rest, places, strict=True)) / len(places)
            places = [place + off for place in places]
        return JointPose(dict(zip(self.names, places, strict=True)), {}, frozenset())
