"""Switch groups: layers and groups of which exactly one is visible."""

from bisect import bisect_right
from dataclasses import dataclass, field
from operator import attrgetter

from app.document.channels.key import Key
from app.document.channels.kinds import SWITCH, SwitchMember
from app.document.checks import NOTHING, Unknown, require, require_distinct
from app.errors import LissomError
from app.texts import N_, _


@dataclass(frozen=True, slots=True, kw_only=True)
class SwitchGroup:
    """Layers and groups of layers of which exactly one is visible, such as mouths.

    The switch group alone decides about them: a hidden member is visible when it is chosen, and has
    no visibility keys. The layers inside a chosen group keep their own visibility.
    """

    name: str  # unique in the document
    members: tuple[SwitchMember, ...]  # at least two, in the order of the list
    # The visible member, in the order of the frames. The first key holds before its frame too;
    # without keys, the first member is visible.
    keys: tuple[Key[SwitchMember], ...] = ()
    unknown: Unknown = field(default_factory=lambda: NOTHING, repr=False, hash=False)

    def __post_init__(self) -> None:
        require(bool(self.name.strip()), N_("A switch needs a name."))
        require(
            len(self.members) > 1,
            N_("The switch {name!r} needs at least two layers."),
            name=self.name,
        )
        require_distinct(self.members, N_("A switch lists {value!r} twice; list it once."))
        known = set(self.members)
        for key in self.keys:
            if key.value not in known:
                raise LissomError(
                    _(
                        "At frame {frame} the switch {name!r} shows a layer that is not in the "
                        "switch."
                    ).format(name=self.name, frame=key.frame)
                )
        SWITCH.require(self.keys, self.name)

    def member_at(self, frame: float) -> SwitchMember:
        """Return the visible member at a frame."""
        count = self.count_keys_until(frame)
        return self.keys[max(count - 1, 0)].value if self.keys else self.members[0]

    def count_keys_until(self, frame: float) -> int:
        """Return the number of switch keys at or before a frame."""
        return bisect_right(self.keys, frame, key=attrgetter("frame"))
