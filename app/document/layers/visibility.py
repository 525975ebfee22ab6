"""Visibility keys and switch groups."""

from bisect import bisect_right
from dataclasses import dataclass, field
from itertools import pairwise
from operator import attrgetter
from typing import NamedTuple

from app.document.checks import NOTHING, Unknown, require, require_distinct, require_frame
from app.errors import LissomError
from app.texts import N_, _


@dataclass(frozen=True, slots=True)
class VisibilityKey:
    """From a frame on, the layer is visible or hidden."""

    frame: int
    visible: bool

    def __post_init__(self) -> None:
        require_frame(self.frame, _("A visibility key"))


def require_ascending_visibility_keys(switches: tuple[VisibilityKey, ...]) -> None:
    for before, after in pairwise(switches):
        require(
            before.frame < after.frame,
            N_("The visibility keys at frames {before} and {after} are out of order."),
            before=before.frame,
            after=after.frame,
        )


class SwitchKey(NamedTuple):
    """From a frame on, the layer with this id is the visible one of its switch group."""

    frame: int
    layer: int


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchGroup:
    """Layers of which exactly one is visible, such as mouths.

    The switch group alone decides their visibility; their own settings do not count.
    """

    name: str  # unique in the document
    layers: tuple[int, ...]  # layer ids, at least two, in the order of the list
    # In the order of their frames. The first key holds before its frame too; without keys, the
    # first layer is visible.
    keys: tuple[SwitchKey, ...] = ()
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(bool(self.name.strip()), N_("A switch needs a name."))
        require(
            len(self.layers) > 1,
            N_("The switch {name!r} needs at least two layers."),
            name=self.name,
        )
        require_distinct(self.layers, N_("A switch lists the layer {value!r} twice; list it once."))
        known = set(self.layers)
        for turn in self.keys:
            require_frame(turn.frame, _("A switch key"))
            if turn.layer not in known:
                raise LissomError(
                    _(
                        "At frame {frame} the switch {name!r} shows a layer that is not in the "
                        "switch."
                    ).format(name=self.name, frame=turn.frame)
                )
        for before, after in pairwise(self.keys):
            if before.frame >= after.frame:
                raise LissomError(
                    _(
                        "The switch keys of {name!r} at frames {before} and {after} are out of "
                        "order."
                    ).format(name=self.name, before=before.frame, after=after.frame)
                )

    def layer_at(self, frame: float) -> int:
        """Return the id of the visible layer at a frame."""
        count = self.count_keys_until(frame)
        return self.keys[max(count - 1, 0)].layer if self.keys else self.layers[0]

    def count_keys_until(self, frame: float) -> int:
        """Return the number of switch keys at or before a frame."""
        return bisect_right(self.keys, frame, key=attrgetter("frame"))
