"""Motions over a cycle, independent of the body."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from app.rigging.motions.body import Body, other_side
from engine.arrays import as_number
from engine.errors import EngineError

# Range of each parameter.
RANGES: Mapping[str, tuple[float, float]] = {
    "speed": (0.1, 4.0),
    "size": (0.05, 2.0),
    "energy": (0.0, 2.0),
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


class MotionInstance(ABC):
    """A motion of one body, in place."""

    @abstractmethod
    def pose_at(self, phase: float) -> JointPose:
        """Return the joint positions at a phase in [0, 1)."""

    @property
    def stride(self) -> float:
        """Distance that the body moves to the right in a cycle, in pixels; 0 without steps."""
        return 0.0


class MotionTemplate(ABC):
    """A motion for any body of a kind."""

    needed: tuple[str, ...] = ()  # required joints
    either: tuple[str, ...] = ()  # joints of which one is required, the first preferred

    @property
    def can_travel(self) -> bool:
        """Whether its steps move the body forward."""
        return False

    @abstractmethod
    def instantiate(self, body: Body, parameters: Parameters) -> MotionInstance:
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
    keys: int  # poses with which a cycle is keyed
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

    def poses_at(
        self, body: Body, parameters: Parameters, shares: Sequence[float]
    ) -> tuple[JointPose, ...]:
        """Return the joint positions after shares of the cycle, from its start.

        With `travel` the positions move on by this share of a stride, also beyond 1.

        Raises
        ------
        EngineError
            If the motion does not fit the kind, a required joint is missing, there are no steps to
            travel by, or a share is not finite.
        """
        for share in shares:
            as_number(share, "The start of a motion's cycle")
        template = self.template_for(body.kind.name)
        if parameters.travel and not template.can_travel:
            raise EngineError(
                "{motion!r} has no steps, so it cannot travel; leave travel out.", motion=self.name
            )
        body = body.mirrored() if parameters.mirrored else body
        body.require_joints(template.needed, f"{self.name!r}")
        if template.either and not any(name in body.joints for name in template.either):
            body.require_joints(template.either[:1], f"{self.name!r}")
        performed = template.instantiate(body, parameters)
        ways = [share * performed.stride if parameters.travel else 0.0 for share in shares]
        moments = [performed.pose_at((share + parameters.start) % 1.0) for share in shares]
        if parameters.mirrored:
            moments = [_swapped(moment) for moment in moments]
        return tuple(_moved(moment, way) for moment, way in zip(moments, ways, strict=True))


def _moved(moment: JointPose, way: float) -> JointPose:
    return moment._replace(places={name: at + way for name, at in moment.places.items()})


def _swapped(moment: JointPose) -> JointPose:
    places = {other_side(name): place for name, place in moment.places.items()}
    turns = {other_side(name): turn for name, turn in moment.turns.items()}
    return JointPose(places, turns, frozenset(map(other_side, moment.standing)))
