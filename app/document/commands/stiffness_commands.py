"""Commands on a layer's stiffness. They change no pose; later solves use the new stiffness."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from app.document.checks import require
from app.document.commands.command import layer_command
from app.document.layer import Layer
from app.document.queries.material.boundary_stiffness import bone_region, brushed_stiffness
from app.document.rig.chains import DEFAULT_BONE_STIFFNESS, Bone
from app.document.rig.mirror_names import PAIRS, SidePairs, mirrored_handles_by_name
from app.document.rig.stiffness import default_as_none, require_stiffness_amount
from app.errors import LissomError
from app.texts import N_, _
from engine.arrays import Floats
from engine.domain.material.transfer import copy_nearest_stiffness
from engine.errors import EngineError


@layer_command(_("Paint stiffness"))
def paint_stiffness(
    layer: Layer,
    places: Sequence[complex],
    *,
    radius: float,
    amount: float,
    softness: float = 0.5,
) -> Layer:
    """Paint stiffness along a stroke by `brushed_stiffness`."""
    require_stiffness_amount(amount)
    require(radius > 0, N_("The radius of a brush must be above 0, not {radius:g}."), radius=radius)
    require(
        0 <= softness <= 1,
        N_("The softness of a brush must be from 0 to 1, not {softness:g}."),
        softness=softness,
    )
    stiffness, reached = brushed_stiffness(
        layer, places, radius=radius, amount=amount, softness=softness
    )
    return replace(layer, stiffness=stiffness) if reached else layer


@layer_command(_("Clear stiffness"))
def clear_stiffness(layer: Layer) -> Layer:
    """Delete all painted stiffness; bones stay."""
    return layer if layer.stiffness is None else replace(layer, stiffness=None)


@layer_command(_("Add bone"))
def add_bone(layer: Layer, ends: tuple[int, int], amount: float = DEFAULT_BONE_STIFFNESS) -> Layer:
    """Add a bone from a root to an end; the straight bone must stay inside the drawing."""
    return with_bone(layer, Bone(ends=ends, stiffness=amount))


def with_bone(layer: Layer, bone: Bone) -> Layer:
    """Return the layer with a further bone, or raise `LissomError` or `EngineError`."""
    if any(other.is_between(bone.ends) for other in layer.bones):
        first, second = (layer.handle(identity).name for identity in bone.ends)
        raise LissomError(
            _("A bone from {first!r} to {second!r} already exists.").format(
                first=first, second=second
            )
        )
    bone_region(layer, bone, layer.domain.outline)
    return replace(layer, bones=(*layer.bones, bone))


@layer_command(_("Delete bone"))
def remove_bone(layer: Layer, ends: tuple[int, int]) -> Layer:
    gone = _bone(layer, ends)
    return replace(layer, bones=tuple(bone for bone in layer.bones if bone is not gone))


@layer_command(_("Set bone strength"))
def set_bone_stiffness(layer: Layer, ends: tuple[int, int], amount: float) -> Layer:
    old = _bone(layer, ends)
    if old.stiffness == amount:
        return layer
    bones = (replace(bone, stiffness=amount) if bone is old else bone for bone in layer.bones)
    return replace(layer, bones=tuple(bones))


@layer_command(_("Show or hide bones"))
def set_bones_visible(layer: Layer, *, shown: bool) -> Layer:
    """Show or hide all bones of a layer; hidden bones act too."""
    bones = tuple(replace(bone, is_shown=shown) for bone in layer.bones)
    return layer if bones == layer.bones else replace(layer, bones=bones)


@layer_command(_("Mirror material"))
def mirror_stiffness(layer: Layer, pairs: SidePairs = PAIRS) -> Layer:
    """Make the stiffness of a layer symmetric.

    At each point, the value farther from 1 of the point and its mirror image wins. Bones are copied
    to the partners of their handles by name.
    """
    stiffness, domain = layer.stiffness, layer.domain
    if stiffness is not None:
        opposite = 2 * layer.axis - np.concatenate(domain.loops).conj()
        there = copy_nearest_stiffness(domain.loops, stiffness, opposite)
        farther = np.abs(np.log(there)) > np.abs(np.log(stiffness))
        stiffness = default_as_none(np.where(farther, there, stiffness))
    partners, bones = mirrored_handles_by_name(layer.handles, pairs), list(layer.bones)
    for bone in layer.bones:
        first, second = (partners.get(end, end) for end in bone.ends)
        mirrored = replace(bone, ends=(first, second))
        if not any(other.is_between(mirrored.ends) for other in bones) and _fits(
            replace(layer, bones=tuple(bones)), mirrored
        ):
            bones.append(mirrored)
    if tuple(bones) == layer.bones and _same(stiffness, layer.stiffness):
        return layer
    return replace(layer, stiffness=stiffness, bones=tuple(bones))


def _fits(layer: Layer, bone: Bone) -> bool:
    try:
        with_bone(layer, bone)
    except (EngineError, LissomError):
        return False
    return True


def _same(one: Floats | None, other: Floats | None) -> bool:
    return one is other or (one is not None and other is not None and np.allclose(one, other))


def _bone(layer: Layer, ends: tuple[int, int]) -> Bone:
    for bone in layer.bones:
        if bone.is_between(ends):
            return bone
    names = [layer.handle(identity).name for identity in ends]
    raise LissomError(
        _("There is no bone from {first!r} to {second!r}.").format(first=names[0], second=names[1])
    )
