"""Kinds of bodies: their joints and the parent of each joint."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from app.texts import _
from engine.errors import EngineError

_TRUNK = {"hips": "", "chest": "hips", "neck": "chest", "head": "neck"}
# A tail has up to four bones: from its base, tail.1, to its tip, tail.
_TAIL = {
    "tail.1": "hips",
    "tail.2": "tail.1",
    "tail.3": "tail.2",
    "tail.4": "tail.3",
    "tail": "tail.4",
}
_ARMS = {
    "shoulder.L": "chest",
    "elbow.L": "shoulder.L",
    "hand.L": "elbow.L",
    "shoulder.R": "chest",
    "elbow.R": "shoulder.R",
    "hand.R": "elbow.R",
}
_LEGS = {
    "hip.L": "hips",
    "knee.L": "hip.L",
    "foot.L": "knee.L",
    "hip.R": "hips",
    "knee.R": "hip.R",
    "foot.R": "knee.R",
}
_BODY: Mapping[str, str] = MappingProxyType(_TRUNK | _TAIL | _ARMS | _LEGS)
_LINKS: Mapping[str, str] = MappingProxyType(
    {
        "joint.1": "",
        "joint.2": "joint.1",
        "joint.3": "joint.2",
        "joint.4": "joint.3",
        "joint.5": "joint.4",
        "joint.6": "joint.5",
        "joint.7": "joint.6",
        "joint.8": "joint.7",
        "joint.9": "joint.8",
        "joint.10": "joint.9",
        "joint.11": "joint.10",
        "joint.12": "joint.11",
        "joint.13": "joint.12",
        "joint.14": "joint.13",
        "joint.15": "joint.14",
        "joint.16": "joint.15",
    }
)


@dataclass(frozen=True, slots=True, kw_only=True)
class BodyKind:
    """The joints that a body may have; joints that no motion needs may be missing.

    The front legs of four-legged bodies use the names of a biped's arm: shoulder, elbow, hand. Seen
    from the side, the near side is the right one of a body that faces right, else the left one.
    """

    name: str
    label: str
    hint: str
    parents: Mapping[str, str]  # of each joint in order; "" for the root
    usual: tuple[str, ...]  # joints that are suggested if they are found
    is_side_view: bool = False  # whether a side is near and the other far

    def parent(self, joint: str, present: Collection[str]) -> str:
        """Return the nearest ancestor of a joint that is present; "" if there is none."""
        before = self.parents[joint]
        while before and before not in present:
            before = self.parents[before]
        return before

    def require_joints(self, joints: Collection[str]) -> None:
        """Raise an `EngineError` for a joint that the kind does not have."""
        for joint in joints:
            if joint not in self.parents:
                if not self.parents:
                    raise EngineError(
                        "{kind!r} moves as a whole; it has no joints.", kind=self.name
                    )
                raise EngineError(
                    "{kind!r} has no joint {joint!r}; choose one of {joints}.",
                    kind=self.name,
                    joint=joint,
                    joints=", ".join(self.parents),
                )


_ALWAYS = ("hips", "chest", "head", *_ARMS, *_LEGS)


def near_side(facing: int) -> str:
    """Return the near side of a body seen from the side: "L" or "R"."""
    return "R" if facing > 0 else "L"


BIPED_FRONT = BodyKind(
    name="biped-front",
    label=_("Two legs, from the front"),
    hint=_("A person, a robot, a bear that stands"),
    parents=_BODY,
    usual=_ALWAYS,
)
BIPED_SIDE = BodyKind(
    name="biped-side",
    label=_("Two legs, from the side"),
    hint=_("A person, a bird, a kangaroo"),
    parents=_BODY,
    usual=_ALWAYS,
    is_side_view=True,
)
FOUR_LEGS = BodyKind(
    name="four-legs",
    label=_("Four legs, from the side"),
    hint=_("A horse, a dog, a lizard"),
    parents=_BODY,
    usual=(*_ALWAYS, "tail"),
    is_side_view=True,
)
CHAIN = BodyKind(
    name="chain",
    label=_("A chain"),
    hint=_(
        "A snake, a fish, a tail, a scarf: from the end that leads, or is held, to the other end"
    ),
    parents=_LINKS,
    usual=("joint.1", "joint.2", "joint.3", "joint.4", "joint.5", "joint.6", "joint.7"),
)
ANYTHING = BodyKind(
    name="anything",
    label=_("Anything else"),
    hint=_("A ghost, a tree, a teapot: the body moves as a whole, without joints"),
    parents=MappingProxyType({}),
    usual=(),
)
KINDS: Mapping[str, BodyKind] = MappingProxyType(
    {
        "biped-front": BIPED_FRONT,
        "biped-side": BIPED_SIDE,
        "four-legs": FOUR_LEGS,
        "chain": CHAIN,
        "anything": ANYTHING,
    }
)


def find_kind(name: str) -> BodyKind:
    """Return the kind with this name; raise an `EngineError` if there is none."""
    if name not in KINDS:
        raise EngineError(
            "There is no kind of body {name!r}; choose one of {kinds}.",
            name=name,
            kinds=", ".join(KINDS),
        )
    return KINDS[name]
