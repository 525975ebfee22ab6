"""Kinds of bodies: which joints they have, and what hangs on what."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from engine.errors import EngineError

MOST_LINKS = 24
LINK = "joint.{}"
_ARMS = {
    name.format(side): parent.format(side)
    for side in "LR"
    for name, parent in {
        "shoulder.{}": "chest",
        "elbow.{}": "shoulder.{}",
        "hand.{}": "elbow.{}",
    }.items()
}
_LEGS = {
    name.format(side): parent.format(side)
    for side in "LR"
    for name, parent in {"hip.{}": "hips", "knee.{}": "hip.{}", "foot.{}": "knee.{}"}.items()
}
_TRUNK = {"hips": "", "chest": "hips", "neck": "chest", "head": "neck", "tail": "hips"}
_BODY: Mapping[str, str] = MappingProxyType(_TRUNK | _ARMS | _LEGS)
_LINKS: Mapping[str, str] = MappingProxyType(
    {LINK.format(n): LINK.format(n - 1) if n > 1 else "" for n in range(1, MOST_LINKS + 1)}
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Kind:
    """What joints a body may have; any of them may be left out that no motion needs.

    Of four legs, the front ones are the arms of a biped: shoulder, elbow, hand. Seen from the side
    `.L` and `.R` are the two legs of a pair, whichever is nearer.
    """

    name: str
    label: str
    hint: str
    parents: Mapping[str, str]  # of each joint in their order; that of the root is ""
    usual: tuple[str, ...]  # those that are suggested, as far as they are found

    def parent(self, joint: str, present: Collection[str]) -> str:
        """Return the nearest joint before one that is there; "" where there is none."""
        before = self.parents[joint]
        while before and before not in present:
            before = self.parents[before]
        return before

    def require_joints(self, joints: Collection[str]) -> None:
        """Raise an `EngineError` where there is a joint that the kind does not have."""
        for joint in joints:
            if joint not in self.parents:
                some = ", ".join(list(self.parents)[:MOST_LINKS])
                known = some if self.parents else "none: it moves as a whole"
                raise EngineError(f"{self.name!r} has no joint {joint!r}; it has {known}")


_SOCKETS = {"hip.L", "hip.R", "shoulder.L", "shoulder.R"}
_ALWAYS = tuple(joint for joint in _BODY if joint not in {"neck", "tail"})

BIPED_FRONT = Kind(
    name="biped-front",
    label="Two legs, from the front",
    hint="A person, a robot, a bear that stands",
    parents=_BODY,
    usual=_ALWAYS,
)
BIPED_SIDE = Kind(
    name="biped-side",
    label="Two legs, from the side",
    hint="A person, a bird, a kangaroo",
    parents=_BODY,
    usual=tuple(joint for joint in _ALWAYS if joint not in _SOCKETS),
)
FOUR_LEGS = Kind(
    name="four-legs",
    label="Four legs, from the side",
    hint="A horse, a dog, a lizard",
    parents=_BODY,
    usual=tuple(joint for joint in _BODY if joint not in _SOCKETS | {"neck"}),
)
CHAIN = Kind(
    name="chain",
    label="A chain",
    hint="A snake, a fish, a tail, a scarf: from the end that leads, or is held, to the other one",
    parents=_LINKS,
    usual=tuple(_LINKS)[:7],
)
ANYTHING = Kind(
    name="anything",
    label="Anything else",
    hint="A ghost, a tree, a teapot: it moves as a whole, without joints",
    parents=MappingProxyType({}),
    usual=(),
)
KINDS: Mapping[str, Kind] = MappingProxyType(
    {kind.name: kind for kind in (BIPED_FRONT, BIPED_SIDE, FOUR_LEGS, CHAIN, ANYTHING)}
)


def kind_named(name: str) -> Kind:
    """Return the kind of a name; raise an `EngineError` where there is none."""
    if name not in KINDS:
        raise EngineError(f"there is no kind {name!r}; the kinds are {', '.join(KINDS)}")
    return KINDS[name]
