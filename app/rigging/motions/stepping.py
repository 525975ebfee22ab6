"""Positions of the feet of one body over a cycle, and the height of its hips."""

import cmath
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from app.rigging.motions.body import Body, other_side
from app.rigging.motions.motion import Parameters
from app.rigging.motions.steps import BodyLeg, Gait, find_leg, required_drop, solve_leg_ik
from app.rigging.motions.timing import EVEN, Timing

GROUND = 0.3  # of a leg's length: feet drawn no higher than this above the lowest foot stand
# Of a leg's length: the hips come down at most this much for a long step, else the step becomes
# shorter. Without the limit the body would crouch, with all legs bent.
LOWERED, SHORTER = 0.06, 0.9
# Lengths of a leg by which the feet of a pair of free legs may come nearer than they are drawn, and
# farther apart; and the same for legs that are one above their crotch, in room there.
FREE_CLOSING, FREE_OPENING = 0.9, 0.9
CLOSING, OPENING = 0.03, 0.5
SAMPLES, TURN_SAMPLES = 48, 24  # of a cycle
SHORTEST = 0.1  # of a leg's length: shortest step
SHORTEST_LEG = 0.3  # of a leg's length: shortest distance of a foot from the root of a folded leg
COMMON = 1.0  # share by which feet of a pair, from the side, are gathered below both their roots

# Radians by which a leg turns at its root from how it is drawn. Beyond, the drawing stretches there
# to more than 2.5 times its length.
MOST_TURN = 0.65
# The same limits for runs: bodies sink more, and legs swing farther, each below its own root.
LOWERED_RUN, COMMON_RUN, MOST_RUN_TURN = 0.1, 0.5, 1.0


def largest_steps(gait: Gait, turn_of: Callable[[Gait], float]) -> Gait:
    """Return a gait with the largest steps that the drawn legs can do.

    `turn_of` returns the largest turn of a leg at its root with the steps of a gait. Legs may turn
    as far as they do without steps, as in a crouch.
    """
    usual = MOST_RUN_TURN if gait.fold else MOST_TURN
    most, fitted = max(usual, turn_of(gait.smaller(0.0))), gait
    for fitted in gait.smaller_gaits():
        if turn_of(fitted) <= most:
            break
    return fitted


class FootSteps:
    def __init__(
        self, body: Body, gait: Gait, parameters: Parameters, timing: Timing = EVEN
    ) -> None:
        if not (gait.is_treadmill or parameters.travel):
            gait = replace(gait, stride=0.0)
        self.body, self.gait, self.size, self.timing = body, gait, parameters.size, timing
        feet = [foot for foot, _ in gait.landings if foot in body.joints]
        self.legs: dict[str, BodyLeg] = {
            foot: find_leg(body, foot, is_as_drawn=gait.stance >= 1) for foot in feet
        }
        self.reach = min(leg.length for leg in self.legs.values()) if feet else 0.0
        lowest = min((body.joints[foot].imag for foot in feet), default=0.0)
        # A foot that is drawn lifted, as in a stride, comes down to the ground.
        self.ground = {
            foot: lowest if body.joints[foot].imag - lowest >= GROUND * self.reach else y
            for foot, y in ((foot, body.joints[foot].imag) for foot in feet)
        }
        self.middles = self._middles()
        self.step = gait.stride * gait.stance * self.size * self.reach
        lowered = LOWERED_RUN if gait.fold else LOWERED
        while self.step > SHORTEST * self.reach and self._most_lowered() > lowered:
            self.step *= SHORTER
        if body.kind.is_side_view and gait.stride:
            self._keep_pairs_open()

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
        ahead = gait.ahead(foot, phase, self.timing) * self.stride - gait.behind * self.step
        height = gait.lifted(foot, phase) * gait.lift * self.size * self.reach
        return complex(self.middles[foot] + self.body.facing * ahead, self.ground[foot] + height)

    def is_stretched(self, foot: str, phase: float) -> bool:
        """Whether a leg has to reach its foot: in a run only on the ground, up to both ends."""
        near = (-1 / SAMPLES, 0.0, 1 / SAMPLES)
        return not self.gait.fold or any(self.gait.stands(foot, phase + by) for by in near)

    def place(
        self, foot: str, phase: float, places_at: Callable[[float], Mapping[str, complex]]
    ) -> complex:
        """Return the place of a foot; a leg that folds swings about its root.

        `places_at` returns the places of the trunk's joints at a phase.
        """
        gait, leg = self.gait, self.legs[foot]
        if not gait.fold or gait.stands(foot, phase):
            return self.foot(foot, phase)
        root, share = leg.joints[0], gait.swung(foot, phase)
        off, down = (self.foot(foot, at) - places_at(at)[root] for at in gait.swing_ends(foot))
        # Legs point down: angles are measured from there.
        angle = gait.swing(foot, phase, cmath.phase(1j * off), cmath.phase(1j * down))
        length = abs(off) + share * (abs(down) - abs(off))
        length -= self.size * gait.folded(foot, phase) * leg.length
        length = max(length, SHORTEST_LEG * leg.length)
        return places_at(phase)[root] - 1j * cmath.rect(length, angle)

    def largest_turn(
        self, trunk_at: Callable[[float], tuple[Mapping[str, complex], Mapping[str, float]]]
    ) -> float:
        """Return the largest angle by which a leg turns at its root, against its trunk, in radians.

        `trunk_at` returns the places and the rotations of the trunk's joints at a phase.
        """
        largest, joints, trunk_at = 0.0, self.body.joints, cache(trunk_at)
        for phase in (np.arange(TURN_SAMPLES) / TURN_SAMPLES).tolist():
            places, turned = trunk_at(phase)
            for foot, leg in self.legs.items():
                root, second = leg.joints[:2]
                tip = self.place(foot, phase, lambda at: trunk_at(at)[0])
                end = solve_leg_ik(leg, places[root], tip).get(second, tip)
                turn = cmath.phase((end - places[root]) / (joints[second] - joints[root]))
                trunk = turned.get(self.body.parents[root], 0.0)
                largest = max(largest, abs(turn - trunk))
        return largest

    def _most_lowered(self) -> float:
        """Return how much the hips come down to reach the ends of a step, in lengths of a leg."""
        lowered = [0.0]
        for foot, leg in self.legs.items():
            root = self.body.joints[leg.joints[0]]
            for way in (-0.5, 0.5):
                ahead = self.body.facing * (way - self.gait.behind) * self.step
                tip = complex(self.middles[foot] + ahead, self.ground[foot])
                lowered.append(required_drop(leg, root, tip, self.gait.straight))
        return max(lowered) / self.reach

    def _keep_pairs_open(self) -> None:
        """Shorten the steps, and part the legs of a pair, until its crotch can follow.

        Legs of one drawing grow together above. They open more easily than they cross.
        """
        pairs = [
            (foot, other_side(foot))
            for foot in self.legs
            if other_side(foot) in self.legs and self._ahead(foot) > self._ahead(other_side(foot))
        ]
        for pair in pairs:
            passing = sum(self._passing(*pair))
            if passing > 0:
                room = sum(self._room(*pair))
                self.step = min(self.step, self.gait.stance * room / passing)
        for one, other in pairs:
            behind, _ = self._passing(one, other)
            drawn = self._ahead(one) - self._ahead(other)
            gathered = drawn - self.body.facing * (self.middles[one] - self.middles[other])
            apart = gathered + behind * self.stride - self._room(one, other)[0]
            if apart > 0:
                self.middles[one] += self.body.facing * apart / 2
                self.middles[other] -= self.body.facing * apart / 2

    def _passing(self, one: str, other: str) -> tuple[float, float]:
        """Return how far a foot comes behind and ahead of another, from its mean, in strides."""
        phases = (np.arange(SAMPLES) / SAMPLES).tolist()
        ahead = np.array(
            [
                self.gait.ahead(one, phase, self.timing)
                - self.gait.ahead(other, phase, self.timing)
                for phase in phases
            ]
        )
        return float(-ahead.min()), float(ahead.max())

    def _room(self, one: str, other: str) -> tuple[float, float]:
        """Return how far the feet of a pair can come nearer than they are drawn, and farther."""
        length = (self.legs[one].length + self.legs[other].length) / 2
        room = self.body.crotch_room.get(one, np.inf)
        return min(FREE_CLOSING * length, CLOSING * room), min(
            FREE_OPENING * length, OPENING * room
        )

    def _ahead(self, foot: str) -> float:
        """Return how far ahead a foot is drawn."""
        return self.body.facing * self.body.joints[foot].real

    def _middles(self) -> dict[str, float]:
        """Return the centre of each foot's movement.

        From the side, both feet of a pair are gathered towards the middle of their roots.
        """
        joints, gathered = self.body.joints, self.gait.gathered
        common = COMMON_RUN if self.gait.fold else COMMON
        middles = {}
        for foot, leg in self.legs.items():
            rest, root = joints[foot].real, joints[leg.joints[0]].real
            other = self.legs.get(other_side(foot))
            if self.body.kind.is_side_view and other is not None:
                root += common * (joints[other.joints[0]].real - root) / 2
            middles[foot] = rest + gathered * (root - rest)
        return middles
