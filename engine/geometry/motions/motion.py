"""Motions: what a body does over a cycle, told apart from whose body it is."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from engine.arrays import as_number
from engine.errors import EngineError
from engine.geometry.motions.body import Body, other_side

# How far each parameter goes.
RANGES: Mapping[str, tuple[float, float]] = {
    "speed": (0.1, 4.0),
    "size": (0.05, 2.0),
    "energy": (0.0, 2.0),
}
LEAST_FRAMES = 12


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameters:
    """How a motion is given.

    Raises
    ------
    EngineError
        If one of them is out of its range.
    """

    speed: float = 1.0  # how many times as fast as usual
    size: float = 1.0  # how far limbs swing, and how far steps go
    energy: float = 1.0  # how much it bounces and sways, beside what limbs do
    mirrored: bool = False  # as in a mirror: the other arm waves, a walk goes the other way
    start: float = 0.0  # the share of the cycle at which it begins
    travel: bool = False  # whether it gets on in the picture, and does not stay on the spot

    def __post_init__(self) -> None:
        for name, (least, most) in RANGES.items():
            value = getattr(self, name)
            if not least <= value <= most:
                raise EngineError(f"{name} is from {least:g} to {most:g}, not {value:g}")
        if not 0 <= self.start < 1:
            raise EngineError(
                f"start is a share of the cycle, from 0 to below 1, not {self.start:g}"
            )


class JointPose(NamedTuple):
    """Where joints are at one moment, how far some turn from rest, and which stand."""

    places: Mapping[str, complex]
    turns: Mapping[
        str, float
    ]  # in radians, counter-clockwise; joints that are not named turn freely
    standing: frozenset[str]


class MotionInstance(ABC):
    """What a motion does with one body, on the spot."""

    @abstractmethod
    def pose_at(self, phase: float) -> JointPose:
        """Return a moment at a phase in [0, 1)."""

    @property
    def stride(self) -> float:
        """How far the body gets on over a cycle, to the right, in pixels; 0 without steps."""
        return 0.0


class MotionTemplate(ABC):
    """What a motion does with any body of a kind."""

    needed: tuple[str, ...] = ()  # joints without which it cannot be
    either: tuple[str, ...] = ()  # joints of which it needs one, the first one rather

    @property
    def can_travel(self) -> bool:
        """Whether it has steps by which a body gets on."""
        return False

    @abstractmethod
    def instantiate(self, body: Body, parameters: Parameters) -> MotionInstance:
        """Return what it does with a body."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """One ready motion.

    Its courses are by the kinds of bodies that it fits; what looks different from the front and
    from the side has a course for each.
    """

    name: str
    label: str
    hint: str
    seconds: float  # that a cycle takes at the usual speed
    keys: int  # poses by which a cycle is keyed
    templates: Mapping[str, MotionTemplate] = field(repr=False)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of bodies that it fits."""
        return tuple(self.templates)

    @property
    def can_travel(self) -> bool:
        """Whether it has steps by which a body gets on."""
        return any(course.can_travel for course in self.templates.values())

    def template_for(self, kind: str) -> MotionTemplate:
        """Return what it does with bodies of a kind; raise an `EngineError` if it does not fit."""
        if kind not in self.templates:
            fitting = " or ".join(repr(each) for each in self.templates)
            raise EngineError(f"{self.name!r} is a motion of {fitting}, and not of {kind!r}")
        return self.templates[kind]

    def frames(self, parameters: Parameters, fps: float) -> int:
        """Return how many frames a cycle takes."""
        fps = as_number(fps, "The speed of a motion", above=0)
        return max(LEAST_FRAMES, round(self.seconds * fps / parameters.speed))

    def poses_at(
        self, body: Body, parameters: Parameters, shares: Sequence[float]
    ) -> tuple[JointPose, ...]:
        """Return where a body's joints are after shares of the cycle, from where it begins.

        With `travel` they are farther by that share of a stride, also beyond 1.

        Raises
        ------
        EngineError
            If the motion does not fit the kind, needs joints that are not there, or has no steps
            to travel by; if a share is not finite.
        """
        for share in shares:
            as_number(share, "A share of a motion's cycle")
        course = self.template_for(body.kind.name)
        if parameters.travel and not course.can_travel:
            raise EngineError(f"{self.name!r} has no steps to travel by")
        body = body.mirrored() if parameters.mirrored else body
        body.require_joints(course.needed, f"{self.name!r}")
        if course.either and not any(name in body.joints for name in course.either):
            body.require_joints(course.either[:1], f"{self.name!r}")
        performed = course.instantiate(body, parameters)
        ways = [share * performed.stride if parameters.travel else 0.0 for share in shares]
        moments = [performed.pose_at((share + parameters.start) % 1.0) for share in shares]
        if parameters.mirrored:
            moments = [_swapped(moment) for moment in moments]
        return tuple(_moved(moment, way) for moment, way in zip(moments, ways, strict=True))


def _moved(moment: JointPose, way: float) -> JointPose:
    """Return a moment farther to the right."""
    return moment._replace(places={name: at + way for name, at in moment.places.items()})


def _swapped(moment: JointPose) -> JointPose:
    """Return a moment with its sides swapped."""
    places = {other_side(name): place for name, place in moment.places.items()}
    turns = {other_side(name): turn for name, turn in moment.turns.items()}
    return JointPose(places, turns, frozenset(map(other_side, moment.standing)))
