"""Kinds of channels, and addresses of channels in a document."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import Enum, auto
from itertools import pairwise
from math import inf
from typing import Any, Generic, TypeVar

from app.document.channels.easing import LINEAR, Easing
from app.document.channels.key import BaseKey, Key, KeyedProperty
from app.document.channels.tangent_mode import TangentMode
from app.document.checks import MAX_COORDINATE, NOTHING, Unknown, require
from app.errors import LissomError
from app.texts import N_, _

V = TypeVar("V")
BAD_VELOCITIES = N_(
    "{channel} of {owner!r}: the velocities of the key at frame {frame} do not fit its value."
)
KEYS_OUT_OF_ORDER = N_(
    "{channel} of {owner!r}: the keys at frames {before} and {after} are out of order."
)


class Quantity(Enum):
    """What a field of a value measures: it decides the form in files, scripts and panels."""

    NUMBER = auto()
    FACTOR = auto()  # above 0
    SHARE = auto()  # from 0 to 1
    DEPTH = auto()  # from −1 to 1
    POINT = auto()  # pixels
    ANGLE = auto()  # radians; degrees in scripts and panels
    FLAG = auto()
    LAYER = auto()  # id; name in scripts
    MEMBER = auto()  # of a switch: id of a layer, or path of a group; name in scripts
    COLOUR = auto()  # red, green and blue, each from 0 to 1
    VALUE = auto()  # of a slider, complex: one number, or two of a pad
    ANYTHING = auto()  # JSON that the kind does not read


@dataclass(frozen=True, slots=True)
class ValueField:
    """A named part of a value."""

    name: str
    quantity: Quantity
    is_optional: bool = False  # whether it may be None
    default: object = ...  # of a script; ... if the field must be given
    label: str = ""  # marked; empty if the field has no name of its own in the window
    limits: tuple[float, float] = (-inf, inf)  # of each of its numbers


@dataclass(frozen=True, kw_only=True, eq=False)  # no slots: they do not combine with Generic
class ChannelKind(Generic[V]):
    """What all channels of one kind have in common."""

    name: str  # in files and scripts
    label: str  # marked
    icon: str  # name of a Font Awesome icon
    fields: tuple[ValueField, ...] = ()
    # Makes a value from its fields; a value of one field is that field itself.
    make: Callable[..., V] = lambda value: value
    # Numbers that are interpolated; without them, a key holds until the next one.
    components: tuple[KeyedProperty[Key[V], Any], ...] = ()
    join: Callable[..., V] = lambda value: value  # makes a value from its components
    of_handles: bool = False  # whether each handle has a channel of the kind, named by its id
    of_sliders: bool = False  # whether each slider has a channel of the kind, of its name
    is_blended: bool = False  # whether a module of its own interpolates, as the engine does poses
    check: Callable[[V], None] = lambda _: None  # raises a `LissomError`
    tangent_mode: TangentMode = TangentMode.SMOOTH  # of new keys
    holds_before: bool = False  # whether the first key holds before its frame too
    moves_layer: bool = False  # whether it changes where a layer is, or its shape
    # Uniform of the shader `ghost.frag` that takes the value when a layer is composited. The layer
    # looks unchanged with the default value.
    uniform: str = ""

    @property
    def is_held(self) -> bool:
        """Whether a key holds until the next one."""
        return not (self.components or self.is_blended)

    def key(
        self,
        frame: int,
        value: V,
        *,
        easing: Easing = LINEAR,
        tangent_mode: TangentMode | None = None,
        unknown: Unknown = NOTHING,
    ) -> Key[V]:
        """Return a key; by default with the kind's tangent mode."""
        tangent = self.tangent_mode if tangent_mode is None else tangent_mode
        return Key(frame=frame, value=value, easing=easing, tangent_mode=tangent, unknown=unknown)

    def require(self, keys: tuple[Key[V], ...], owner: str) -> None:
        """Refuse values that the kind does not allow, and keys out of order."""
        for key in keys:
            self.check(key.value)
            require(
                len(key.velocities) in (0, len(self.components))
                and all(abs(each or 0) <= MAX_COORDINATE for each in key.velocities),
                BAD_VELOCITIES,
                channel=_(self.label),
                owner=owner,
                frame=key.frame,
            )
        require_order(keys, self.label, owner)

    @property
    def default(self) -> V:
        """The value whose fields have their defaults."""
        return self.make(*(each.default for each in self.fields))

    @property
    def layer_fields(self) -> tuple[str, ...]:
        """Names of the fields that refer to a layer."""
        return tuple(each.name for each in self.fields if each.quantity is Quantity.LAYER)

    def field_of(self, value: V, name: str) -> Any:
        """Return a field of a value; the only field is the value itself."""
        return value if len(self.fields) == 1 else getattr(value, name)


def require_order(keys: tuple[BaseKey, ...], label: str, owner: str) -> None:
    """Refuse keys that are not in the order of their frames; `label` is marked."""
    for before, after in pairwise(key.frame for key in keys):
        if before >= after:
            raise LissomError(
                _(KEYS_OUT_OF_ORDER).format(
                    channel=_(label), owner=owner, before=before, after=after
                )
            )


@dataclass(frozen=True)
class Channel(Generic[V]):
    """The address of a channel in a document."""

    kind: ChannelKind[V]
    layer: int | None = None  # id; None for a channel of the whole scene
    part: int | str | None = None  # such as a handle's id, or a switch's name

    @property
    def id(self) -> tuple[str, int | str | None]:
        """The name within the layer."""
        return self.kind.name, self.part


# Frames of keys, by channel.
KeysByChannel = Mapping[Channel[Any], frozenset[int]]
ChannelId = tuple[str, int | str | None]
ChannelKeys = Mapping[ChannelId, tuple[Key[Any], ...]]
