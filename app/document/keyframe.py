"""Handles, and the poses into which keys pull them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from app.document.checks import NOTHING, Unknown, require, require_place
from app.document.easing import LINEAR, Easing
from engine.arrays import Complexes, as_points
from engine.maps import Certificate

HEAVIEST = 1e6
MOST_TURNS = 20


@dataclass(frozen=True, slots=True, kw_only=True)
class Handle:
    """A named point of the picture by which poses are pulled.

    Parameters
    ----------
    id : int
        Never given twice in one document.
    name : str
        Unique in the document.
    position : complex
        Where it sits in the picture at rest, in pixels, y up.
    weight : float
        How strongly it pulls, relative to others.
    """

    id: int
    name: str
    position: complex
    weight: float = 1.0
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(self.id >= 0, f"A handle's id is not negative, unlike {self.id}.")
        require(bool(self.name.strip()), "A handle needs a name.")
        require_place(self.position, f"The position of handle {self.name!r}")
        require(
            0 < self.weight <= HEAVIEST,
            f"The weight of handle {self.name!r} must be above 0 and at most {HEAVIEST:,.0f}, "
            f"not {self.weight:g}.",
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Target:
    """Where a pose wants a handle.

    Parameters
    ----------
    position : complex
        In pixels of the picture, y up; it may lie outside the picture.
    rotation : float, optional
        By how much the shape turns at the handle, in radians; None leaves that free.
    """

    position: complex
    rotation: float | None = None
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require_place(self.position, "The target of a handle")
        require(
            self.rotation is None or math.isfinite(self.rotation),
            f"The rotation of a handle must be finite, not {self.rotation}.",
        )


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Pose:
    """A map with the wishes that it was solved for.

    Parameters
    ----------
    targets : mapping of int to Target
        One for each handle of the document, by the handle's id.
    phi, psi : complex128, shape (n,)
        Coefficients of the map over the domain's cage.
    certificate : Certificate
        What is proven of the map, by the solver or when it was read; it is never written.
    """

    targets: Mapping[int, Target]
    phi: Complexes
    psi: Complexes
    certificate: Certificate

    def __post_init__(self) -> None:
        object.__setattr__(self, "targets", MappingProxyType(dict(self.targets)))
        object.__setattr__(self, "phi", as_points(self.phi, "phi", at_least=3))
        object.__setattr__(self, "psi", as_points(self.psi, "psi", at_least=3))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeptPose:
    """A pose in a figure's library, under a name.

    Parameters
    ----------
    name : str
        Unique in the library.
    pose : Pose
    """

    name: str
    pose: Pose
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(bool(self.name.strip()), "A pose of the library needs a name.")


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Keyframe:
    """A pose at a frame, and the way from there to the next key.

    Parameters
    ----------
    frame : int
    pose : Pose
    easing : Easing
        How time runs until the next key.
    turns : int
        Whole turns, counter-clockwise, that the anchor makes on the way beyond the shorter way.
    """

    frame: int
    pose: Pose
    easing: Easing = LINEAR
    turns: int = 0
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(
            abs(self.turns) <= MOST_TURNS,
            f"There may be {MOST_TURNS} whole turns on the way to a key, not {self.turns}.",
        )
