"""Copying poses and keys, of one layer or of several."""

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from typing import Any

from app.document import (
    IK_TARGET,
    POSE,
    TRANSFORM,
    BaseKey,
    Channel,
    ChannelKind,
    Clip,
    Document,
    Keyframe,
    Layer,
    Pose,
    clip_of,
    keyed_pose_at,
    keys_in,
    mirrored_name,
    segment_time_at,
    track_in,
    value_at,
)
from app.editor import pending_changes
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.pose_drag import pose_at_playhead
from app.editor.actions.posing.pose_solver import finish_drag
from app.editor.parts.clipboard import CopiedChannel, CopiedKeys, CopiedTrack
from app.editor.poses import pose_insertion
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.motion import PoseSampler
from app.solving import Rig, fit_shown_pose
from app.texts import _, ngettext

COPYING = JobKind(_("Copying a pose"), _("The pose could not be copied"), "hand")
KEYS_COPIED = "{count} keys copied."


def _copy_text(session: Session, project: Project) -> str:
    if is_copying_keys(session, project):
        count = project.selection.key_count
        return ngettext("Copy {count} key", "Copy {count} keys", count).format(count=count)
    count = len(project.selected_layers)
    return ngettext("Copy pose", "Copy poses of {count} layers", count).format(count=count)


@named_action(_("Copy"), "Ctrl+C", detail=_copy_text)
@with_project
def copy_pose_or_keys(session: Session, project: Project) -> None:
    """Copy the pose at the playhead or, in the timeline, the selected keys.

    With several selected layers, copy from all of them.
    """
    if is_copying_keys(session, project):
        copy_keys(session)
    elif len(project.selected_layers) > 1:
        _copy_poses(session, project, project.selected_layers)
    else:
        frame = playback.current_frame(session, project)
        pose_insertion.request_pose_at_playhead(
            session, project, COPYING, partial(_copy, session, project, frame)
        )


@named_action(
    _("Copy poses of all layers"),
    "Ctrl+Alt+C",
    why_disabled=unless(
        lambda _, project: len(project.document.layers) > 1,
        _("There is only one layer. Copy its pose."),
    ),
)
@with_project
def copy_all_poses(session: Session, project: Project) -> None:
    """Copy the poses of all layers at the playhead."""
    _copy_poses(session, project, [layer.id for layer in project.document.layers])


def _copy_poses(session: Session, project: Project, chosen: Sequence[int]) -> None:
    """Copy the poses of layers at the playhead; the worker solves for in-betweens."""
    finish_drag(session, project)
    frame, document = playback.current_frame(session, project), project.document
    layers = [
        each
        for each in document.layers
        if each.id in chosen and (each.handles or len(each.keys) > 1)
    ]
    channels = _copied_transforms(document, chosen, frame)
    known: dict[int, Pose] = {}
    works = {}
    for layer in layers:
        clip, runtime = clip_of(document, layer.id), project.runtimes.layers[layer.id]
        is_active = layer.id == project.selection.active
        pose = pose_at_playhead(session, project) if is_active else None
        pose = pose or keyed_pose_at(clip, segment_time_at(clip, frame))
        if pose is None:
            rig = partial(Rig.of, layer, runtime.rig)
            works[layer.id] = partial(_between, rig, clip, frame, runtime.store.sampler)
        else:
            known[layer.id] = pose

    def take(found: Mapping[int, Pose]) -> None:
        poses = {**known, **found}
        keys = [(each, Keyframe(frame=frame, pose=poses[each.id])) for each in layers]
        poses_of = [CopiedKeys(layer, (key,), is_pose=True) for layer, key in keys]
        session.clipboard.put(poses_of, channels=channels)
        copied = {layer.id for layer in layers} | {each.channel.layer for each in channels}
        count = len(copied)
        text = ngettext(
            "Pose of {count} layer at frame {frame} copied.",
            "Poses of {count} layers at frame {frame} copied.",
            count,
        )
        session.notices.show(text.format(count=count, frame=frame), topic="copy")

    if works:
        pending_changes.begin_pending_change(
            session, project, COPYING, lambda: {i: work() for i, work in works.items()}, take
        )
    elif layers or channels:
        take({})
    else:
        text = _("There are no poses to copy: no layer has a handle, a transform or a second key.")
        session.notices.show(text)


def _copied_transforms(
    document: Document, chosen: Collection[int], frame: int
) -> list[CopiedChannel]:
    """Return transforms and IK targets of layers at a frame, where they or partners have keys."""
    names = {layer.name: layer for layer in document.layers}
    copied = []
    for layer in document.layers:
        partner = names.get(mirrored_name(layer.name, document.pairs) or "")
        kinds: tuple[ChannelKind[Any], ...] = (TRANSFORM, IK_TARGET)
        for kind in kinds:
            has_keys = layer.keys_of(kind) or (
                kind is TRANSFORM and partner is not None and partner.keys_of(TRANSFORM)
            )
            if layer.id in chosen and has_keys:
                channel: Channel[Any] = Channel(kind, layer.id)
                key = kind.key(frame, value_at(document, channel, frame))
                copied.append(CopiedChannel(layer, channel, (key,), is_pose=True))
    return copied


def is_copying_keys(session: Session, project: Project) -> bool:
    """Return whether a copy takes keys, and not the pose at the playhead."""
    return session.display.is_timeline_focused and bool(project.selection.keys)


@with_project
def copy_keys(session: Session, project: Project) -> None:
    """Copy the selected keys."""
    finish_drag(session, project)
    document, keys, tracks, others = project.document, [], [], []
    for channel, at in project.selection.keys.items():
        layer = None if channel.layer is None else document.layer(channel.layer)
        track, row = track_in(document, channel), keys_in(document, channel)
        taken = tuple(key for key in row if key.frame in at)
        if layer is not None and track is not None:
            own = tuple(key for key in track.keys if key.frame in at)
            tracks.append(CopiedTrack(layer, track, own))
        elif layer is not None and channel.kind is POSE:
            keys.append(CopiedKeys(layer, tuple(map(layer.key, sorted(at)))))
        else:
            others.append(CopiedChannel(layer, channel, taken))
    _take(session, keys, tracks, others)


def _between(rig: Callable[[], Rig], clip: Clip, frame: int, sibling: PoseSampler | None) -> Pose:
    return fit_shown_pose(rig(), clip, frame, sibling)


def _copy(session: Session, project: Project, frame: int, layer: Layer, pose: Pose) -> None:
    channels = _copied_transforms(project.document, {layer.id}, frame)
    keys = (Keyframe(frame=frame, pose=pose),)
    # A layer without handles that only turns has no pose of its own.
    poses = [] if channels and not (layer.handles or len(layer.keys) > 1) else [(layer, keys)]
    _take(session, [CopiedKeys(*each) for each in poses], others=channels, is_pose=True)


def _take(
    session: Session,
    copied: Sequence[CopiedKeys],
    tracks: Sequence[CopiedTrack] = (),
    others: Sequence[CopiedChannel] = (),
    *,
    is_pose: bool = False,
) -> None:
    session.clipboard.put(copied, tracks, others)
    poses = [key.frame for each in copied for key in each.keys]
    rows: list[Sequence[BaseKey]] = [each.keys for each in tracks]
    rows += [each.keys for each in others]
    first, *more = poses + [key.frame for row in rows for key in row]
    if more and not is_pose:
        count = 1 + len(more)
        text = ngettext("{count} key copied.", KEYS_COPIED, count).format(count=count)
    elif poses or is_pose:
        text = _("Pose at frame {frame} copied.").format(frame=first)
    else:
        text = _("Key at frame {frame} copied.").format(frame=first)
    session.notices.show(text, topic="copy")
