"""Commands on a figure's solver and in-betweens, and on the domain under its keys."""

from collections.abc import Sequence
from dataclasses import replace

from app.document.body import carried_over
from app.document.commands.command import figure_command
from app.document.figure import Figure
from app.document.keyframe import Pose
from app.document.settings import Meshing
from engine.domain import CutOut, Domain, Slit, Stroke
from engine.maps import Bounds
from engine.variant import Variant


@figure_command("Set interpolation")
def set_variant(figure: Figure, variant: Variant) -> Figure:
    """Set how the in-betweens are made."""
    return figure if variant == figure.variant else replace(figure, variant=variant)


@figure_command("Set anchor")
def set_anchor(figure: Figure, anchor: complex | None) -> Figure:
    """Set the point whose place and turn are blended directly; None lets the engine choose."""
    return figure if anchor == figure.anchor else replace(figure, anchor=anchor)


@figure_command("Set stillness")
def set_stillness(figure: Figure, *, stillness: bool) -> Figure:
    """Let handles that two keys have at one place stay there in between, or move as they like."""
    return figure if stillness == figure.stillness else replace(figure, stillness=stillness)


@figure_command("Set bounds")
def set_bounds(figure: Figure, bounds: Bounds, poses: Sequence[Pose] | None = None) -> Figure:
    """Set the distortion that is allowed.

    Parameters
    ----------
    poses : sequence of Pose, optional
        One for each of the figure's, solved within the new bounds; without them all poses stay as
        they are.
    """
    if poses is not None:
        return figure.with_poses(poses, bounds=bounds)
    return figure if bounds == figure.bounds else replace(figure, bounds=bounds)


@figure_command("Brush")
def brush(figure: Figure, stroke: Stroke) -> Figure:
    """Keep or remove a part of the picture; the domain stays until it is replaced."""
    strokes = (*figure.cut_out.strokes, stroke)
    return replace(figure, cut_out=replace(figure.cut_out, strokes=strokes), is_stale=True)


@figure_command("Cut by the knife")
def part(figure: Figure, slit: Slit) -> Figure:
    """Part what touches along a line; the domain stays until it is replaced."""
    slits = (*figure.cut_out.slits, slit)
    return replace(figure, cut_out=replace(figure.cut_out, slits=slits), is_stale=True)


@figure_command("Change cut-out")
def set_cut_out(figure: Figure, cut_out: CutOut) -> Figure:
    """Set what tells the subject from its picture; the domain stays until it is replaced."""
    if cut_out == figure.cut_out:
        return figure
    return replace(figure, cut_out=cut_out, is_stale=True)


@figure_command("Rebuild domain")
def replace_domain(
    figure: Figure, domain: Domain, meshing: Meshing, poses: Sequence[Pose]
) -> Figure:
    """Put another domain under the same handles and keys.

    Parameters
    ----------
    domain : Domain
        That of the figure's cut-out; it must contain every handle and the anchor.
    meshing : Meshing
        What it was built with.
    poses : sequence of Pose
        One for each of the figure's, solved again over the new cage.
    """
    unknown = {name: value for name, value in figure.unknown.items() if name != "domain"}
    return figure.with_poses(
        poses,
        domain=domain,
        meshing=meshing,
        stiffness=carried_over(figure.stiffness, figure.domain, domain),
        is_stale=False,
        unknown=unknown,
    )
