"""Commands on a layer's solver and in-betweens, and on the domain under its keys."""

from collections.abc import Sequence
from dataclasses import replace

from app.document.commands.command import layer_command
from app.document.keyframe import Pose
from app.document.layer import Layer
from app.document.rig import transfer_painted_stiffness
from app.document.settings import Meshing
from engine.domain import CutLine, CutOut, MeshedDomain, Stroke
from engine.maps import Bounds
from engine.variant import Variant


@layer_command("Set interpolation")
def set_variant(layer: Layer, variant: Variant) -> Layer:
    """Set how the in-betweens are made."""
    return layer if variant == layer.variant else replace(layer, variant=variant)


@layer_command("Set anchor")
def set_anchor(layer: Layer, anchor: complex | None) -> Layer:
    """Set the point whose place and turn are blended directly; None lets the engine choose."""
    return layer if anchor == layer.anchor else replace(layer, anchor=anchor)


@layer_command("Set stillness")
def set_auto_pins(layer: Layer, *, stillness: bool) -> Layer:
    """Let handles that two keys have at one place stay there in between, or move as they like."""
    return layer if stillness == layer.has_auto_pins else replace(layer, has_auto_pins=stillness)


@layer_command("Set bounds")
def set_limits(layer: Layer, bounds: Bounds, poses: Sequence[Pose] | None = None) -> Layer:
    """Set the distortion that is allowed.

    Parameters
    ----------
    poses : sequence of Pose, optional
        One for each of the layer's, solved within the new bounds; without them all poses stay as
        they are.
    """
    if poses is not None:
        return layer.with_poses(poses, bounds=bounds)
    return layer if bounds == layer.bounds else replace(layer, bounds=bounds)


@layer_command("Brush")
def cut_with_brush(layer: Layer, stroke: Stroke) -> Layer:
    """Keep or remove a part of the picture; the domain stays until it is replaced."""
    strokes = (*layer.cut_out.strokes, stroke)
    return replace(layer, cut_out=replace(layer.cut_out, strokes=strokes), is_stale=True)


@layer_command("Cut by the knife")
def cut_with_line(layer: Layer, slit: CutLine) -> Layer:
    """Part what touches along a line; the domain stays until it is replaced."""
    slits = (*layer.cut_out.cut_lines, slit)
    return replace(layer, cut_out=replace(layer.cut_out, cut_lines=slits), is_stale=True)


@layer_command("Change cut-out")
def set_cut_out(layer: Layer, cut_out: CutOut) -> Layer:
    """Set what tells the subject from its picture; the domain stays until it is replaced."""
    if cut_out == layer.cut_out:
        return layer
    return replace(layer, cut_out=cut_out, is_stale=True)


@layer_command("Rebuild domain")
def replace_domain(
    layer: Layer, domain: MeshedDomain, meshing: Meshing, poses: Sequence[Pose]
) -> Layer:
    """Put another domain under the same handles and keys.

    Parameters
    ----------
    domain : MeshedDomain
        That of the layer's cut-out; it must contain every handle and the anchor.
    meshing : Meshing
        What it was built with.
    poses : sequence of Pose
        One for each of the layer's, solved again over the new cage.
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
