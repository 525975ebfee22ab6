"""Motions over a cycle, independent of the body."""

from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import NamedTuple

from app.rigging.motions.body import Body, other_side
from app.rigging.motions.timing import EVEN, Timing
from engine.arrays import as_number
from engine.errors import EngineError

# Range of each parameter.
RANGES: Mapping[str, tuple[float, float]] = {
    "speed": (0.1, 4.0),
    "size": (0.05, 2.0),
    "energy": (0.0, 2.0),
    "lean": (-30.0, 30.0),
    "head_delay": (0.0, 0.5),
    "arm_delay": (0.0, 0.5),
    "tail_delay": (0.0, 0.5),
}
LEAST_FRAMES = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameters:
    """Parameters of a motion.

    Raises
    ------
    EngineError
        If a parameter is out of its range.
    """

    speed: float = 1.0  # factor of the usual speed
    size: float = 1.0  # factor of limb swings and steps
    energy: float = 1.0  # factor of bounce and sway, independent of the limbs
    mirrored: bool = False  # swaps the sides: the other arm waves, a walk goes the other way
    start: float = 0.0  # phase at which the motion begins
    travel: bool = False  # whether the body moves across the picture instead of staying in place
    lean: float = 0.0  # degrees by which the trunk leans forwards
    # Shares of the cycle by which parts of the body are later than usual.
    head_delay: float = 0.0
    arm_delay: float = 0.0
    tail_delay: float = 0.0

    def __post_init__(self) -> None:
        for name, (least, most) in RANGES.items():
            value = getattr(self, name)
            if not least <= value <= most:
                raise EngineError(
                    "{name} must be from {least:g} to {most:g}, not {value:g}.",
                    name=name,
                    least=least,
                    most=most,
                    value=value,
                )
        if not 0 <= self.start < 1:
            raise EngineError(
                "start must be a share of the cycle, from 0 to below 1, not {start:g}.",
                start=self.start,
            )


class JointPose(NamedTuple):
    """Positions of joints at one moment, rotations from rest, and standing joints."""

    places: Mapping[str, complex]
    turns: Mapping[str, float]  # in radians, counter-clockwise; other joints rotate freely
    standing: frozenset[str]
    sides: Mapping[str, int] = MappingProxyType({})  # to which side bones bend at their joints


class FollowingJoint(NamedTuple):
    """A joint that a spring moves: it swings about its root, later than the root turns."""

    joint: str
    root: str
    swings: int  # of the motion in a cycle
    delay: float  # in periods of a swing


class MotionInstance(ABC):
    """A motion of one body, in place."""

    @abstractmethod
    def pose_at(self, phase: float) -> JointPose:
        """Return the joint positions at a phase in [0, 1)."""

    @property
    def stride(self) -> float:
        """Distance that the body moves to the right in a cycle, in pixels; 0 without steps."""
        return 0.0

    @property
    def following(self) -> tuple[FollowingJoint, ...]:
        """The joints that follow others by springs; a pose leads them straight on."""
        return ()


class MotionTemplate(ABC):
    """A motion for any body of a kind."""

    needed: tuple[str, ...] = ()  # required joints
    either: tuple[str, ...] = ()  # joints of which one is required, the first preferred

    @property
    def can_travel(self) -> bool:
        """Whether its steps move the body forward."""
        return False

    def part_parameters(self, kind: str, joints: Collection[str]) -> frozenset[str]:
        """Return which of `lean` and the delays change something in a body with these joints."""
        del kind, joints
        return frozenset()

    @abstractmethod
    def instantiate(
        self, body: Body, parameters: Parameters, timing: Timing = EVEN
    ) -> MotionInstance:
        pass


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """One motion preset.

    It has a template for each kind of body that it fits. A motion that looks different from the
    front and from the side has a template for each.
    """

    name: str
    label: str
    hint: str
    seconds: float  # of a cycle at the usual speed
    phases: tuple[float, ...]  # of the poses with which a cycle is keyed, ascending from 0
    templates: Mapping[str, MotionTemplate] = field(repr=False)

    @property
    def kinds(self) -> tuple[str, ...]:
        return tuple(self.templates)

    @property
    def can_travel(self) -> bool:
        """Whether its steps move the body forward."""
        return any(template.can_travel for template in self.templates.values())

    def template_for(self, kind: str) -> MotionTemplate:
        """Return the template for bodies of a kind; raise an `EngineError` if there is none."""
        if kind not in self.templates:
            raise EngineError(
                "{motion!r} is not a motion for {kind!r}; it fits {kinds}.",
                motion=self.name,
                kinds=", ".join(self.templates),
                kind=kind,
            )
        return self.templates[kind]

    def frames(self, parameters: Parameters, fps: float) -> int:
        """Return the number of frames of a cycle."""
        fps = as_number(fps, "The speed of a motion", above=0)
        return max(LEAST_FRAMES, round(self.seconds * fps / parameters.speed))

    def key_times(self, parameters: Parameters, frames: int) -> tuple[tuple[int, float], ...]:
        """Return the frames of the keys of a cycle and their phases, from the start phase on."""
        first = max((phase for phase in self.phases if phase <= parameters.start), default=0.0)
        later = sorted(((phase - first) % 1.0, phase) for phase in self.phases)
        return tuple((round(passed * frames), phase) for passed, phase in later)

    def perform(self, body: Body, parameters: Parameters, timing: Timing = EVEN) -> "Performance":
        """Return the motion of a body.

        Raises
        ------
        EngineError
            If the motion does not fit the kind, a required joint is missing, or there are no steps
            to travel by.
        """
        template = self.template_for(body.kind.name)
        if parameters.travel and not template.can_travel:
            raise EngineError(
                "{motion!r} has no steps, so it cannot travel; leave travel out.", motion=self.name
            )
        body = body.mirrored() if parameters.mirrored else body
        body.require_joints(template.needed, f"{self.name!r}")
        if template.either and not any(name in body.joints for name in template.either):
            body.require_joints(template.either[:1], f"{self.name!r}")
        return Performance(template.instantiate(body, parameters, timing), parameters)


@dataclass(frozen=True, slots=True)
class Performance:
    """A motion of one body with its parameters."""

    instance: MotionInstance
    parameters: Parameters

    @property
    def stride(self) -> float:
        """Distance that the ground passes to the left in a cycle in place, in pixels."""
        return 0.0 if self.parameters.travel else self.instance.stride

    @property
    def following(self) -> tuple[FollowingJoint, ...]:
        """The joints that follow others by springs."""
        return self.instance.following

    def pose_at(self, phase: float, cycles: float = 0.0) -> JointPose:
        """Return the joint positions at a phase, after a number of cycles.

        A body that travels moves on by a stride in a cycle.
        """
        moment = self.instance.pose_at(as_number(phase, "The phase of a motion") % 1.0)
        if self.parameters.mirrored:
            moment = _swapped(moment)
        if not self.parameters.travel:
            return moment
        return _moved(moment, cycles * self.instance.stride)


def _moved(moment: JointPose, way: float) -> JointPose:
    return moment._replace(places={name: at + way for name, at in moment.places.items()})


def _swapped(moment: JointPose) -> JointPose:
    places = {other_side(name): place for name, place in moment.places.items()}
    turns = {other_side(name): turn for name, turn in moment.turns.items()}
    sides = {other_side(name): side for name, side in moment.sides.items()}
    return JointPose(places, turns, frozenset(map(other_side, moment.standing)), sides)
