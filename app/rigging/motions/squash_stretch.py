"""Motions of whole bodies without joints: stretch, squash, lean and jump."""

import cmath
import math
from dataclasses import dataclass

from app.rigging.motions.body import Body
from app.rigging.motions.curves import STEADY, Periodic
from app.rigging.motions.motion import JointPose, MotionInstance, MotionTemplate, Parameters
from app.rigging.motions.timing import EVEN, Timing

# Points below this share of the height stay in place, and do not spread.
FOOT = 0.12


@dataclass(frozen=True, slots=True, kw_only=True)
class SquashStretch(MotionTemplate):
    """Shares of the height by which a body stretches and rises, and degrees by which its top leans.

    Stretch keeps the area: width shrinks as height grows. Only `swell` changes the area.
    """

    stretch: Periodic = STEADY
    swell: Periodic = STEADY
    rise: Periodic = STEADY
    lean: Periodic = STEADY  # of the top, to the right, in degrees

    def instantiate(
        self, body: Body, parameters: Parameters, _timing: Timing = EVEN
    ) -> MotionInstance:
        return _SquashStretchInstance(self, body, parameters)


class _SquashStretchInstance(MotionInstance):
    def __init__(self, template: SquashStretch, body: Body, parameters: Parameters) -> None:
        self.template, self.body, self.parameters = template, body, parameters
        low, high = body.box
        self.tall = (high - low).imag
        self.base = complex((low + high).real / 2, low.imag)

    def pose_at(self, phase: float) -> JointPose:
        template, size = self.template, self.parameters.size
        stretch = 1 + size * self.parameters.energy * template.stretch(phase)
        swell = size * template.swell(phase)
        rise = size * self.tall * template.rise(phase)
        lean = -self.body.facing * size * math.radians(template.lean(phase))
        places, standing = {}, set()
        for name, place in self.body.joints.items():
            beside = place - self.base
            height = beside.imag / self.tall
            # Feet keep their places on the ground while the body above spreads.
            free = min(1.0, max(0.0, (height - FOOT) / 0.3))
            free = free * free * (3 - 2 * free)
            wide = 1 + free * ((1 + swell) / math.sqrt(stretch) - 1)
            moved = complex(beside.real * wide, beside.imag * stretch * (1 + swell / 2))
            turned = moved * cmath.exp(1j * lean * height * free)
            places[name] = self.base + turned + 1j * rise
            if height <= FOOT and abs(rise) <= 1e-9 * self.tall:
                standing.add(name)
        return JointPose(places, {}, frozenset(standing))
