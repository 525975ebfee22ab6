"""Commands on a layer's library of poses, and on the axis at which poses are flipped."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app.document.commands.command import layer_command, with_number
from app.document.keyframe import LibraryPose, Pose, Target
from app.document.layer import Layer
from app.document.model import Document

# Of a layer and a pose of it: the pose to which that one has gone on.
PoseReplacement = Callable[[Layer, Pose], Pose]


@layer_command("Keep pose")
def save_pose(layer: Layer, pose: Pose, name: str | None = None) -> Layer:
    """Put a pose into the library, by default under a name that no other one has."""
    taken = {kept.name for kept in layer.library}
    free = with_number("Pose", taken, len(taken) + 1)
    kept = LibraryPose(name=free if name is None else name, pose=pose)
    return replace(layer, library=(*layer.library, kept))


@layer_command("Rename pose")
def rename_pose(layer: Layer, name: str, to: str) -> Layer:
    """Give a pose of the library another name."""
    renamed = layer.library_pose(name)
    if to == name:
        return layer
    library = tuple(replace(kept, name=to) if kept is renamed else kept for kept in layer.library)
    return replace(layer, library=library)


@layer_command("Delete pose")
def delete_pose(layer: Layer, name: str) -> Layer:
    """Take a pose out of the library; keys that were made of it stay."""
    gone = layer.library_pose(name)
    return replace(layer, library=tuple(kept for kept in layer.library if kept is not gone))


@layer_command("Move mirror axis")
def set_mirror(layer: Layer, mirror: float | None) -> Layer:
    """Set where the axis crosses the picture at which poses are flipped; None finds its middle."""
    return layer if mirror == layer.mirror else replace(layer, mirror=mirror)


def with_replaced_pose(
    document: Document, old: Pose, new: PoseReplacement, known: dict[Layer, Layer] | None = None
) -> Document:
    """Return a document in which another pose stands wherever one with the map of `old` does.

    Layers that several documents share are changed once, where `known` holds what became of them.
    """
    known = {} if known is None else known
    for layer in document.layers:
        if any(pose.phi is old.phi for pose in layer.poses):
            if layer not in known:
                poses = (new(layer, pose) if pose.phi is old.phi else pose for pose in layer.poses)
                known[layer] = layer.with_poses(poses)
            document = document.with_layer(known[layer])
    return document


def with_all_targets(layer: Layer, pose: Pose) -> Pose:
    """Return a pose with a target for each handle of a layer: its own, or where it is."""
    places = layer.map_of(pose)(
        np.array([handle.position for handle in layer.handles], dtype=np.complex128)
    )
    targets = {
        handle.id: pose.targets.get(handle.id, Target(position=complex(place)))
        for handle, place in zip(layer.handles, places, strict=True)
    }
    return replace(pose, targets=targets)
