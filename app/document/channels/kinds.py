"""The table of all kinds of channels."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from math import exp, log, tau
from types import MappingProxyType
from typing import Any, Final

from app.document.channels.key import Key, KeyedProperty
from app.document.channels.kind import ChannelKind, Quantity, ValueField
from app.document.channels.tangent_mode import TangentMode
from app.document.channels.tracks import MAX_TRACK_ROTATION
from app.document.channels.values import (
    MAX_SCALE,
    MAX_ZOOM,
    Camera,
    DrawOrder,
    FootageTime,
    IkTarget,
    Transform,
)
from app.document.checks import MAX_COORDINATE, require
from app.texts import N_

# Keys closer than this count as equal: pixels, radians, logarithms of zoom, and opacity.
SAME_PLACE, SAME_TURN, SAME_ZOOM, SAME_OPACITY = 0.01, 1e-4, 1e-5, 1e-4
SAME_VALUE, LARGEST_VALUE = 1e-6, 1e6  # of sliders
# Limits of the numbers of keys: pixels, radians, and factors.
PLACES, TURNS = (-MAX_COORDINATE, MAX_COORDINATE), (-MAX_TRACK_ROTATION, MAX_TRACK_ROTATION)
ZOOMS, SCALES, SHARES = (1 / MAX_ZOOM, MAX_ZOOM), (1 / MAX_SCALE, MAX_SCALE), (0.0, 1.0)
SLIDER_VALUES = (-LARGEST_VALUE / 2, LARGEST_VALUE / 2)


def _components(*components: KeyedProperty[Any, Any]) -> tuple[KeyedProperty[Any, Any], ...]:
    """Return the components of a kind, each with the velocities that its keys have for it."""
    return tuple(
        replace(each, velocity=partial(_velocity, component=index))
        for index, each in enumerate(components)
    )


def _velocity(key: Key[Any], component: int) -> Any:
    return key.velocity_of(component)


def _clipped(place: complex) -> complex:
    """Return a point between keys within the limits of keys, which smooth motion may pass."""
    x, y = (min(max(each, -MAX_COORDINATE), MAX_COORDINATE) for each in (place.real, place.imag))
    return complex(x, y)


def _grown(logarithm: float, most: float) -> float:
    """Return a factor between keys within the limits of keys, from its logarithm."""
    return min(max(exp(min(logarithm, log(most))), 1 / most), most)


def require_opacity(opacity: float) -> None:
    """Refuse an opacity outside 0 to 1."""
    require(0 <= opacity <= 1, N_("Opacity must be from 0 to 1, not {opacity:g}."), opacity=opacity)


def require_volume(volume: float) -> None:
    """Refuse a volume outside 0 to 1."""
    require(0 <= volume <= 1, N_("A volume must be from 0 to 1, not {volume:g}."), volume=volume)


def require_colour(colour: tuple[float, float, float]) -> None:
    """Refuse a colour that is not three levels from 0 to 1."""
    require(
        len(colour) == 3 and all(0 <= level <= 1 for level in colour),
        N_("A colour must be three numbers from 0 to 1, not {colour}."),
        colour=colour,
    )


def require_depth(depth: float) -> None:
    """Refuse a depth outside −1 to 1."""
    require(
        -1 <= depth <= 1,
        N_("A depth must be from −1 (behind) to 1 (in front), not {depth:g}."),
        depth=depth,
    )


def require_value(value: complex) -> None:
    """Refuse a slider's value that is not finite."""
    require(
        abs(value) <= LARGEST_VALUE,
        N_("The value of a slider must be at most {largest:,.0f}, not {value}."),
        largest=LARGEST_VALUE,
        value=f"{abs(value):g}",
    )


# Whose keys have classes of their own.
POSE: Final = ChannelKind[Any](name="pose", label=N_("Poses"), icon="PERSON", is_blended=True)
TRACK: Final = ChannelKind[Any](
    name="track",
    label=N_("Track"),
    icon="CROSSHAIRS",
    fields=(
        ValueField("place", Quantity.POINT, limits=PLACES),
        ValueField("turn", Quantity.ANGLE, label=N_("Turn"), limits=TURNS),
    ),
    is_blended=True,
)
PARENT: Final = ChannelKind[Any](name="parent", label=N_("Parent"), icon="LINK")
MARKER: Final = ChannelKind[Any](name="marker", label=N_("Markers"), icon="BOOKMARK")

CAMERA: Final = ChannelKind[Camera](
    name="camera",
    label=N_("Camera"),
    icon="VIDEO",
    fields=(
        ValueField("centre", Quantity.POINT, limits=PLACES),
        ValueField("zoom", Quantity.FACTOR, default=1.0, label=N_("Zoom"), limits=ZOOMS),
        ValueField("turn", Quantity.ANGLE, default=0.0, label=N_("Turn"), limits=TURNS),
    ),
    make=Camera,
    components=_components(
        KeyedProperty(lambda key: key.value.centre, SAME_PLACE),
        KeyedProperty(lambda key: log(key.value.zoom), SAME_ZOOM),
        KeyedProperty(lambda key: key.value.turn, SAME_TURN, period=tau),
    ),
    join=lambda centre, zoom, turn: Camera(_clipped(centre), _grown(zoom, MAX_ZOOM), turn),
)
TRANSFORM: Final = ChannelKind[Transform](
    name="transform",
    label=N_("Transform"),
    icon="UP_DOWN_LEFT_RIGHT",
    fields=(
        ValueField("shift", Quantity.POINT, default=0j, limits=PLACES),
        ValueField("turn", Quantity.ANGLE, default=0.0, label=N_("Turn"), limits=TURNS),
        ValueField("scale", Quantity.FACTOR, default=1.0, label=N_("Scale"), limits=SCALES),
    ),
    make=Transform,
    components=_components(
        KeyedProperty(lambda key: key.value.shift, SAME_PLACE),
        KeyedProperty(lambda key: key.value.turn, SAME_TURN, period=tau),
        KeyedProperty(lambda key: log(key.value.scale), SAME_ZOOM),
    ),
    join=lambda shift, turn, scale: Transform(_clipped(shift), turn, _grown(scale, MAX_SCALE)),
    moves_layer=True,
)
IK_TARGET: Final = ChannelKind[IkTarget](
    name="ik_target",
    label=N_("IK target"),
    icon="BULLSEYE",
    fields=(
        ValueField("place", Quantity.POINT, limits=PLACES),
        ValueField("turn", Quantity.ANGLE, default=0.0, label=N_("Turn"), limits=TURNS),
        ValueField("mix", Quantity.SHARE, default=1.0, label=N_("Mix"), limits=SHARES),
    ),
    make=IkTarget,
    components=_components(
        KeyedProperty(lambda key: key.value.place, SAME_PLACE),
        KeyedProperty(lambda key: key.value.turn, SAME_TURN, period=tau),
        KeyedProperty(lambda key: key.value.mix, SAME_OPACITY),
    ),
    join=lambda place, turn, mix: IkTarget(_clipped(place), turn, min(max(mix, 0.0), 1.0)),
    moves_layer=True,
)
OPACITY: Final = ChannelKind[float](
    name="opacity",
    label=N_("Opacity"),
    icon="DROPLET",
    fields=(
        ValueField("opacity", Quantity.SHARE, default=1.0, label=N_("Opacity"), limits=SHARES),
    ),
    components=_components(KeyedProperty(lambda key: key.value, SAME_OPACITY)),
    join=lambda opacity: min(max(opacity, 0.0), 1.0),
    check=require_opacity,
    tangent_mode=TangentMode.CORNER,  # linear fades
)
DRAW_ORDER: Final = ChannelKind[DrawOrder](
    name="draw_order",
    label=N_("Draw order"),
    icon="LAYER_GROUP",
    fields=(
        ValueField("beside", Quantity.LAYER, is_optional=True, default=None),
        ValueField("in_front", Quantity.FLAG, default=True),
    ),
    make=DrawOrder,
)
VISIBILITY: Final = ChannelKind[bool](
    name="visibility",
    label=N_("Visibility"),
    icon="EYE",
    fields=(
        ValueField("visible", Quantity.FLAG, default=True, label=N_("Visible"), limits=SHARES),
    ),
    holds_before=True,
)
SwitchMember = int | str  # the id of a layer, or the path of a group
SWITCH: Final = ChannelKind[SwitchMember](
    name="switch",
    label=N_("Switch"),
    icon="MASKS_THEATER",
    fields=(ValueField("layer", Quantity.MEMBER),),
    holds_before=True,
)
TINT: Final = ChannelKind[tuple[float, float, float]](
    name="tint",
    label=N_("Tint"),
    icon="PALETTE",
    fields=(ValueField("tint", Quantity.COLOUR, default=(1.0, 1.0, 1.0), limits=SHARES),),
    components=_components(
        KeyedProperty(lambda key: key.value[0], SAME_OPACITY),
        KeyedProperty(lambda key: key.value[1], SAME_OPACITY),
        KeyedProperty(lambda key: key.value[2], SAME_OPACITY),
    ),
    join=lambda *levels: tuple(min(max(level, 0.0), 1.0) for level in levels),
    check=require_colour,
    tangent_mode=TangentMode.CORNER,
    uniform="layer_tint",
)
FOOTAGE_TIME: Final = ChannelKind[FootageTime](
    name="footage_time",
    label=N_("Footage time"),
    icon="FILM",
    fields=(
        ValueField("start", Quantity.NUMBER, default=0.0, label=N_("Starts at")),
        ValueField("speed", Quantity.NUMBER, default=1.0, label=N_("Speed")),
        ValueField("loops", Quantity.FLAG, default=False),
    ),
    make=FootageTime,
    holds_before=True,
)
DEPTH: Final = ChannelKind[float](
    name="depth",
    label=N_("Depth"),
    icon="CLONE",
    fields=(ValueField("depth", Quantity.DEPTH, label=N_("Depth"), limits=(-1.0, 1.0)),),
    of_handles=True,
    check=require_depth,
    moves_layer=True,
)
SLIDER: Final = ChannelKind[complex](
    name="slider",
    label=N_("Slider"),
    icon="SLIDERS",
    fields=(ValueField("value", Quantity.VALUE, limits=SLIDER_VALUES),),
    components=_components(KeyedProperty(lambda key: key.value, SAME_VALUE)),
    of_sliders=True,
    check=require_value,
    moves_layer=True,
)

VOLUME: Final = ChannelKind[float](
    name="volume",
    label=N_("Volume"),
    icon="VOLUME_HIGH",
    fields=(ValueField("volume", Quantity.SHARE, default=1.0, label=N_("Volume"), limits=SHARES),),
    components=_components(KeyedProperty(lambda key: key.value, SAME_OPACITY)),
    join=lambda volume: min(max(volume, 0.0), 1.0),
    check=require_volume,
    tangent_mode=TangentMode.CORNER,  # linear fades
)

# Kinds whose keys a layer stores by their channels' ids.
LAYER_KINDS: Final[Mapping[str, ChannelKind[Any]]] = MappingProxyType(
    {
        each.name: each
        for each in (
            *(TRANSFORM, IK_TARGET, OPACITY, TINT, DRAW_ORDER, VISIBILITY, FOOTAGE_TIME),
            *(DEPTH, SLIDER),
        )
    }
)
