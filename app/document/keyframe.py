"""Handles, targets, poses and pose keys."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Self

import numpy as np

from app.document.channels.key import BaseKey
from app.document.channels.kinds import require_depth
from app.document.checks import (
    MAX_COORDINATE,
    NOTHING,
    Unknown,
    require,
    require_id,
    require_point,
)
from app.texts import N_, _
from engine.arrays import Complexes, as_points, freeze
from engine.maps import Certificate, HarmonicMap

MAX_WEIGHT = 1e6
# Weights of handles by name.
WEIGHT_PRESETS = {N_("Soft"): 0.1, N_("Normal"): 1.0, N_("Firm"): 10.0}
# Factor of a locked handle's weight. If a free handle is dragged to the limits, a locked handle
# moves by less than a tenth of a pixel.
LOCKED_WEIGHT = 1e4
MAX_REVOLUTIONS = 20
# Pixels. Poses with targets within MAX_COORDINATE stay far below this size; a pose above it loses
# too many digits to be drawn.
LARGEST_COEFFICIENT = 1e12


@dataclass(frozen=True, slots=True, kw_only=True)
class Handle:
    """A named point of the picture by which a pose is dragged."""

    id: int  # never used again in the same document
    name: str  # unique in the document
    position: complex  # at rest, in pixels, y up
    weight: float = 1.0  # relative to other handles
    # Depth of the drawing around the handle where the drawing overlaps itself: −1 behind, 1 in
    # front, 0 default order. Keys may override the depth.
    depth: float = 0.0
    # Radius of the depth around the handle in pixels; None takes the default share of the drawing.
    extent: float | None = None
    # Whether the handle keeps its place. It cannot be dragged and hardly moves with other handles.
    locked: bool = False
    group: str = ""  # handles of one group are selected together; "" is no group
    # Whether auto-pin skips the handle, so that it may move between keys with equal targets.
    is_unpinned: bool = False
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_id(self.id, _("A handle"))
        require(bool(self.name.strip()), N_("A handle needs a name."))
        require_point(self.position, _("The position of handle {name!r}").format(name=self.name))
        require(
            0 < self.weight <= MAX_WEIGHT,
            N_(
                "The weight of handle {name!r} must be above 0 and at most {largest:,.0f}, "
                "not {weight:g}."
            ),
            name=self.name,
            largest=MAX_WEIGHT,
            weight=self.weight,
        )
        require_depth(self.depth)
        require(
            self.extent is None or 0 < self.extent <= MAX_COORDINATE,
            N_(
                "The extent of handle {name!r} must be above 0 and at most "
                "{largest:,.0f} pixels, not {extent}."
            ),
            name=self.name,
            largest=MAX_COORDINATE,
            extent=self.extent,
        )

    @property
    def effective_weight(self) -> float:
        """Weight in the solver, with the factor of a locked handle."""
        return self.weight * (LOCKED_WEIGHT if self.locked else 1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """Position of a handle in a pose."""

    position: complex  # in pixels of the picture, y up; may lie outside the picture
    # Rotation of the shape at the handle in radians; None leaves the rotation free.
    rotation: float | None = None
    # To which side a joint of bones bends: 1 to the left of the way from root to end, -1 to the
    # right. None keeps the side to which it bends.
    side: int | None = None
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_point(self.position, _("The target of a handle"))
        require(
            self.side in {None, 1, -1},
            N_("The side of a joint must be 1 (left) or -1 (right), not {side}."),
            side=self.side,
        )
        require(
            self.rotation is None or math.isfinite(self.rotation),
            N_("The rotation of a handle must be finite, not {rotation}."),
            rotation=self.rotation,
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """A harmonic map and the targets that it was solved for."""

    targets: Mapping[int, Target]  # by handle id, one for each handle of the layer
    # complex128 (n,): Coefficients of the map at the vertices of the cage, then of the holes'
    # cages.
    phi: Complexes
    psi: Complexes
    # complex128 (holes,): Coefficients of the map's logarithms.
    logs: Complexes = field(default_factory=lambda: freeze(np.empty(0, dtype=np.complex128)))
    # Proven distortion of the map, from the solver or from loading. A file does not contain it.
    certificate: Certificate

    def __post_init__(self) -> None:
        object.__setattr__(self, "targets", MappingProxyType(dict(self.targets)))
        object.__setattr__(self, "phi", as_points(self.phi, "phi", at_least=3))
        object.__setattr__(self, "psi", as_points(self.psi, "psi", at_least=3))
        object.__setattr__(self, "logs", as_points(self.logs, "logs"))
        largest = max(np.abs(each).max(initial=0.0) for each in (self.phi, self.psi, self.logs))
        require(
            largest <= LARGEST_COEFFICIENT,
            N_(
                "The coefficients of a pose can be at most {most:g} pixels, not {largest:.3g}. "
                "Move the pose's targets nearer, or choose tighter limits."
            ),
            most=LARGEST_COEFFICIENT,
            largest=largest,
        )

    @classmethod
    def of(
        cls, harmonic_map: HarmonicMap, targets: Mapping[int, Target], certificate: Certificate
    ) -> "Pose":
        f = harmonic_map
        return cls(targets=targets, phi=f.phi, psi=f.psi, logs=f.logs, certificate=certificate)

    @property
    def nbytes(self) -> int:
        """Memory of the map in bytes."""
        return self.phi.nbytes + self.psi.nbytes + self.logs.nbytes

    def with_map(self, harmonic_map: HarmonicMap) -> "Pose":
        f = harmonic_map
        return replace(self, phi=f.phi, psi=f.psi, logs=f.logs)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LibraryPose:
    """A pose in a layer's library; the name is unique there."""

    name: str
    pose: Pose
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(bool(self.name.strip()), N_("A pose in the library needs a name."))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Keyframe(BaseKey):
    """A pose at a frame, and the motion to the next key; equal only to itself."""

    pose: Pose
    # Additional full turns of the anchor until the next key, counter-clockwise.
    revolutions: int = 0
    motion: int | None = None  # id of the motion preset that made the key

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __post_init__(self) -> None:
        BaseKey.__post_init__(self)
        require(
            abs(self.revolutions) <= MAX_REVOLUTIONS,
            N_(
                "A handle can make at most {most} whole turns on the way to a key, not "
                "{revolutions}."
            ),
            most=MAX_REVOLUTIONS,
            revolutions=self.revolutions,
        )

    def copied(self, frame: int) -> Self:
        """Return a copy of the key for another frame; it belongs to no motion preset."""
        return replace(self, frame=frame, motion=None)

    def with_easing_of(self, other: Self, *, backwards: bool = False) -> Self:
        """Return the key with the segment of another key, or with that segment reversed."""
        turns = -other.revolutions if backwards else other.revolutions
        eased = BaseKey.with_easing_of(self, other, backwards=backwards)
        return replace(eased, revolutions=turns)
