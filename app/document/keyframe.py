"""Handles, and the poses into which keys pull them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Self

import numpy as np

from app.document.checks import (
    MAX_COORDINATE,
    NOTHING,
    Unknown,
    require,
    require_frame,
    require_id,
    require_point,
)
from app.document.timing import HOLD, LINEAR, Easing, TangentMode, require_tangent_mode
from engine.arrays import Complexes, as_points, freeze
from engine.maps import Certificate, HarmonicMap

MAX_WEIGHT = 1e6
# How firmly a handle holds, in words: the weights that they stand for.
WEIGHT_PRESETS = {"Soft": 0.1, "Normal": 1.0, "Firm": 10.0}
# A locked handle pulls so many times as strongly: a free one that is dragged as far as the limits
# let it moves it by less than a tenth of a pixel.
LOCKED_WEIGHT = 1e4
MAX_REVOLUTIONS = 20
# Pixels. No pose between targets that are within `FARTHEST` comes near; beyond, what is seen of a
# pose would run out of digits.
LARGEST_COEFFICIENT = 1e12
NO_DEPTHS: Mapping[int, float] = MappingProxyType({})


@dataclass(frozen=True, slots=True, kw_only=True)
class Handle:
    """A named point of the picture by which poses are pulled."""

    id: int  # never given twice in one document
    name: str  # unique in the document
    position: complex  # where it sits in the picture at rest, in pixels, y up
    weight: float = 1.0  # how strongly it pulls, relative to others
    # What the drawing is painted in around it where it lies over itself: −1 behind, 1 in front, 0
    # in its usual order. Keys may say otherwise.
    depth: float = 0.0
    # How far around it that holds, in pixels; None is the usual part of the drawing.
    extent: float | None = None
    # Whether it holds its place: it is not dragged, and hardly gives in to others.
    locked: bool = False
    group: str = ""  # those of one group are taken together; "" is none
    # Whether it moves as it likes between two keys that have it at one place; else it stays there.
    is_unpinned: bool = False
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_id(self.id, "a handle")
        require(bool(self.name.strip()), "A handle needs a name.")
        require_point(self.position, f"The position of handle {self.name!r}")
        require(
            0 < self.weight <= MAX_WEIGHT,
            f"The weight of handle {self.name!r} must be above 0 and at most {MAX_WEIGHT:,.0f}, "
            f"not {self.weight:g}.",
        )
        require_depth(self.depth)
        require(
            self.extent is None or 0 < self.extent <= MAX_COORDINATE,
            f"The extent of handle {self.name!r} must be above 0 and at most {MAX_COORDINATE:,.0f} "
            f"pixels, not {self.extent}.",
        )

    @property
    def effective_weight(self) -> float:
        """How strongly it pulls when a pose is solved."""
        return self.weight * (LOCKED_WEIGHT if self.locked else 1.0)


def require_depth(front: float) -> None:
    """Raise a `LissomError` unless a depth lies between behind and in front."""
    require(
        -1 <= front <= 1,
        f"What is painted in front is between −1, behind, and 1, in front, not {front:g}.",
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """Where a pose wants a handle."""

    position: complex  # in pixels of the picture, y up; it may lie outside the picture
    # By how much the shape turns at the handle, in radians; None leaves that free.
    rotation: float | None = None
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_point(self.position, "The target of a handle")
        require(
            self.rotation is None or math.isfinite(self.rotation),
            f"The rotation of a handle must be finite, not {self.rotation}.",
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """A map with the wishes that it was solved for."""

    targets: Mapping[int, Target]  # one for each handle of the document, by the handle's id
    # complex128 (n,): Coefficients of the map over the domain's cage, and those in its holes.
    phi: Complexes
    psi: Complexes
    # complex128 (holes,): Those of its logarithms.
    logs: Complexes = field(default_factory=lambda: freeze(np.empty(0, dtype=np.complex128)))
    # What is proven of the map, by the solver or when it was read; it is never written.
    certificate: Certificate

    def __post_init__(self) -> None:
        object.__setattr__(self, "targets", MappingProxyType(dict(self.targets)))
        object.__setattr__(self, "phi", as_points(self.phi, "phi", at_least=3))
        object.__setattr__(self, "psi", as_points(self.psi, "psi", at_least=3))
        object.__setattr__(self, "logs", as_points(self.logs, "logs"))
        largest = max(np.abs(each).max(initial=0.0) for each in (self.phi, self.psi, self.logs))
        require(
            largest <= LARGEST_COEFFICIENT,
            f"The coefficients of a pose are at most {LARGEST_COEFFICIENT:g} pixels, not "
            f"{largest:.3g}; move its targets nearer, or choose tighter limits.",
        )

    @classmethod
    def of(
        cls, harmonic_map: HarmonicMap, targets: Mapping[int, Target], certificate: Certificate
    ) -> "Pose":
        """Return a map as a pose with these wishes."""
        f = harmonic_map
        return cls(targets=targets, phi=f.phi, psi=f.psi, logs=f.logs, certificate=certificate)

    @property
    def nbytes(self) -> int:
        """Memory that the map takes, in bytes."""
        return self.phi.nbytes + self.psi.nbytes + self.logs.nbytes

    def with_map(self, harmonic_map: HarmonicMap) -> "Pose":
        """Return the pose with another map."""
        f = harmonic_map
        return replace(self, phi=f.phi, psi=f.psi, logs=f.logs)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LibraryPose:
    """A pose in a layer's library, under a name that is unique there."""

    name: str
    pose: Pose
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(bool(self.name.strip()), "A pose of the library needs a name.")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Keyframe:
    """A pose at a frame, and the way from there to the next key."""

    frame: int
    pose: Pose
    easing: Easing = LINEAR  # how time runs until the next key
    # How the motion passes the pose, other than by a hold, which is an easing.
    tangent_mode: TangentMode = TangentMode.SMOOTH
    # Whole turns, counter-clockwise, that the anchor makes on the way beyond the shorter way.
    revolutions: int = 0
    # What is in front from here on, by the ids of handles; the others stay as they were.
    depths: Mapping[int, float] = field(default_factory=lambda: NO_DEPTHS)
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_frame(self.frame, "A key")
        require(
            abs(self.revolutions) <= MAX_REVOLUTIONS,
            f"There may be {MAX_REVOLUTIONS} whole turns on the way to a key, not "
            f"{self.revolutions}.",
        )
        require_tangent_mode(self.tangent_mode)
        object.__setattr__(self, "tangent_mode", TangentMode(self.tangent_mode))
        object.__setattr__(self, "depths", MappingProxyType(dict(self.depths)))
        for front in self.depths.values():
            require_depth(front)

    @property
    def shown_tangent_mode(self) -> TangentMode:
        """How the motion passes the key, by a hold too."""
        return TangentMode.HOLD if self.easing == HOLD else self.tangent_mode

    def with_easing_of(self, other: Self, *, backwards: bool = False) -> Self:
        """Return the key with the way on from another one, or with that way run backwards."""
        if backwards:
            return replace(self, easing=other.easing.reversed(), revolutions=-other.revolutions)
        return replace(self, easing=other.easing, revolutions=other.revolutions)

    def retimed(self, frame: int, pace: float) -> Self:  # noqa: ARG002 - a pose has no velocity
        """Return the key at another frame of a motion that runs so many times as fast."""
        return self if frame == self.frame else replace(self, frame=frame)
