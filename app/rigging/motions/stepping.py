"""Positions of the feet of one body over a cycle, and the height of its hips."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from app.rigging.motions.body import Body, other_side
from app.rigging.motions.motion import Parameters
from app.rigging.motions.steps import BodyLeg, Gait, find_leg, required_drop

GROUND = 0.15  # of a leg's length: feet drawn no higher than this above the lowest foot stand
# Legs of one drawing cannot pass through each other. Feet of a pair come at most this near, in
# lengths of a leg, and are set this much farther apart than they are drawn.
CLEAR, SPREAD = 0.14, 0.22
# Of a leg's length: the hips come down at most this much for a long step, else the step becomes
# shorter. Without the limit the body would crouch, with all legs bent.
LOWERED, SHORTER = 0.05, 0.9


class FootSteps:
    def __init__(self, body: Body, gait: Gait, parameters: Parameters) -> None:
        if not (gait.is_treadmill or parameters.travel):
            gait = replace(gait, stride=0.0)
        self.body, self.gait, self.size = body, gait, parameters.size
        feet = [foot for foot, _ in gait.landings if foot in body.joints]
        self.legs: dict[str, BodyLeg] = {foot: find_leg(body, foot) for foot in feet}
        self.reach = min(leg.length for leg in self.legs.values()) if feet else 0.0
        lowest = min((body.joints[foot].imag for foot in feet), default=0.0)
        # A foot that is drawn lifted, as in a stride, comes down to the ground.
        self.ground = {
            foot: lowest if body.joints[foot].imag - lowest >= GROUND * self.reach else y
            for foot, y in ((foot, body.joints[foot].imag) for foot in feet)
        }
        self.step = self._step()
        self.middles = self._middles()
        while self.step > SHORTER * CLEAR * self.reach and self._most_lowered() > LOWERED:
            self.step *= SHORTER
            self.middles = self._middles()

    @property
    def stride(self) -> float:
        """Distance that the body moves forwards in a cycle, in pixels."""
        return self.step / self.gait.stance

    @property
    def raised(self) -> float:
        """Height of the hips over a foot below them, above the drawn height.

        Legs that are drawn apart are longer than the hips are high; legs that are drawn bent stay
        bent.
        """
        if not self.legs or not self.gait.stride:
            return 0.0
        joints, up = self.body.joints, []
        for foot, leg in self.legs.items():
            root = joints[leg.joints[0]]
            away = min(abs(root - joints[foot]), self.gait.straight * leg.length)
            up.append(away - (root.imag - self.ground[foot]))
        return float(np.mean(up))

    def foot(self, foot: str, phase: float) -> complex:
        gait = self.gait
        ahead = self.body.facing * gait.ahead(foot, phase) * self.stride
        height = gait.lifted(foot, phase) * gait.lift * self.size * self.reach
        return complex(self.middles[foot] + ahead, self.ground[foot] + height)

    def _pairs(self) -> Iterator[tuple[str, str]]:
        """Yield the pairs of feet that pass each other, the rear foot first."""
        falls = dict(self.gait.landings)
        for foot in self.legs:
            other = other_side(foot)
            if other == foot or other not in self.legs or falls[foot] == falls[other]:
                continue
            behind = self.body.facing * (self.body.joints[other] - self.body.joints[foot]).real
            if behind > 0 or (behind == 0 and foot > other):
                yield foot, other

    def _apart(self, pair: tuple[str, str]) -> float:
        """Return the distance of a pair of feet as drawn."""
        return abs((self.body.joints[pair[0]] - self.body.joints[pair[1]]).real)

    def _step(self) -> float:
        """Return the distance that a foot covers while it stands, within its room."""
        wanted = self.gait.stride * self.gait.stance * self.size * self.reach
        rooms = [self._apart(pair) + (SPREAD - CLEAR) * self.reach for pair in self._pairs()]
        return min([wanted, *rooms])

    def _most_lowered(self) -> float:
        """Return how much the hips come down to reach the ends of a step, in lengths of a leg."""
        lowered = [0.0]
        for foot, leg in self.legs.items():
            root = self.body.joints[leg.joints[0]]
            for way in (-1, 1):
                tip = complex(self.middles[foot] + way * self.step / 2, self.ground[foot])
                lowered.append(required_drop(leg, root, tip, self.gait.straight))
        return max(lowered) / self.reach

    def _middles(self) -> dict[str, float]:
        """Return the centre of each foot's movement."""
        joints, gathered = self.body.joints, self.gait.gathered
        middles = {}
        for foot, leg in self.legs.items():
            rest, root = joints[foot].real, joints[leg.joints[0]].real
            middles[foot] = rest + gathered * (root - rest)
        for behind, ahead in self._pairs() if self.gait.stride else ():
            apart = max(abs(middles[ahead] - middles[behind]), self.step + CLEAR * self.reach)
            middle = (middles[behind] + middles[ahead]) / 2
            middles[behind] = middle - self.body.facing * apart / 2
            middles[ahead] = middle + self.body.facing * apart / 2
        return middles
