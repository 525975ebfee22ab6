"""Commands on what a figure is made of. None of them changes a pose: later ones are solved so."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.document.body import (
    PAIRS,
    USUAL_STRENGTH,
    Bone,
    SidePairs,
    pairs_by_name,
    require_amount,
    usual_as_none,
)
from app.document.checks import require
from app.document.commands.command import figure_command
from app.document.figure import Figure
from app.document.queries import brushed_stiffness, limb_of
from app.errors import LissomError
from engine.arrays import Floats
from engine.domain.material import carried_stiffness
from engine.errors import EngineError


@figure_command("Paint stiffness")
def paint(
    figure: Figure,
    places: Sequence[complex],
    *,
    radius: float,
    amount: float,
    softness: float = 0.5,
) -> Figure:
    """Paint along a stroke, as `brushed_stiffness` has it."""
    require_amount(amount)
    require(radius > 0, f"The radius of a brush is above 0, not {radius:g}.")
    require(0 <= softness <= 1, f"A brush is soft from 0 to 1, not {softness:g}.")
    stiffness, reached = brushed_stiffness(
        figure, places, radius=radius, amount=amount, softness=softness
    )
    return replace(figure, stiffness=stiffness) if reached else figure


@figure_command("Clear stiffness")
def clear(figure: Figure) -> Figure:
    """Take back all that is painted; bones stay."""
    return figure if figure.stiffness is None else replace(figure, stiffness=None)


@figure_command("Add bone")
def add_bone(figure: Figure, ends: tuple[int, int], amount: float = USUAL_STRENGTH) -> Figure:
    """Add a bone between two handles, which must not leave the drawing on its way."""
    bone = Bone(ends=ends, amount=amount)
    names = [figure.handle(identity).name for identity in ends]
    if any(other.is_between(ends) for other in figure.bones):
        raise LissomError(f"There is a bone from {names[0]!r} to {names[1]!r} already.")
    limb_of(figure, bone, figure.domain.outline)
    return replace(figure, bones=(*figure.bones, bone))


@figure_command("Delete bone")
def remove_bone(figure: Figure, ends: tuple[int, int]) -> Figure:
    """Remove the bone between two handles."""
    gone = _bone(figure, ends)
    return replace(figure, bones=tuple(bone for bone in figure.bones if bone is not gone))


@figure_command("Set bone strength")
def set_bone_amount(figure: Figure, ends: tuple[int, int], amount: float) -> Figure:
    """Set how stiff the bone between two handles is."""
    old = _bone(figure, ends)
    if old.amount == amount:
        return figure
    bones = (replace(bone, amount=amount) if bone is old else bone for bone in figure.bones)
    return replace(figure, bones=tuple(bones))


@figure_command("Show or hide bones")
def show_bones(figure: Figure, *, shown: bool) -> Figure:
    """Show all bones of a figure or none; they act either way."""
    bones = tuple(replace(bone, is_shown=shown) for bone in figure.bones)
    return figure if bones == figure.bones else replace(figure, bones=bones)


@figure_command("Mirror material")
def mirror(figure: Figure, pairs: SidePairs = PAIRS) -> Figure:
    """Give both sides of a figure what one of them has.

    Where the drawing at the mirror image of a place differs more from the usual material, it is
    taken over. Bones are mirrored to the partners of their handles, by name.
    """
    stiffness, domain = figure.stiffness, figure.domain
    if stiffness is not None:
        opposite = 2 * figure.axis - np.concatenate(domain.loops).conj()
        there = carried_stiffness(domain.loops, stiffness, opposite)
        farther = np.abs(np.log(there)) > np.abs(np.log(stiffness))
        stiffness = usual_as_none(np.where(farther, there, stiffness))
    partners, bones = pairs_by_name(figure.handles, pairs), list(figure.bones)
    for bone in figure.bones:
        first, second = (partners.get(end, end) for end in bone.ends)
        mirrored = replace(bone, ends=(first, second))
        if not any(other.is_between(mirrored.ends) for other in bones) and _fits(figure, mirrored):
            bones.append(mirrored)
    if tuple(bones) == figure.bones and _same(stiffness, figure.stiffness):
        return figure
    return replace(figure, stiffness=stiffness, bones=tuple(bones))


def _fits(figure: Figure, bone: Bone) -> bool:
    try:
        limb_of(figure, bone, figure.domain.outline)
    except EngineError:
        return False
    return True


def _same(one: Floats | None, other: Floats | None) -> bool:
    return one is other or (one is not None and other is not None and np.allclose(one, other))


def _bone(figure: Figure, ends: tuple[int, int]) -> Bone:
    for bone in figure.bones:
        if bone.is_between(ends):
            return bone
    names = [figure.handle(identity).name for identity in ends]
    raise LissomError(f"There is no bone from {names[0]!r} to {names[1]!r}.")
