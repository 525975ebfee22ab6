"""Commands on a layer's solver settings, cut-out and domain."""

from collections.abc import Sequence
from dataclasses import replace

from app.cut_out import CutLine, CutOut, Stroke
from app.document.channels.kinds import TRANSFORM
from app.document.commands.command import layer_command
from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.rig.stiffness import transfer_painted_stiffness
from app.document.settings import Meshing
from app.texts import _
from engine.domain import MeshedDomain
from engine.maps import Bounds
from engine.variant import Variant


@layer_command(_("Set interpolation"))
def set_variant(layer: Layer, variant: Variant) -> Layer:
    return layer if variant == layer.variant else replace(layer, variant=variant)


@layer_command(_("Set anchor"))
def set_anchor(layer: Layer, anchor: complex | None) -> Layer:
    """Set the point whose position and rotation are interpolated directly; None is automatic.

    The transform of a layer without a parent is about the anchor. Its keys keep their places.
    """
    if anchor == layer.anchor:
        return layer
    changed = replace(layer, anchor=anchor)
    if layer.attachments:
        return changed
    arm = changed.pivot - layer.pivot
    moved = (
        replace(key, value=replace(key.value, shift=key.value.shift + (key.value.factor - 1) * arm))
        for key in layer.keys_of(TRANSFORM)
    )
    return changed.with_keys_of(TRANSFORM, moved)


@layer_command(_("Set auto-pins"))
def set_auto_pins(layer: Layer, *, enabled: bool) -> Layer:
    """Turn auto-pin of a layer on or off."""
    return layer if enabled == layer.has_auto_pins else replace(layer, has_auto_pins=enabled)


@layer_command(_("Set limits"))
def set_limits(layer: Layer, bounds: Bounds, poses: Sequence[Pose] | None = None) -> Layer:
    """Set the limits of distortion; `poses` are all poses solved within them, if they change."""
    if poses is not None:
        return layer.with_poses(poses, bounds=bounds)
    return layer if bounds == layer.bounds else replace(layer, bounds=bounds)


@layer_command(_("Brush"))
def cut_with_brush(layer: Layer, stroke: Stroke) -> Layer:
    """Keep or remove a part of the picture; the domain stays stale until it is rebuilt."""
    strokes = (*layer.cut_out.strokes, stroke)
    return replace(layer, cut_out=replace(layer.cut_out, strokes=strokes), is_stale=True)


@layer_command(_("Cut with knife"))
def cut_with_line(layer: Layer, slit: CutLine) -> Layer:
    """Separate touching parts along a line; the domain stays stale until it is rebuilt."""
    slits = (*layer.cut_out.cut_lines, slit)
    return replace(layer, cut_out=replace(layer.cut_out, cut_lines=slits), is_stale=True)


@layer_command(_("Change cut-out"))
def set_cut_out(layer: Layer, cut_out: CutOut) -> Layer:
    """Set the cut-out of the subject; the domain stays stale until it is rebuilt."""
    if cut_out == layer.cut_out:
        return layer
    return replace(layer, cut_out=cut_out, is_stale=True)


@layer_command(_("Rebuild domain"))
def replace_domain(
    layer: Layer, domain: MeshedDomain, meshing: Meshing, poses: Sequence[Pose]
) -> Layer:
    """Replace the domain under the same handles and keys.

    The domain is built from the layer's cut-out and contains every handle and the anchor. All poses
    are solved over its cage.
    """
    unknown = {name: value for name, value in layer.unknown.items() if name != "domain"}
    return layer.with_poses(
        poses,
        domain=domain,
        meshing=meshing,
        stiffness=transfer_painted_stiffness(layer.stiffness, layer.domain, domain),
        is_stale=False,
        unknown=unknown,
    )
