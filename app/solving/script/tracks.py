"""Tracks, springs and cycles in a pose script."""

from collections.abc import Mapping, Sequence
from math import radians

from app.document import (
    HOLD,
    SPRING_PRESETS,
    Cycle,
    Spring,
    TangentMode,
    Track,
    TrackKey,
    require_no_overlap,
    require_repeatable_cycle,
)
from app.errors import LissomError
from app.solving.script.fields import (
    check_frame_order,
    check_handle_name,
    read_easing_and_tangent,
    read_fields,
    read_frame,
)
from app.storage import (
    JsonObject,
    as_list,
    as_number,
    as_point,
    as_text,
    as_whole,
    located,
    repr_for_error,
)
from app.texts import N_, _

TRACK_FIELDS = ("handle", "handles", "with", "keys", "delay", "reach")
TRACK_KEY_FIELDS = ("frame", "offset", "at", "velocity", "turn", "ease", "passing")
SPRING_NUMBERS = ("frequency", "damping", "lag", "strength", "stretch")
SPRING_FIELDS = ("handle", "preset", "root", *SPRING_NUMBERS)
CYCLE_FIELDS = ("from", "to", "until")
# Field of a track key's position, by the space of the track.
PLACES = {"pose": "offset", "picture": "at"}
NEEDLESS_VELOCITY = N_(
    '{where} has a velocity, which needs "passing": "through"; add that, or leave out the velocity'
)
NO_PRESET = N_("{where} needs a preset, one of {presets}, or a frequency and a damping")
HANDLE_OR_HANDLES = N_('{where} must have either "handle", or "handles" that move together')
NO_BASIS = N_("{where}.with must be pose or picture, not {content}")


def parse_tracks(content: object, where: str, handles: Sequence[str]) -> tuple[Track, ...]:
    """Return the tracks of a layer; they refer to handles by index into the names."""
    numbers = {name: number for number, name in enumerate(handles)}
    tracks = tuple(
        _track(each, f"{where}[{index}]", numbers)
        for index, each in enumerate(as_list(content, where))
    )
    _require_one_each([track.handles for track in tracks], where, handles)
    return tracks


def parse_springs(content: object, where: str, handles: Sequence[str]) -> tuple[Spring, ...]:
    """Return the springs of a layer; they refer to handles by index into the names."""
    numbers = {name: number for number, name in enumerate(handles)}
    springs = tuple(
        _spring(each, f"{where}[{index}]", numbers)
        for index, each in enumerate(as_list(content, where))
    )
    _require_one_each([(spring.handle,) for spring in springs], where, handles)
    return springs


def parse_cycles(content: object, where: str, keys: Sequence[int]) -> tuple[Cycle, ...]:
    """Return the cycles of a layer with keys at these frames, in order."""
    cycles = [
        _cycle(each, f"{where}[{index}]") for index, each in enumerate(as_list(content, where))
    ]
    cycles.sort(key=lambda cycle: cycle.first)
    # A key at the end of a cycle may repeat its first key.
    seams = {cycle.last for cycle in cycles if cycle.until != cycle.last}
    try:
        require_no_overlap(cycles)
        for cycle in cycles:
            require_repeatable_cycle(cycle, [key for key in keys if key not in seams])
    except LissomError as error:
        raise LissomError(f"{where}: {error}") from error
    return tuple(cycles)


def check_loop_periods(
    tracks: Sequence[Track], springs: Sequence[Spring], period: int, where: str
) -> None:
    """Refuse tracks and springs that cannot repeat in a loop of this length."""
    for index, track in enumerate(tracks):
        if track.delay > period:
            raise LissomError(
                _(
                    "{where}tracks[{index}].delay is {delay} frames, longer than the loop of "
                    "{period}; shorten it"
                ).format(where=where, index=index, delay=track.delay, period=period)
            )
    for index, spring in enumerate(springs):
        if not spring.damping:
            raise LissomError(
                _(
                    "{where}springs[{index}].damping must be above 0 in a loop; without damping "
                    "the swing never repeats"
                ).format(where=where, index=index)
            )


def _track(content: object, where: str, handles: Mapping[str, int]) -> Track:
    track = read_fields(content, where, TRACK_FIELDS)
    if ("handle" in track) == ("handles" in track):
        raise LissomError(_(HANDLE_OR_HANDLES).format(where=where))
    goes_with = track.get("with", "pose")
    if goes_with not in list(PLACES):
        raise LissomError(_(NO_BASIS).format(where=where, content=repr_for_error(goes_with)))
    keys = as_list(track["keys"], f"{where}.keys")
    parsed = tuple(
        _track_key(key, f"{where}.keys[{index}]", PLACES[goes_with])
        for index, key in enumerate(keys)
    )
    check_frame_order([key.frame for key in parsed], f"{where}.keys")
    return located(
        where,
        Track,
        handles=_numbers(track, where, handles),
        is_scene_space=goes_with == "picture",
        keys=parsed,
        delay=as_whole(track.get("delay", 0), f"{where}.delay"),
        reach=as_number(track.get("reach", 1.0), f"{where}.reach"),
        keys_rotation=any("turn" in key for key in keys),
    )


def _cycle(content: object, where: str) -> Cycle:
    cycle = read_fields(content, where, CYCLE_FIELDS)
    first, last = (read_frame(cycle, where, name) for name in ("from", "to"))
    until = None if cycle.get("until") is None else read_frame(cycle, where, "until")
    return located(where, Cycle, first=first, last=last, until=until)


def _track_key(content: object, where: str, place: str) -> TrackKey:
    key = read_fields(content, where, TRACK_KEY_FIELDS)
    (other,) = {*PLACES.values()} - {place}
    if other in key:
        raise LissomError(
            _(
                "{where} has {other!r}, but the keys of a track with {basis!r} need {place!r}"
            ).format(
                where=where,
                other=other,
                basis="pose" if place == "offset" else "picture",
                place=place,
            )
        )
    easing, passing = read_easing_and_tangent(key, where)
    velocity = as_point(key["velocity"], f"{where}.velocity") if "velocity" in key else None
    if velocity is not None and (easing == HOLD or passing is not TangentMode.SMOOTH):
        raise LissomError(_(NEEDLESS_VELOCITY).format(where=where))
    return located(
        where,
        TrackKey,
        frame=read_frame(key, where),
        place=as_point(key[place], f"{where}.{place}"),
        turn=radians(as_number(key.get("turn", 0.0), f"{where}.turn")),
        easing=easing,
        tangent_mode=passing,
        velocity=velocity,
    )


def _spring(content: object, where: str, handles: Mapping[str, int]) -> Spring:
    spring = read_fields(content, where, SPRING_FIELDS)
    given = read_oscillator(spring, where, SPRING_NUMBERS)
    handle = _number(spring["handle"], f"{where}.handle", handles)
    root = _number(spring["root"], f"{where}.root", handles) if "root" in spring else None
    return located(where, Spring, handle=handle, root=root, **given)


def read_oscillator(
    spring: JsonObject, where: str, names: Sequence[str] = SPRING_NUMBERS[:2]
) -> dict[str, float]:
    """Return the numbers of a spring by their names, some of them those of a preset."""
    given = {name: as_number(spring[name], f"{where}.{name}") for name in names if name in spring}
    if "preset" in spring:
        preset = as_text(spring["preset"], f"{where}.preset")
        if preset not in SPRING_PRESETS:
            raise LissomError(
                _("{where}.preset must be one of {presets}, not {preset!r}").format(
                    where=where, presets=", ".join(SPRING_PRESETS), preset=preset
                )
            )
        given = dict(zip(("frequency", "damping"), SPRING_PRESETS[preset], strict=True)) | given
    elif not {"frequency", "damping"} <= given.keys():
        raise LissomError(_(NO_PRESET).format(where=where, presets=", ".join(SPRING_PRESETS)))
    return given


def _numbers(track: JsonObject, where: str, handles: Mapping[str, int]) -> tuple[int, ...]:
    if "handle" in track:
        return (_number(track["handle"], f"{where}.handle", handles),)
    names = as_list(track["handles"], f"{where}.handles")
    for index, name in enumerate(names):
        if name in names[:index]:
            raise LissomError(
                _("{where}.handles lists {name!r} twice; list it once").format(
                    where=where, name=name
                )
            )
    return tuple(
        _number(name, f"{where}.handles[{index}]", handles) for index, name in enumerate(names)
    )


def _number(name: object, where: str, handles: Mapping[str, int]) -> int:
    read = as_text(name, where)
    check_handle_name(read, handles, where)
    return handles[read]


def _require_one_each(
    groups: Sequence[tuple[int, ...]], where: str, handles: Sequence[str]
) -> None:
    """Refuse a handle in two tracks, or with two springs."""
    seen: dict[int, int] = {}
    for index, group in enumerate(groups):
        for number in group:
            if number in seen:
                raise LissomError(
                    _(
                        "{where}[{other}] and {where}[{index}] both have the handle {handle!r}; "
                        "leave one out"
                    ).format(where=where, other=seen[number], index=index, handle=handles[number])
                )
            seen[number] = index
