"""Commands on a layer's pose library, and on the mirror axis of poses."""

from dataclasses import replace

import numpy as np

from app.document.commands.command import layer_command, with_number
from app.document.keyframe import LibraryPose, Pose, Target
from app.document.layer import Layer
from app.errors import LissomError
from app.texts import N_, _

IN_USE = N_(
    "The slider {slider!r} uses the pose {pose!r}. Delete the slider, or give it another pose."
)


@layer_command(_("Save pose"))
def save_pose(layer: Layer, pose: Pose, name: str | None = None) -> Layer:
    """Add a pose to the library, by default under a free name."""
    taken = {kept.name for kept in layer.library}
    free = with_number("Pose", taken, len(taken) + 1)
    kept = LibraryPose(name=free if name is None else name, pose=pose)
    return replace(layer, library=(*layer.library, kept))


@layer_command(_("Rename pose"))
def rename_pose(layer: Layer, name: str, to: str) -> Layer:
    renamed = layer.library_pose(name)
    if to == name:
        return layer
    library = tuple(replace(kept, name=to) if kept is renamed else kept for kept in layer.library)
    sliders = tuple(
        replace(
            slider,
            poses=tuple(
                replace(each, pose=to) if each.pose == name else each for each in slider.poses
            ),
        )
        for slider in layer.sliders
    )
    return replace(layer, library=library, sliders=sliders)


@layer_command(_("Delete pose"))
def delete_pose(layer: Layer, name: str) -> Layer:
    """Delete a pose from the library; keys made from it stay."""
    gone = layer.library_pose(name)
    for slider in layer.sliders:
        if name in {each.pose for each in slider.poses}:
            raise LissomError(_(IN_USE).format(pose=name, slider=slider.name))
    return replace(layer, library=tuple(kept for kept in layer.library if kept is not gone))


@layer_command(_("Move mirror axis"))
def set_mirror(layer: Layer, mirror: float | None) -> Layer:
    """Set the vertical mirror axis of poses; None takes the default axis."""
    return layer if mirror == layer.mirror else replace(layer, mirror=mirror)


def with_all_targets(layer: Layer, pose: Pose) -> Pose:
    """Return a pose with a target for each handle of the layer: its own, or the handle's image."""
    places = layer.map_of(pose)(
        np.array([handle.position for handle in layer.handles], dtype=np.complex128)
    )
    targets = {
        handle.id: pose.targets.get(handle.id, Target(position=complex(place)))
        for handle, place in zip(layer.handles, places, strict=True)
    }
    return replace(pose, targets=targets)
