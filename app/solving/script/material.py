"""Stiffness and bones in a pose script."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

from app.document import Bone
from app.errors import LissomError
from app.solving.script.fields import check_handle_name, read_fields
from app.storage import as_list, as_number, as_object, as_point, as_text
from app.texts import _
from engine.maps import SOFTEST, STIFFEST

REGION_FIELDS = ("around", "radius", "amount")
BONE_FIELDS = ("from", "to", "amount")
ROUNDED = 0.001  # tolerance: 1/30 may be written as .0333


@dataclass(frozen=True, slots=True, kw_only=True)
class StiffRegion:
    """Stiffness painted within a radius around a point of the canvas, in pixels."""

    around: complex
    radius: float
    amount: float


def parse_material(
    content: object, where: str, handles: Sequence[str]
) -> tuple[tuple[StiffRegion, ...], tuple[Bone, ...]]:
    """Return the regions and the bones; bones refer to handles by index into `handles`."""
    parts, bones = [], []
    for index, entry in enumerate(as_list(content, where)):
        here = f"{where}[{index}]"
        if "around" in as_object(entry, here):
            parts.append(_part(entry, here))
        else:
            bones.append(_bone(entry, here, handles))
    if len({bone.ends[1] for bone in bones}) < len(bones):
        # Written before bones had a direction: two of them end at one handle.
        bones = [replace(bone, is_directed=False) for bone in bones]
    return tuple(parts), tuple(bones)


def parse_bones(content: object, where: str, handles: Sequence[str]) -> tuple[Bone, ...]:
    """Return the bones of chains, each a list of handles from root to end."""
    bones: dict[frozenset[int], Bone] = {}
    for index, entry in enumerate(as_list(content, where)):
        here = f"{where}[{index}]"
        listed = enumerate(as_list(entry, here))
        names = [as_text(name, f"{here}[{number}]") for number, name in listed]
        if len(names) < 2:
            raise LissomError(
                _(
                    "{where} must list at least two handles from root to end, as in "
                    '["shoulder", "elbow", "hand"]'
                ).format(where=here)
            )
        for name in names:
            check_handle_name(name, handles, here)
        twice = [name for number, name in enumerate(names) if name in names[: max(number - 1, 0)]]
        if twice:
            raise LissomError(
                _("{where} names {name!r} twice; bones cannot form a circle").format(
                    where=here, name=twice[0]
                )
            )
        ends = [list(handles).index(name) for name in names]
        for number, (first, second) in enumerate(pairwise(ends)):
            _check_ends(here, names[number], names[number + 1])
            bone = Bone(ends=(first, second))
            if bones.setdefault(frozenset(bone.ends), bone) is not bone:
                raise LissomError(
                    _(
                        "{where} has the bone from {first!r} to {second!r}, which another chain "
                        "has too; start the chain at {second!r}"
                    ).format(where=here, first=names[number], second=names[number + 1])
                )
    return tuple(bones.values())


def _check_ends(where: str, first: str, second: str) -> None:
    if first == second:
        raise LissomError(
            _("{where} connects {name!r} to itself; name two different handles").format(
                where=where, name=first
            )
        )


def _part(content: object, where: str) -> StiffRegion:
    part = read_fields(content, where, REGION_FIELDS)
    radius = as_number(part["radius"], f"{where}.radius")
    if not radius > 0:
        raise LissomError(
            _("{where}.radius must be above 0, not {radius:g}").format(where=where, radius=radius)
        )
    around = as_point(part["around"], f"{where}.around")
    return StiffRegion(around=around, radius=radius, amount=_amount(part["amount"], where))


def _bone(content: object, where: str, handles: Sequence[str]) -> Bone:
    bone = read_fields(content, where, BONE_FIELDS)
    names = [as_text(bone[end], f"{where}.{end}") for end in ("from", "to")]
    for name in names:
        check_handle_name(name, handles, where)
    _check_ends(where, names[0], names[1])
    first, second = map(list(handles).index, names)
    return Bone(ends=(first, second), stiffness=_amount(bone["amount"], where))


def _amount(content: object, where: str) -> float:
    amount = as_number(content, f"{where}.amount")
    if not SOFTEST * (1 - ROUNDED) <= amount <= STIFFEST:
        raise LissomError(
            _("{where}.amount must be from 1/30 to {largest:g}, not {amount:g}").format(
                where=where, largest=STIFFEST, amount=amount
            )
        )
    return max(amount, SOFTEST)
