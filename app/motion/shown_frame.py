"""What is on the screen: which pose of the document, on which mesh."""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.document import Document, Pose, resting_pose, time_of
from app.motion.prepared import Figure, Motion, Places
from app.motion.vertices import Placed, Streamed, Vertices
from engine.arrays import Complexes


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Shown:
    """A frame as it is drawn, and what it was made from.

    Parameters
    ----------
    document : Document
    frame : int
    pose : Pose, optional
        The pose that is shown; None for an in-between.
    figure : Figure
    vertices : Vertices
        The figure's.
    handles : Places
        Of the document's handles in the figure.
    is_current : bool
        Whether it shows what it should, and not an earlier state or a rough one while that is being
        prepared.
    """

    document: Document
    frame: int
    pose: Pose | None
    figure: Figure
    vertices: Vertices
    handles: Places
    is_current: bool

    @property
    def positions(self) -> Complexes:
        """Where the figure's vertices are, (v,)."""
        return self.vertices.positions

    @property
    def derivatives(self) -> tuple[Complexes, Complexes]:
        """f_z and f_z̄ at the vertices, each (v,)."""
        streamed = self.vertices.derivatives if isinstance(self.vertices, Streamed) else None
        return self.figure.derivatives(self.positions) if streamed is None else streamed

    @property
    def handle_places(self) -> Complexes:
        """Where the handles are, (h,)."""
        return self.handles.on(self.positions)

    @property
    def lags(self) -> Mapping[int, float]:
        """By how many pixels handles, by their ids, fall short of what the pose wants of them."""
        targets = {} if self.pose is None else self.pose.targets
        return {
            handle.id: abs(targets[handle.id].position - complex(place))
            for handle, place in zip(self.document.handles, self.handle_places, strict=True)
            if handle.id in targets
        }

    @property
    def handle_turns(self) -> list[float]:
        """By how much the shape turns at the handles, in radians."""
        turns = self.handles.turns(self.figure.domain.mesh.vertices, self.positions)
        return [float(turn) for turn in turns]


def show(
    document: Document,
    frame: int,
    pose: Pose | None,
    motions: tuple[Motion, ...],
    earlier: Shown | None,
) -> Shown:
    """Return what to draw; the earlier one itself if nothing changed.

    Parameters
    ----------
    document : Document
    frame : int
    pose : Pose, optional
        Shown instead of what the document has at the frame.
    motions : tuple of Motion
        Where to look for it, the preferred one first; at least one.
    earlier : Shown, optional
        What was drawn before; it stays while nothing better is prepared.
    """
    if pose is None:
        pose = resting_pose(document, time_of(document, frame))
    for motion in motions:
        if motion.figure.source is not document.domain:
            continue
        figure = motion.figure
        if earlier is not None and _is_same(earlier, document, frame, pose, figure):
            return earlier if earlier.frame == frame else replace(earlier, frame=frame)
        if pose is not None:
            vertices: Vertices | None = Placed(positions=figure.posed(pose))
        else:
            vertices = motion.vertices(document, frame)
        if vertices is not None:
            handles = _locate(document, figure, earlier)
            return Shown(
                document=document,
                frame=frame,
                pose=pose,
                figure=figure,
                vertices=vertices,
                handles=handles,
                is_current=pose is not None or not motion.is_rough(document, frame),
            )
    if earlier is None:
        raise ValueError("none of the motions is of the document's domain")
    if earlier.figure.source is not document.domain:
        return replace(earlier, is_current=False)
    return replace(
        earlier,
        document=document,
        handles=_locate(document, earlier.figure, earlier),
        is_current=False,
    )


def _is_same(
    earlier: Shown, document: Document, frame: int, pose: Pose | None, figure: Figure
) -> bool:
    return (
        earlier.is_current
        and earlier.document is document
        and earlier.figure is figure
        and earlier.pose is pose
        and (earlier.frame == frame or pose is not None)
    )


def _locate(document: Document, figure: Figure, earlier: Shown | None) -> Places:
    if (
        earlier is not None
        and earlier.figure is figure
        and earlier.document.handles == document.handles
    ):
        return earlier.handles
    places = np.array([handle.position for handle in document.handles], dtype=np.complex128)
    return figure.locate(places, figure.domain.mesh.vertices)
