"""Commands on a figure's library of poses, and on the axis at which poses are flipped."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from app.document.commands.command import figure_command, numbered
from app.document.figure import Figure
from app.document.keyframe import KeptPose, Pose, Target
from app.document.model import Document

# Of a figure and a pose of it: the pose to which that one has gone on.
Settled = Callable[[Figure, Pose], Pose]


@figure_command("Keep pose")
def keep_pose(figure: Figure, pose: Pose, name: str | None = None) -> Figure:
    """Put a pose into the library, by default under a name that no other one has."""
    taken = {kept.name for kept in figure.library}
    free = numbered("Pose", taken, len(taken) + 1)
    kept = KeptPose(name=free if name is None else name, pose=pose)
    return replace(figure, library=(*figure.library, kept))


@figure_command("Rename pose")
def rename_pose(figure: Figure, name: str, to: str) -> Figure:
    """Give a pose of the library another name."""
    renamed = figure.kept_pose(name)
    if to == name:
        return figure
    library = tuple(replace(kept, name=to) if kept is renamed else kept for kept in figure.library)
    return replace(figure, library=library)


@figure_command("Delete pose")
def delete_pose(figure: Figure, name: str) -> Figure:
    """Take a pose out of the library; keys that were made of it stay."""
    gone = figure.kept_pose(name)
    return replace(figure, library=tuple(kept for kept in figure.library if kept is not gone))


@figure_command("Move mirror axis")
def set_mirror(figure: Figure, mirror: float | None) -> Figure:
    """Set where the axis crosses the picture at which poses are flipped; None finds its middle."""
    return figure if mirror == figure.mirror else replace(figure, mirror=mirror)


def exchanged(
    document: Document, old: Pose, new: Settled, known: dict[Figure, Figure] | None = None
) -> Document:
    """Return a document in which another pose stands wherever one with the map of `old` does.

    Figures that several documents share are changed once, where `known` holds what became of them.
    """
    known = {} if known is None else known
    for figure in document.figures:
        if any(pose.phi is old.phi for pose in figure.poses):
            if figure not in known:
                poses = (
                    new(figure, pose) if pose.phi is old.phi else pose for pose in figure.poses
                )
                known[figure] = figure.with_poses(poses)
            document = document.with_figure(known[figure])
    return document


def retargeted(figure: Figure, pose: Pose) -> Pose:
    """Return a pose with a target for each handle of a figure: its own, or where it is."""
    places = figure.map_of(pose)(
        np.array([handle.position for handle in figure.handles], dtype=np.complex128)
    )
    targets = {
        handle.id: pose.targets.get(handle.id, Target(position=complex(place)))
        for handle, place in zip(figure.handles, places, strict=True)
    }
    return replace(pose, targets=targets)
