"""Motions of bodies with limbs: turning joints, and feet that step."""

import cmath
import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from engine.geometry.motions.body import Body, plain
from engine.geometry.motions.curves import STEADY, Periodic, covering
from engine.geometry.motions.motion import Choreography, Parameters, Performance, Posture
from engine.geometry.motions.steps import GROUND, Gait, bent, leg_of, room_below

SAMPLES = 96  # of a cycle, at which the lowest place of the hips is looked for


@dataclass(frozen=True, slots=True, kw_only=True)
class Limbs(Choreography):
    """Angles of bones over a cycle, and where feet are set.

    Angles are in degrees, beside the drawing's own pose: by how much the bone that ends at a joint
    turns against what it hangs on. Of the trunk, and of all limbs from the side, they are forwards
    where positive: legs and arms swing ahead, heads and chests lean back. From the front limbs go
    up and out. Those of the left side hold for both; the right one is later by `lag` cycles.
    """

    turns: Mapping[str, Periodic] = field(default_factory=dict)
    # Instead of those above, of joints of one side alone, such as the hand that waves.
    single: Mapping[str, Periodic] = field(default_factory=dict)
    lag: float = 0.5
    rise: Periodic = STEADY  # of the hips, in lengths of a leg
    shift: Periodic = STEADY  # of the hips, forwards, likewise
    gait: Gait | None = None
    needed: tuple[str, ...] = ()

    @property
    def travels(self) -> bool:
        """Whether it has steps by which a body gets on."""
        return self.gait is not None and self.gait.stride > 0

    def performed(self, body: Body, parameters: Parameters) -> Performance:
        """Return what it does with a body."""
        return _Performed(self, body, parameters)


class _Performed(Performance):
    """Turning joints and stepping feet of one body."""

    def __init__(self, course: Limbs, body: Body, parameters: Parameters) -> None:
        self.course, self.body, self.parameters = course, body, parameters
        falls = () if course.gait is None else course.gait.falls
        self.legs = {foot: leg_of(body, foot) for foot, _ in falls if foot in body.joints}
        self.hips = next(iter(body.joints))
        tall = (body.box[1] - body.box[0]).imag
        self.reach = min((leg.length for leg in self.legs.values()), default=tall / 3)
        self.lowered = STEADY
        if self.legs:
            # Standing feet are within reach of their legs at all times.
            phases = np.arange(SAMPLES) / SAMPLES
            self.lowered = covering([self._room(phase) for phase in phases.tolist()])

    @property
    def stride(self) -> float:
        """How far the body gets on over a cycle, to the right."""
        gait = self.course.gait
        return 0.0 if gait is None else self.body.facing * self._strides(gait)

    def at(self, phase: float) -> Posture:
        """Return where the joints are."""
        places = self._trunk_and_arms(phase)
        gait, turns, standing = self.course.gait, {}, set()
        for foot, leg in self.legs.items():
            places[foot] = self._foot(foot, phase)
            places |= bent(leg, places[leg.joints[0]], places[foot])
            if gait is not None:
                down = gait.rolled(foot, phase) * self.parameters.size
                turns[foot] = -self.body.facing * math.radians(down)
                standing |= {foot} if gait.stands(foot, phase) else set()
        return Posture(places, turns, frozenset(standing))

    def _room(self, phase: float) -> float:
        """Return by how much the hips are too high at a moment."""
        gait = self.course.gait
        if gait is None:
            return 0.0
        places = self._trunk_and_arms(phase)
        return max(
            (
                room_below(leg, places[leg.joints[0]], self._foot(foot, phase))
                for foot, leg in self.legs.items()
                if gait.stands(foot, phase)
            ),
            default=0.0,
        )

    def _trunk_and_arms(self, phase: float) -> dict[str, complex]:
        """Return where all joints are that no step moves."""
        body, course = self.body, self.course
        amount = self.parameters.size * self.parameters.energy * self.reach
        moved = body.facing * course.shift(phase) + 1j * course.rise(phase)
        places = {self.hips: body.joints[self.hips] + amount * moved - 1j * self.lowered(phase)}
        turned = {self.hips: self._turn(self.hips, phase)}
        stepping = {name for leg in self.legs.values() for name in leg.joints[1:]}
        for name, before in list(body.parents.items())[1:]:
            if name in stepping:
                continue
            turned[name] = turned[before] + self._turn(name, phase)
            bone = body.joints[name] - body.joints[before]
            places[name] = places[before] + bone * cmath.exp(1j * turned[name])
        return places

    def _turn(self, name: str, phase: float) -> float:
        """Return by how much a joint's bone turns against what it hangs on, in radians."""
        course, kept = self.course, plain(name)
        has_side = kept != name
        late = course.lag if name.endswith(".R") else 0.0
        curve = course.turns.get(kept)
        if name in course.single:
            curve, late = course.single[name], 0.0
        if curve is None:
            return 0.0
        way = self.body.facing
        if has_side and self.body.kind.name == "biped-front":
            way = 1 if self.body.joints[name].real >= self.body.joints[self.hips].real else -1
        amount = self.parameters.size * (1.0 if has_side else self.parameters.energy)
        return way * amount * math.radians(curve(phase - late))

    def _strides(self, gait: Gait) -> float:
        return gait.stride * self.parameters.size * self.reach

    def _foot(self, foot: str, phase: float) -> complex:
        """Return where a foot is."""
        gait, rest = self.course.gait, self.body.joints[foot]
        if gait is None:
            return rest
        root = self.body.joints[self.legs[foot].joints[0]]
        lowest = min(self.body.joints[each].imag for each in self.legs)
        ground = rest.imag if rest.imag - lowest < GROUND * self.reach else lowest
        middle = rest.real + gait.gathered * (root.real - rest.real)
        ahead = self.body.facing * gait.ahead(foot, phase) * self._strides(gait)
        height = gait.lifted(foot, phase) * gait.lift * self.parameters.size * self.reach
        return complex(middle + ahead, ground + height)
