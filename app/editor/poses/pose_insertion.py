"""Inserting keys of pasted, flipped or library poses."""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from app.document import (
    Channel,
    Keyframe,
    Layer,
    Pose,
    channel_commands,
    key_commands,
    pose_channel,
    with_all_targets,
)
from app.editor.actions import playback
from app.editor.actions.posing.inserting import solve_nearest_pose
from app.editor.actions.posing.pose_drag import pose_at_playhead
from app.editor.actions.posing.pose_solver import finish_drag
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.jobs import JobKind
from app.solving import Rig
from engine.maps import Bounds, certify

PoseHandler = Callable[[Layer, Pose], None]


def insert_poses(
    session: Session,
    project: Project,
    frame: int,
    keys_of: Mapping[int, Sequence[Keyframe]],
    *,
    poses: Collection[int] = (),
    label: str | None = None,
    gesture: object | None = None,
) -> None:
    """Insert keys with poses: the first at a frame, others at their copied distances.

    The new keys are selected. A single key gives only its pose.

    Parameters
    ----------
    keys_of : mapping of int to sequence of Keyframe
        By layer id.
    poses : collection of int
        Layers that take only the poses of their keys.
    label : str, optional
        The undo label; by default it is a paste.
    gesture : object, optional
        Edits of one gesture are one undo step.
    """
    gesture = gesture or object()
    first = min(key.frame for keys in keys_of.values() for key in keys)
    chosen_of: dict[Channel[Any], frozenset[int]] = {}
    is_alone = sum(map(len, keys_of.values())) == 1
    for layer, keys in keys_of.items():
        is_pose = is_alone or layer in poses
        # A single pose changes all repeats; several keys cannot be inserted into repeats.
        at = project.document.layer(layer).source_of(frame) if is_pose else frame
        moved = [key.copied(key.frame + at - first) for key in keys]
        if is_pose:
            easing = session.settings.preferences.easing
            command = key_commands.insert_pose(layer, at, moved[0].pose, easing)
        else:
            command = channel_commands.insert_keys({pose_channel(layer): moved})
        project.history.do(replace(command, label=label or command.label), gesture=gesture)
        chosen_of[pose_channel(layer)] = frozenset(key.frame for key in moved)
    unkeyed = project.history.preview_pose
    if unkeyed is not None and unkeyed.frame in chosen_of.get(pose_channel(unkeyed.layer), ()):
        project.history.set_preview_pose(None, gesture=gesture)
    project.selection.select_keys(chosen_of)


def stop_and_get_frame(session: Session, project: Project) -> int:
    """Stop playback, and return the present frame."""
    playback.stop_playback(session)
    return playback.current_frame(session, project)


def fit_keys_to_layer(
    project: Project, identity: int, keys: Sequence[Keyframe], bounds: Bounds
) -> list[Keyframe]:
    """Return keys whose poses have a layer's present handles, proven for its limits.

    `keys` are of an earlier state of the layer, or of a layer with the same domain. `bounds` are
    its limits at that time.
    """
    layer = project.document.layer(identity)
    return [replace(key, pose=_fitted(project, layer, key.pose, bounds)) for key in keys]


def _fitted(project: Project, layer: Layer, pose: Pose, bounds: Bounds) -> Pose:
    if pose.targets.keys() != {handle.id for handle in layer.handles}:
        pose = with_all_targets(layer, pose)
    if layer.bounds == bounds:
        return pose
    runtime = project.runtimes.layers[layer.id]
    runtime.rig = rig = Rig.of(layer, runtime.rig)
    proven = certify(layer.map_of(pose), rig.deformer.boundary, layer.bounds)
    return replace(pose, certificate=proven)


def request_pose_at_playhead(
    session: Session, project: Project, kind: JobKind, take: PoseHandler
) -> None:
    """Pass the pose at the playhead to `take`; for an in-between the worker solves for it."""
    finish_drag(session, project)
    layer, pose = project.layer, pose_at_playhead(session, project)
    if pose is not None:
        take(layer, pose)
        return
    clip, frame = project.clip, playback.current_frame(session, project)
    solve_nearest_pose(session, project, clip, frame, partial(take, layer), kind=kind)
