"""Pose sliders: poses of the library at values of one number, or of two numbers of a pad."""

from dataclasses import dataclass, field
from functools import cached_property
from itertools import product

import numpy as np

from app.document.channels.kinds import LARGEST_VALUE
from app.document.channels.springs import require_oscillator
from app.document.checks import LAST_FRAME, NOTHING, Unknown, require
from app.document.keyframe import MAX_REVOLUTIONS
from app.texts import N_
from engine.arrays import Floats

MOST_AXIS_POSES, MOST_PAD_POSES = 8, 5
BEYOND = 0.3  # how far a slider may stand beyond its outer poses, as a part of its range


@dataclass(frozen=True, slots=True, kw_only=True)
class SliderPose:
    """A pose at a value of a slider; the second number of a pad is the imaginary part."""

    at: complex
    pose: str | None  # name of a pose of the library; None is the undeformed drawing
    turns: int = 0  # further full turns of the pose, counter-clockwise
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)


@dataclass(frozen=True, kw_only=True)  # no slots, because of the cached properties
class Slider:
    """Poses that are added to a layer's motion by the value of a channel.

    Its channel has the kind `SLIDER`, and the slider's name as its part.
    """

    name: str  # unique in the layer
    poses: tuple[SliderPose, ...]  # at least two; those of a pad fill a grid
    value: complex = 0j  # used without keys
    # Id of a layer whose slider of the same name gives the value; None is the own value.
    driver: int | None = None
    delay: int = 0  # in frames; wraps around in a loop
    # Frequency in Hz and damping of a spring by which the value swings; None does not swing.
    spring: tuple[float, float] | None = None
    enabled: bool = True
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        name = self.name
        require(bool(name.strip()), N_("A slider needs a name."))
        require(
            len(self.poses) >= 2,
            N_("The slider {name!r} needs at least two poses, not {count}."),
            name=name,
            count=len(self.poses),
        )
        for at in (*(each.at for each in self.poses), self.value):
            require(  # false for NaN, too
                abs(at) <= LARGEST_VALUE,
                N_("The slider {name!r}: a value must be at most {largest:,.0f}, not {at}."),
                name=name,
                largest=LARGEST_VALUE,
                at=format_slider_value(at),
            )
        for each in self.poses:
            require(
                abs(each.turns) <= MAX_REVOLUTIONS,
                N_("The slider {name!r}: a pose can make at most {most} full turns, not {turns}."),
                name=name,
                most=MAX_REVOLUTIONS,
                turns=each.turns,
            )
        places = [each.at for each in self.poses]
        for at in places:
            require(
                places.count(at) == 1,
                N_("The slider {name!r} has two poses at {at}; move or delete one of them."),
                name=name,
                at=format_slider_value(at),
            )
        (xs, ys), most = self.axes, MOST_PAD_POSES if self.is_pad else MOST_AXIS_POSES
        require(
            max(len(xs), len(ys)) <= most,
            N_("The slider {name!r} can have at most {most} poses in a row, not {count}."),
            name=name,
            most=most,
            count=max(len(xs), len(ys)),
        )
        grid = {complex(x, y) for x, y in product(xs, ys)}
        for at in sorted(grid, key=lambda z: (z.imag, z.real)):
            require(
                at in places,
                N_("The pad {name!r} has no pose at {at}; its poses must fill a grid."),
                name=name,
                at=format_slider_value(at),
            )
        require(
            0 <= self.delay <= LAST_FRAME,
            N_("The delay of a slider must be from 0 to {largest:,} frames, not {delay:,}."),
            largest=LAST_FRAME,
            delay=self.delay,
        )

        if self.spring is not None:
            frequency, damping = self.spring
            require_oscillator(frequency, damping)
            require(
                damping > 0,
                N_("The spring of the slider {name!r} needs a damping above 0."),
                name=name,
            )

    @cached_property
    def axes(self) -> tuple[list[float], list[float]]:
        """The numbers along both axes at which poses are; a slider of one number has one y."""
        xs, ys = ({part(each.at) for each in self.poses} for part in (_real, _imaginary))
        return sorted(xs), sorted(ys)

    @property
    def is_pad(self) -> bool:
        return len(self.axes[1]) > 1

    def clamp(self, value: complex) -> complex:
        """Return the nearest value within the range, widened by `BEYOND` on all sides."""
        (xs, ys) = self.axes
        return complex(_clamped(value.real, xs), _clamped(value.imag, ys))

    def weights(self, value: complex) -> Floats:
        """Return the weights of the poses at a value; they sum to 1.

        Between poses they are cubic with continuous slopes, beyond the outer poses linear.
        """
        (xs, ys), at = self.axes, self.clamp(value)
        along = _axis_weights(np.array(xs), at.real), _axis_weights(np.array(ys), at.imag)
        places = ((xs.index(each.at.real), ys.index(each.at.imag)) for each in self.poses)
        return np.array([along[0][i] * along[1][j] for i, j in places])


def format_slider_value(value: complex) -> str:
    """Return a value as one number, or as two if the second is not 0."""
    return f"({value.real:g}, {value.imag:g})" if value.imag else f"{value.real:g}"


def _real(value: complex) -> float:
    return value.real


def _imaginary(value: complex) -> float:
    return value.imag


def _clamped(value: float, places: list[float]) -> float:
    room = BEYOND * (places[-1] - places[0])
    return min(max(value, places[0] - room), places[-1] + room)


def _axis_weights(places: Floats, x: float) -> Floats:
    """Return the weights of poses in a row: of cubic Hermite curves through them."""
    if len(places) == 1:
        return np.ones(1)
    steps, poses = np.diff(places), np.eye(len(places))
    secants = np.diff(poses, axis=0) / steps[:, None]
    before, after = steps[:-1, None], steps[1:, None]
    inner = (secants[:-1] * after + secants[1:] * before) / (before + after)
    slopes = np.concatenate([secants[:1], inner, secants[-1:]])
    i = int(np.clip(np.searchsorted(places, x, side="right") - 1, 0, len(steps) - 1))
    t, step = (x - places[i]) / steps[i], steps[i]
    if t < 0.0 or t > 1.0:
        end = i + int(t > 1.0)
        return np.asarray(poses[end] + (x - places[end]) * slopes[end])
    value = poses[i] * (1 + 2 * t) * (1 - t) ** 2 + poses[i + 1] * t**2 * (3 - 2 * t)
    return np.asarray(value + step * t * (1 - t) * (slopes[i] * (1 - t) - slopes[i + 1] * t))
