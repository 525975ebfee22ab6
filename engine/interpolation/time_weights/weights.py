"""Time weights of keyframes, also through keyframes with continuous velocity.

Each segment is a cubic Bézier curve in the quantities that its variant blends. The Bernstein
polynomials sum to 1, so they serve as weights of log f_z and of the anchor's pose, too. They are
positive: if the control values obey a convex bound, so does every in-between. The paper blends two
keyframes only.
"""

from dataclasses import dataclass, fields
from typing import NamedTuple, Self

import numpy as np

from engine.arrays import Floats, as_number, freeze


@dataclass(frozen=True, slots=True)
class InteriorKnot:
    """A keyframe between two others, through which the motion goes at one velocity.

    Attributes
    ----------
    before, after : float
        Lengths of the segments on both sides, above 0, in any unit of time.
    end_pace, start_pace : float
        Speed of time at the end of the segment before and at the start of the segment after, above
        0; 1 without easing.
    """

    before: float
    after: float
    end_pace: float = 1.0
    start_pace: float = 1.0

    def __post_init__(self) -> None:
        for each in fields(self):
            as_number(getattr(self, each.name), f"The {each.name} of a joint", above=0)

    @property
    def velocity(self) -> Floats:
        """Weights (3,) of the keyframe before, this one and the next one in its velocity.

        Catmull–Rom with true spacing: the slope of the parabola through the three.
        """
        whole = self.before + self.after
        first, last = -self.after / (self.before * whole), self.before / (self.after * whole)
        return np.array([first, -first - last, last])

    @property
    def control_offsets(self) -> tuple[float, float]:
        """Times from the keyframe to the control values on both sides, at full velocity."""
        return -self.before / (3 * self.end_pace), self.after / (3 * self.start_pace)


class Tangent(NamedTuple):
    """A knot with the share of its velocity that the bounds allow.

    `length` is the share of the velocity, from 0 to 1; in the metric variant, that of η.
    `velocity_share` is the share of the whole velocity, from 0 (a stop) to 1.
    """

    knot: InteriorKnot
    length: float
    velocity_share: float


# How a segment leaves or reaches a keyframe: a tangent, or the share of a straight blend's velocity
# (1 for a corner, 0 for a stop).
EndCondition = Tangent | float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TimeWeights:
    """Weights of a segment's keyframes as cubic polynomials of time.

    Attributes
    ----------
    controls : float64, shape (4, q), or None
        The control values as weights of q keyframes; None for a linear blend of two. The order is:
        the keyframe before if the start has a tangent, the two of the segment, the keyframe after
        if the end has a tangent. Last come the keyframes that one-sided tangents use in place of
        the segment's other keyframe.
    first : int
        Index of the keyframe at time 0; the keyframe at time 1 follows it.
    ends : tuple of EndCondition
        End conditions of the segment.
    one_sided : tuple of bool
        Whether a tangent's outer keyframes belong to a neighbouring motion, not to this pair.
    """

    controls: Floats | None
    first: int
    ends: tuple[EndCondition, EndCondition]
    one_sided: tuple[bool, bool] = (False, False)

    @classmethod
    def straight(cls) -> Self:
        """Return the linear blend of two keyframes, as in the paper."""
        return cls(controls=None, first=0, ends=(1.0, 1.0))

    @classmethod
    def cubic(cls) -> Self:
        """Return weights for four given control values."""
        return cls(controls=freeze(np.eye(4)), first=0, ends=(1.0, 1.0))

    @classmethod
    def between(
        cls, start: EndCondition, end: EndCondition, *, apart: tuple[bool, bool] = (False, False)
    ) -> Self:
        """Return the weights of a segment with these end conditions."""
        for share in (start, end):
            if not isinstance(share, Tangent):
                as_number(share, "The share of a straight velocity", least=0)
        if start == end == 1.0:
            return cls.straight()
        first = int(isinstance(start, Tangent))
        count = first + 2 + isinstance(end, Tangent) + sum(apart)
        controls = np.zeros((4, count))
        controls[:2, first] = controls[2:, first + 1] = 1.0
        windows = support_of(isinstance(start, Tangent), isinstance(end, Tangent), apart)
        if isinstance(start, Tangent):
            controls[1, windows[0]] += (
                start.length * start.knot.control_offsets[1] * start.knot.velocity
            )
        else:
            controls[1, first : first + 2] += start / 3 * np.array([-1.0, 1.0])
        if isinstance(end, Tangent):
            controls[2, windows[1]] += end.length * end.knot.control_offsets[0] * end.knot.velocity
        else:
            controls[2, first : first + 2] += end / 3 * np.array([1.0, -1.0])
        return cls(controls=freeze(controls), first=first, ends=(start, end), one_sided=apart)

    @property
    def support(self) -> tuple[list[int], list[int]]:
        """The indices of the three keyframes of each tangent."""
        start, end = (isinstance(end, Tangent) for end in self.ends)
        return support_of(start, end, self.one_sided)

    @property
    def unlimited(self) -> Self:
        """The same weights with full velocity at each tangent."""
        # A stop stays where the pose must be kept exactly.
        ends = (
            e._replace(length=1.0) if isinstance(e, Tangent) and e.velocity_share else e
            for e in self.ends
        )
        return type(self).between(*ends, apart=self.one_sided)

    @property
    def count(self) -> int:
        """The number of keyframes, q."""
        return 2 if self.controls is None else self.controls.shape[1]

    @property
    def is_straight(self) -> bool:
        """Whether the weights are those of the linear blend."""
        return self.controls is None

    def __call__(self, time: float) -> Floats:
        """Return the weights (q,) at a time in [0, 1]; they sum to 1."""
        return self.at(np.array(time))

    def at(self, times: Floats) -> Floats:
        """Return the weights at times (...), float64 (q, ...)."""
        if self.controls is None:
            return np.stack([1.0 - times, times])
        weights: Floats = np.tensordot(self.controls.T, bernstein(times), axes=1)
        return weights

    def controls_on(self, starts: Floats, ends: Floats) -> Floats:
        """Return the keyframes' weights at the control values of pieces of time (c,).

        The shape is (c, 2, 2) for a linear blend, else (c, 4, q).
        """
        if self.controls is None:
            return np.stack([self.at(starts).T, self.at(ends).T], axis=1)
        weights = []
        for count in range(4):
            # The polar form with `count` of its three arguments at the end time.
            u, v, w = [ends if i < count else starts for i in range(3)]
            x, y, z = 1.0 - u, 1.0 - v, 1.0 - w
            weights.append(
                np.stack(
                    [
                        x * y * z,
                        u * y * z + x * v * z + x * y * w,
                        u * v * z + u * y * w + x * v * w,
                        u * v * w,
                    ]
                )
            )
        found: Floats = np.einsum("dkc,kq->cdq", np.array(weights), self.controls)
        return found


def support_of(
    start: bool,  # noqa: FBT001 - one for each end
    end: bool,  # noqa: FBT001
    apart: tuple[bool, bool],
) -> tuple[list[int], list[int]]:
    """Return the indices of the three keyframes of the tangents at both ends of a segment.

    The segment's own keyframe is in the middle. The indices of an end without tangent are invalid.
    """
    first, count = int(start), start + 2 + end
    after, before = count if apart[0] else first + 1, count + apart[0] if apart[1] else first
    return [first - 1, first, after], [before, first + 1, first + 2]


def bernstein(times: Floats) -> Floats:
    """Return the cubic Bernstein polynomials at times (...), float64 (4, ...)."""
    rest = 1.0 - times
    return np.stack([rest**3, 3 * times * rest**2, 3 * times**2 * rest, times**3])
