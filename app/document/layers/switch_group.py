"""Switch groups: layers of which exactly one is visible."""

from bisect import bisect_right
from dataclasses import dataclass, field
from operator import attrgetter

from app.document.channels.key import Key
from app.document.channels.kinds import SWITCH
from app.document.checks import NOTHING, Unknown, require, require_distinct
from app.errors import LissomError
from app.texts import N_, _


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchGroup:
    """Layers of which exactly one is visible, such as mouths.

    The switch group alone decides their visibility; their own settings do not count.
    """

    name: str  # unique in the document
    layers: tuple[int, ...]  # layer ids, at least two, in the order of the list
    # Ids of the visible layer, in the order of their frames. The first key holds before its frame
    # too; without keys, the first layer is visible.
    keys: tuple[Key[int], ...] = ()
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
        for key in self.keys:
            if key.value not in known:
                raise LissomError(
                    _(
                        "At frame {frame} the switch {name!r} shows a layer that is not in the "
                        "switch."
                    ).format(name=self.name, frame=key.frame)
                )
        SWITCH.require(self.keys, self.name)

    def layer_at(self, frame: float) -> int:
        """Return the id of the visible layer at a frame."""
        count = self.count_keys_until(frame)
        return self.keys[max(count - 1, 0)].value if self.keys else self.layers[0]

    def count_keys_until(self, frame: float) -> int:
        """Return the number of switch keys at or before a frame."""
        return bisect_right(self.keys, frame, key=attrgetter("frame"))
