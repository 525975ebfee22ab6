"""Bones of a layer, and the chains that they form.

A bone leads from its root to its end. Bones that follow each other form a chain, such as shoulder,
elbow and hand. A chain ends where no bone or more than one bone starts.
"""

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

from app.document.checks import NOTHING, Unknown, require
from app.document.rig.stiffness import require_stiffness_amount
from app.errors import LissomError
from app.texts import N_, _

DEFAULT_BONE_STIFFNESS = 10.0  # default of a bone
TWO_BONES_END = N_(
    "Two bones end at {handle!r}. One bone can end at a handle, and any number can start there: "
    "name bones from root to end, or delete one."
)
CIRCLE_OF_BONES = N_("The bones {bones} form a circle. Delete one of them.")


@dataclass(frozen=True, slots=True, kw_only=True)
class Bone:
    """A straight limb between two handles, which keeps its length.

    Around the bone the drawing is stiffer, except at its joints. A bone with a stiffness of at most
    1 is a soft strip, and no limb.
    """

    ends: tuple[int, int]  # handle ids: root and end
    stiffness: float = DEFAULT_BONE_STIFFNESS  # of the drawing around it, from 1/30 to 100
    is_shown: bool = True  # in the window; a hidden bone acts too
    # Whether the first handle is the root. Earlier versions had bones without a direction.
    is_directed: bool = True
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(self.ends[0] != self.ends[1], N_("A bone must connect two different handles."))
        require_stiffness_amount(self.stiffness)

    def is_between(self, ends: Sequence[int]) -> bool:
        """Return whether the bone joins these two handles, in either order."""
        return set(ends) == set(self.ends)

    @property
    def is_limb(self) -> bool:
        """Whether the bone keeps its length."""
        return self.stiffness > 1 and self.is_directed


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """Handles along bones: the root, the joints, and the end."""

    handles: tuple[int, ...]

    @property
    def root(self) -> int:
        return self.handles[0]

    @property
    def end(self) -> int:
        return self.handles[-1]


def find_chains(bones: Iterable[Bone]) -> tuple[Chain, ...]:
    """Return the chains of the bones that keep their lengths, each after the one it starts at."""
    children = _children(bones)
    ends = {child for starting in children.values() for child in starting}
    found, waiting = list[Chain](), [root for root in children if root not in ends]
    while waiting:
        root = waiting.pop(0)
        for child in children.get(root, ()):
            handles = [root, child]
            while len(children.get(handles[-1], ())) == 1:
                handles += children[handles[-1]]
            found.append(Chain(handles=tuple(handles)))
            waiting.append(handles[-1])
    return tuple(found)


def require_chains(bones: Sequence[Bone], names: Mapping[int, str]) -> None:
    """Raise a `LissomError` if two bones end at one handle, or bones form a circle."""
    children = _children(bones)
    for end, count in Counter(end for ends in children.values() for end in ends).items():
        require(count == 1, TWO_BONES_END, handle=names.get(end, str(end)))
    parents = {end: root for root, ends in children.items() for end in ends}
    for start in sorted(parents):
        way = [start]
        while way[-1] in parents and len(way) <= len(parents):
            way.append(parents[way[-1]])
            if way[-1] == start:
                circle = " – ".join(names.get(each, str(each)) for each in reversed(way))
                raise LissomError(_(CIRCLE_OF_BONES).format(bones=circle))


def _children(bones: Iterable[Bone]) -> dict[int, list[int]]:
    children: dict[int, list[int]] = {}
    for bone in bones:
        if bone.is_limb:
            children.setdefault(bone.ends[0], []).append(bone.ends[1])
    return children
