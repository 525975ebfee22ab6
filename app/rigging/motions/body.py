"""A drawing as motions see it: joints at rest, lengths, and facing."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Self

import numpy as np

from app.rigging.motions.kinds import BodyKind
from engine.arrays import as_points
from engine.errors import EngineError

JOINTS_MEET = "The joints {one} and {other} are at the same point; move them apart."
JOINTS_MISSING = "{what} needs {joints} of {kind!r}."
NO_BOX = "The box of a body has no width or no height: it runs from {low} to {high}."
SIDES = {"L": "R", "R": "L"}


def other_side(joint: str) -> str:
    """Return the joint on the other side; a joint without a side is returned itself."""
    name, dot, side = joint.rpartition(".")
    return f"{name}.{SIDES[side]}" if dot and side in SIDES else joint


def without_side(joint: str) -> str:
    name, dot, side = joint.rpartition(".")
    return name if dot and side in SIDES else joint


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """The joints of a drawing at rest.

    Parameters
    ----------
    joints : mapping of str to complex
        Places at rest, y up; for a kind without joints, any points by any names.
    box : tuple of complex
        The lower left and the upper right corner of the drawing.
    facing : int
        1 if the drawing faces right or the viewer, -1 if it faces left.
    crotch_room : mapping of str to float
        By feet of a pair of legs that are one above their crotch: distance of the legs there, in
        pixels, more if the crotch is near their roots.

    Raises
    ------
    EngineError
        If the kind has no such joint, a place is not finite, two joints of a limb coincide, or the
        box of a kind without joints has no width or no height.
    """

    kind: BodyKind
    joints: Mapping[str, complex]
    box: tuple[complex, complex]
    facing: int = 1
    crotch_room: Mapping[str, float] = field(default_factory=dict)
    parents: Mapping[str, str] = field(init=False)

    def __post_init__(self) -> None:
        joints, parents = dict(self.joints), dict.fromkeys(self.joints, "")
        if self.kind.parents:
            self.kind.require_joints(self.joints)
            joints = {name: joints[name] for name in self.kind.parents if name in joints}
            parents = {name: self.kind.parent(name, joints) for name in joints}
        as_points(list(joints.values()), "The joints of a body")
        for name, parent in parents.items():
            if parent and joints[name] == joints[parent]:
                raise EngineError(JOINTS_MEET, one=parent, other=name)
        low, high = as_points(self.box, "The corners of a body's box").tolist()
        is_flat = not (low.real < high.real and low.imag < high.imag)
        if is_flat and not self.kind.parents:
            raise EngineError(NO_BOX, low=low, high=high)
        object.__setattr__(self, "joints", MappingProxyType(joints))
        object.__setattr__(self, "parents", MappingProxyType(parents))

    def require_joints(self, names: Iterable[str], what: str) -> None:
        """Raise an `EngineError` if a joint that `what` needs is missing."""
        missing = [name for name in names if name not in self.joints]
        if missing:
            raise EngineError(
                JOINTS_MISSING, what=what, joints=", ".join(missing), kind=self.kind.name
            )

    def mirrored(self) -> Self:
        """Return the body with its sides swapped, facing the other way."""
        joints = {other_side(name): place for name, place in self.joints.items()}
        room = {other_side(name): room for name, room in self.crotch_room.items()}
        return replace(self, joints=joints, crotch_room=room, facing=-self.facing)

    def limb_joints(self, tip: str) -> tuple[str, ...]:
        """Return the joints of an arm or a leg from its root on the trunk to its tip."""
        self.require_joints([tip], "A limb")
        path = [tip]
        while path[-1] and without_side(path[-1]) not in {"hip", "shoulder", "hips", "chest"}:
            path.append(self.parents[path[-1]])
        return tuple(name for name in reversed(path) if name)

    def limb_length(self, joint: str) -> float:
        """Return the length of the arm or the leg of a joint, from its root to its tip."""
        side = joint[-2:]
        tips = [f"{tip}{side}" for tip in ("hand", "foot") if f"{tip}{side}" in self.joints]
        limbs = [names for names in map(self.limb_joints, tips) if joint in names]
        return self.path_length(limbs[0]) if limbs else 0.0

    @property
    def tail(self) -> tuple[str, ...]:
        """The joints of the tail from its base to its tip; only the tip of a tail without bones."""
        return tuple(name for name in self.joints if name.partition(".")[0] == "tail")

    def path_length(self, joints: Iterable[str]) -> float:
        names = list(joints)
        self.require_joints(names, "A length")
        places = np.array([self.joints[name] for name in names])
        return float(np.abs(np.diff(places)).sum())
