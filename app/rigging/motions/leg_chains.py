"""Motions of bodies with limbs: rotating joints and stepping feet."""

import cmath
import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from app.rigging.motions.body import Body, other_side, without_side
from app.rigging.motions.curves import STEADY, ArmDirection, Periodic, count_swings, covering_curve
from app.rigging.motions.motion import (
    FollowingJoint,
    JointPose,
    MotionInstance,
    MotionTemplate,
    Parameters,
)
from app.rigging.motions.stepping import FootSteps, largest_steps
from app.rigging.motions.steps import Gait, required_drop, solve_leg_ik
from app.rigging.motions.timing import EVEN, Timing

FEET = (("foot.L", 0.0), ("foot.R", 0.0))
STANDING = Gait(stance=1.0, stride=0.0, lift=0.0, landings=FEET, gathered=0.0, straight=1.0)
# Factors by which a tail with a base swings more than one that turns at the hips: a tail of one
# bone, and the first bone of a longer one. Springs move the other bones, which swing farther.
TAIL_SWING, LEADING_SWING = 2.2, 0.9
TAIL_LAG = 0.25  # of a swing: the tip of a long tail is later than its first bone
LONGER = 1.3  # ratio of the lengths of arms of which the longer one waves
NECKLESS = 0.5  # share of the turn that a head without a neck keeps: it bends the whole trunk
SHORT_ARM = 0.5  # of a leg's length: arms shorter than this swing less
LEVEL_HEAD = 0.7  # of the trunk's lean, by which the head turns back
# Of a cycle: the lowest hips are searched at so many, and smoothed over a few; fewer in a run.
SAMPLES, SMOOTH, SMOOTH_RUN = 96, 7, 5


@dataclass(frozen=True, slots=True, kw_only=True)
class LimbMotion(MotionTemplate):
    """Angles of bones over a cycle, and steps of the feet.

    Angles are in degrees, relative to the drawing's own pose: the rotation of the bone that ends at
    a joint against its parent bone. On the trunk, and on limbs from the side, positive is forwards:
    legs and arms swing ahead, heads and chests lean back. From the front limbs go up and out.
    Angles of the left side apply to both sides; the right side is later by `lag` cycles.
    """

    turns: Mapping[str, Periodic] = field(default_factory=dict)
    # Rotations ahead or back, which are invisible from the front.
    leans: Mapping[str, Periodic] = field(default_factory=dict)
    # Shares by which bones of the trunk grow, such as those of a chest that swells.
    growth: Mapping[str, Periodic] = field(default_factory=dict)
    # Replace the angles above: of both sides, or of one, such as a waving arm.
    aims: Mapping[str, ArmDirection] = field(default_factory=dict)
    lag: float = 0.5
    rise: Periodic = STEADY  # of the hips, in lengths of a leg
    shift: Periodic = STEADY  # of the hips, forwards, in lengths of a leg
    gait: Gait | None = None
    needed: tuple[str, ...] = ()
    either: tuple[str, ...] = ()

    @property
    def can_travel(self) -> bool:
        """Whether its steps move the body forward."""
        return self.gait is not None and self.gait.stride > 0

    def part_parameters(self, kind: str, joints: Collection[str]) -> frozenset[str]:
        moved = self.turns.keys() | self.growth.keys() | set(map(without_side, self.aims))
        if kind != "biped-front":
            moved |= self.leans.keys()
        stepping = {} if self.gait is None else dict(self.gait.landings)
        arms = {without_side(name) for name in joints if other_side(name) != name}
        # From the side a head without a neck is a part of the trunk while legs step.
        has_head = "neck" in joints or kind == "biped-front" or not self.can_travel
        is_changed = {
            "lean": kind != "biped-front",
            "head_delay": has_head and bool({"neck", "head"} & moved & set(joints)),
            "arm_delay": bool({"elbow", "hand"} & moved & arms) and "hand.L" not in stepping,
            "tail_delay": "tail" in moved and "tail" in joints,
        }
        return frozenset(name for name, is_so in is_changed.items() if is_so)

    def instantiate(
        self, body: Body, parameters: Parameters, timing: Timing = EVEN
    ) -> MotionInstance:
        return _LimbInstance(self, body, parameters, timing)


class _LimbInstance(MotionInstance):
    """Rotating joints and stepping feet of one body."""

    def __init__(
        self, template: LimbMotion, body: Body, parameters: Parameters, timing: Timing
    ) -> None:
        self.template, self.body, self.parameters = template, body, parameters
        self.timing, self.hips = timing, next(iter(body.joints))
        self.is_first_side = self._prefers_first_side()
        gait = template.gait or STANDING
        if gait.stance < 1:
            self.parameters = replace(parameters, size=1.0)  # a larger size asks for more
            gait = largest_steps(gait, self._largest_turn)
            self.parameters = parameters
        self._step(gait)

    def _step(self, gait: Gait) -> None:
        """Take the steps of a gait, with the hips as high as the legs reach."""
        self.steps = FootSteps(self.body, gait, self.parameters, self.timing)
        self.reach = self.steps.reach or (self.body.box[1] - self.body.box[0]).imag / 3
        self.lowered = STEADY
        if self.steps.legs:
            # Feet are within reach of their legs at all times, so that legs keep their lengths.
            phases = np.arange(SAMPLES) / SAMPLES
            heights = [self._room(phase) for phase in phases.tolist()]
            self.lowered = covering_curve(heights, SMOOTH_RUN if gait.fold else SMOOTH)

    def _largest_turn(self, gait: Gait) -> float:
        """Return the largest turn of a leg at its root with the steps of a gait."""
        self._step(gait)
        return self.steps.largest_turn(self._trunk_and_arms)

    @property
    def stride(self) -> float:
        """Distance that the body moves to the right in a cycle."""
        return self.body.facing * self.steps.stride if self.template.can_travel else 0.0

    def pose_at(self, phase: float) -> JointPose:
        """Return the positions of the joints, and the rotations at the ends of limbs and trunk."""
        places, turned = self._trunk_and_arms(phase)
        gait, standing = self.steps.gait, set()
        inner = {before for name, before in self.body.parents.items()}
        turns = {name: turn for name, turn in turned.items() if name not in inner}
        trunk = {name: turned[name] for name in ("chest", "hips") if name in turned}
        turns |= dict.fromkeys(trunk, next(iter(trunk.values()), 0.0))
        for foot, leg in self.steps.legs.items():
            places[foot] = self.steps.place(foot, phase, lambda at: self._trunk_and_arms(at)[0])
            places |= solve_leg_ik(leg, places[leg.joints[0]], places[foot])
            down = gait.rolled(foot, phase) * self.parameters.size
            turns[foot] = -self.body.facing * math.radians(down)
            standing |= {foot} if gait.stands(foot, phase) else set()
        sides = {leg.joints[1]: leg.bend for leg in self.steps.legs.values() if leg.joints[2:]}
        return JointPose(places, turns, frozenset(standing), sides)

    def _room(self, phase: float) -> float:
        """Return how much the hips are too high at a moment."""
        places, _ = self._trunk_and_arms(phase)
        return max(
            (
                required_drop(
                    leg,
                    places[leg.joints[0]],
                    self.steps.foot(foot, phase),
                    self.steps.gait.straight,
                )
                for foot, leg in self.steps.legs.items()
                if self.steps.is_stretched(foot, phase)
            ),
            default=0.0,
        )

    def _trunk_and_arms(self, phase: float) -> tuple[dict[str, complex], dict[str, float]]:
        """Return the positions of all joints that no step moves, and their bones' rotations."""
        body, template = self.body, self.template
        amount = self.parameters.size * self.parameters.energy * self.reach
        moved = body.facing * template.shift(phase) + 1j * template.rise(phase)
        height = self.steps.raised - self.lowered(phase)
        places = {self.hips: body.joints[self.hips] + amount * moved + 1j * height}
        own = self._own_turns(phase)
        turned = {self.hips: own[self.hips]}
        stepping = {name for leg in self.steps.legs.values() for name in leg.joints[1:]}
        for name, before in list(body.parents.items())[1:]:
            if name in stepping:
                continue
            bone = self._grown(name, phase) * (body.joints[name] - body.joints[before])
            direction = self._direction(name)
            turned[name] = (
                turned[before] + own[name]
                if direction is None
                else self._aimed(direction, name, bone, phase)
            )
            places[name] = places[before] + bone * cmath.exp(1j * turned[name])
        return places, turned

    def _own_turns(self, phase: float) -> dict[str, float]:
        """Return the rotation of each joint's bone against its parent bone, in radians.

        From the side the trunk is one rigid part, from the hips to the root of the neck: hips and
        chest turn together, and the neck's rotation is that of the head. Without a neck a head is a
        part of the trunk while legs step, since its rotation would bend the whole body.
        """
        own = {name: self._turn(name, phase) for name in self.body.joints}
        if self.body.kind.is_side_view:
            own[self.hips] += own.pop("chest", 0.0)
            neck = own.pop("neck", 0.0)
            is_free = "neck" in self.body.joints or not self.steps.gait.stride
            own["head"] = own.get("head", 0.0) + neck if is_free else 0.0
        return dict.fromkeys(self.body.joints, 0.0) | own

    def _turn(self, name: str, phase: float) -> float:
        """Return the rotation of a joint's bone against its parent bone, in radians."""
        if name in self.body.tail and len(self.body.tail) > 1:
            return self._tail_turn(name, phase)
        template, kept = self.template, without_side(name)
        has_side = kept != name
        late = (template.lag if name.endswith(".R") else 0.0) + self._delay(kept)
        curve = self._curve(kept)
        if curve is None:
            return self._lean(kept)
        way = self._outwards(name) if has_side else self.body.facing
        amount = self.parameters.size * (1.0 if has_side else self.parameters.energy)
        if has_side and self.steps.legs:
            # Short arms, as of dinosaurs, swing less.
            amount *= min(1.0, self.body.limb_length(name) / (SHORT_ARM * self.reach))
        amount *= NECKLESS if name == "head" and "neck" not in self.body.joints else 1.0
        return way * amount * math.radians(curve(phase - late)) + self._lean(kept)

    def _grown(self, name: str, phase: float) -> float:
        """Return the length of a joint's bone, as a factor of the drawn one."""
        if name == "head" and "neck" in self.body.joints:
            return 1.0  # its bone is stiff; the head comes down with the neck
        curve = self.template.growth.get(without_side(name), STEADY)
        moment = phase - self._delay(without_side(name))
        return 1 + self.parameters.size * self.parameters.energy * curve(moment)

    def _prefers_first_side(self) -> bool:
        """Whether the first side does a motion of one side: it has a limb, or much the longer one.

        From the side an arm over the trunk is short, since its root is hidden.
        """
        first, other = (name in self.body.joints for name in ("hand.R", "hand.L"))
        if not (first and other):
            return first
        reach, others = (
            self.body.path_length(self.body.limb_joints(name)) for name in ("hand.R", "hand.L")
        )
        if not self.body.kind.is_side_view or max(reach, others) < LONGER * min(reach, others):
            return True
        return (reach > others) != self.parameters.mirrored

    def _direction(self, name: str) -> ArmDirection | None:
        aims = self.template.aims
        alone = name if self.is_first_side else other_side(name)
        return aims.get(alone, aims.get(without_side(name)))

    def _aimed(self, aim: ArmDirection, name: str, bone: complex, phase: float) -> float:
        """Return the rotation of an arm's bone towards its direction on the page, in radians."""
        size, way = self.parameters.size, self._outwards(name)
        moment = phase - self._delay(without_side(name))
        drawn = math.degrees(cmath.phase(1j * complex(way * bone.real, bone.imag)))
        drawn += 360 * (drawn < -90)  # an arm drawn across the body comes down, not over the head
        turn = min(size, 1.0) * aim.share(moment) * (aim.angle - drawn) + size * aim.swing(moment)
        return way * math.radians(turn)

    def _outwards(self, name: str) -> int:
        """Return the sign of a rotation by which a limb moves outwards, or ahead from the side."""
        if self.body.kind.name != "biped-front":
            return self.body.facing
        return 1 if self.body.joints[name].real >= self.body.joints[self.hips].real else -1

    def _delay(self, joint: str) -> float:
        """Return the share of the cycle by which a part of the body is later than usual."""
        of = self.parameters
        delays = {
            "neck": of.head_delay,
            "head": of.head_delay,
            "elbow": of.arm_delay,
            "hand": of.arm_delay,
            "tail": of.tail_delay,
        }
        return delays.get(joint, 0.0)

    @property
    def following(self) -> tuple[FollowingJoint, ...]:
        """The joints of a tail beyond its first bone, each later than the one before it."""
        curve, joints = self._curve("tail"), self.body.tail
        if curve is None or len(joints) < 3:
            return ()
        swings, bones = count_swings(curve), len(joints) - 1
        return tuple(
            FollowingJoint(joint, joints[1], swings, TAIL_LAG * number / bones)
            for number, joint in enumerate(joints[2:], 1)
        )

    def _curve(self, joint: str) -> Periodic | None:
        leans = {} if self.body.kind.name == "biped-front" else self.template.leans
        return self.template.turns.get(joint, leans.get(joint))

    def _tail_turn(self, name: str, phase: float) -> float:
        """Return the rotation of a bone of the tail: only the first swings, about its base."""
        curve, joints, of = self._curve("tail"), self.body.tail, self.parameters
        if curve is None or name != joints[1]:
            return 0.0
        share = TAIL_SWING if len(joints) == 2 else LEADING_SWING
        turn = math.radians(curve(phase - of.tail_delay))
        return self.body.facing * of.size * of.energy * share * turn

    def _lean(self, joint: str) -> float:
        """Return how far a joint turns as the trunk leans forwards; the head stays upright."""
        upright = 1.0 if joint == "chest" else -LEVEL_HEAD if joint == "head" else 0.0
        is_frontal = self.body.kind.name == "biped-front"
        lean = 0.0 if is_frontal else math.radians(self.parameters.lean)
        return -self.body.facing * upright * lean
