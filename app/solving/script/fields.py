"""Fields that keys of several kinds share in a pose script."""

from collections.abc import Collection, Mapping, Sequence
from itertools import pairwise

from app.document import HOLD, LAST_FRAME, LINEAR, Easing, TangentMode
from app.errors import LissomError, join_names
from app.storage import JsonObject, as_object, located, repr_for_error
from app.texts import N_, _

NOT_A_FRAME = N_("{where}.{name} must be a whole number from 0 to {last}, not {content}")
NO_KEYS = N_("{where} must be a list of at least one key")
OUT_OF_ORDER = N_(
    "{where}: frame {after} comes after frame {before}; give frames in ascending order, each once"
)


def read_fields(content: object, where: str, fields: tuple[str, ...]) -> JsonObject:
    """Return an object; other fields than these are refused."""
    read = as_object(content, where)
    for name in read:
        if name not in fields:
            raise LissomError(
                _("{where} has an unknown field {name!r}; it may have {fields}").format(
                    where=where, name=name, fields=", ".join(fields)
                )
            )
    return read


def read_frame(key: Mapping[str, object], where: str, name: str = "frame") -> int:
    frame = key.get(name)
    if not isinstance(frame, int) or isinstance(frame, bool) or not 0 <= frame <= LAST_FRAME:
        raise LissomError(
            _(NOT_A_FRAME).format(
                where=where, name=name, last=LAST_FRAME, content=repr_for_error(frame)
            )
        )
    return frame


def read_easing_and_tangent(key: JsonObject, where: str) -> tuple[Easing, TangentMode]:
    """Return the easing and the tangent mode of a key.

    The default tangent mode is smooth, or a corner if the key has an easing.
    """
    ease = located(f"{where}.ease", Easing.parse, key["ease"]) if "ease" in key else LINEAR
    default = TangentMode.CORNER if "ease" in key else TangentMode.SMOOTH
    word = key.get("passing", default)
    if word not in list(TangentMode):
        raise LissomError(
            _("{where}.passing must be one of {modes}, not {content}").format(
                where=where, modes=", ".join(TangentMode), content=repr_for_error(word)
            )
        )
    if word != TangentMode.HOLD:
        return ease, TangentMode(word)
    if "ease" in key and ease != HOLD:
        raise LissomError(
            _("{where} holds its pose, so its ease has no effect; leave out ease").format(
                where=where
            )
        )
    return HOLD, default


def check_frame_order(frames: Sequence[int], where: str) -> None:
    """Refuse frames that are not in ascending order."""
    for before, after in pairwise(frames):
        if after <= before:
            raise LissomError(_(OUT_OF_ORDER).format(where=where, after=after, before=before))


def check_handle_name(name: str, handles: Collection[str], where: str) -> None:
    """Refuse a handle name that is not in the script."""
    if name not in handles:
        raise LissomError(
            _(
                "{where} names the handle {name!r}, which does not exist; the handles are {handles}"
            ).format(where=where, name=name, handles=join_names([*handles]))
        )
