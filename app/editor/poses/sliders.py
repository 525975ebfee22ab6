"""Pose sliders of the active layer: new ones from poses, and poses set where a slider stands."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from math import isqrt

from app.document import (
    Keyframe,
    Pose,
    Slider,
    SliderPose,
    clip_of,
    key_commands,
    pose_commands,
    rest_pose,
    slider_commands,
    slider_value_at,
    with_number,
)
from app.editor import pending_changes
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_drag import pose_at_playhead
from app.editor.actions.posing.pose_solver import finish_drag
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.solving import Rig, fit_shown_pose
from app.texts import _

SETTING = JobKind(_("Setting a slider pose"), _("The slider pose could not be set"), "hand")
SNAP = 0.02  # of a slider's range: a pose so near is changed, instead of a new one


@with_project
def add_slider(
    session: Session, project: Project, poses: Sequence[str | None], *, is_pad: bool = False
) -> None:
    """Add a slider of poses of the library in this order; None is the undeformed drawing.

    Two poses are at 0 and 1; three are at −1, 0 and 1. A pad has rows of equal length.
    """
    name = with_number(_("Slider"), {each.name for each in project.layer.sliders}, 1)
    row = isqrt(len(poses)) if is_pad else len(poses)
    first = -1 if row == 3 else 0
    step = 1 if row < 4 else 1 / (row - 1)
    places = (
        complex(first + step * (i % row), first + step * (i // row) if is_pad else 0)
        for i in range(len(poses))
    )
    slider = Slider(
        name=name,
        poses=tuple(SliderPose(at=at, pose=each) for at, each in zip(places, poses, strict=True)),
    )
    editing.edit_layer(session, slider_commands.add_slider, slider)


@with_project
def toggle_slider_pose(_: Session, project: Project, name: str | None) -> None:
    """Choose a pose for a new slider, or choose it no more."""
    project.pose_edits.toggle_slider_pose(name)


@with_project
def toggle_wide_slider(_: Session, project: Project, name: str) -> None:
    """Let a slider of the active layer go beyond its poses, or no more."""
    project.pose_edits.toggle_wide_slider(project.selection.active, name)


@with_project
def begin_slider(session: Session, project: Project) -> None:
    """Add a slider from the undeformed drawing to the shown pose."""
    _take_pose(session, project, None, partial(_begin, session, project))


def _begin(session: Session, project: Project, pose: Pose) -> None:
    editing.edit_layer(session, pose_commands.save_pose, pose)
    add_slider(session, [None, project.layer.library[-1].name])
    _rest(session, project)


@with_project
def set_slider_pose(session: Session, project: Project, name: str) -> None:
    """Take the shown shape as the slider's pose where it stands.

    A layer with a single key goes back to the undeformed drawing, so that the slider alone shows
    the shape. In other layers the keys stay.
    """
    _take_pose(session, project, name, partial(_set, session, project, name))


def _set(session: Session, project: Project, name: str, pose: Pose) -> None:
    clip, frame = project.clip, playback.current_frame(session, project)
    channel = next(each for each in clip.sliders if each.slider.name == name)
    at, slider = slider_value_at(clip, channel, frame), channel.slider
    near = min((each.at for each in slider.poses), key=lambda other: abs(other - at))
    (xs, ys) = slider.axes
    if slider.is_pad or abs(near - at) < SNAP * max(xs[-1] - xs[0], ys[-1] - ys[0]):
        at = near
    editing.edit_layer(session, slider_commands.set_slider_pose, name, at, pose)
    _rest(session, project)


def _rest(session: Session, project: Project) -> None:
    """Put the single key of a layer back to the undeformed drawing."""
    layer = project.layer
    if len(layer.keys) > 1:
        session.notices.show(_("The keys stay: delete those that show the pose themselves."))
        return
    (key,) = layer.keys
    rest = rest_pose(layer.domain, layer.handles)
    editing.edit_layer(session, key_commands.insert_pose, key.frame, rest, key.easing)


def _take_pose(
    session: Session, project: Project, name: str | None, take: Callable[[Pose], None]
) -> None:
    """Pass the shown shape to `take`, of all sliders only with the named one."""
    playback.stop_playback(session)
    finish_drag(session, project)
    pose, frame = pose_at_playhead(session, project), playback.current_frame(session, project)
    layer = project.layer
    if pose is not None:
        keys = (Keyframe(frame=frame, pose=pose),)
        layer = replace(layer, keys=keys, cycles=(), tracks=(), springs=())
    clip = clip_of(project.document.with_layer(layer), layer.id)
    shown = tuple(each for each in clip.sliders if each.slider.name == name)
    runtime = project.runtimes.layers[layer.id]
    work = partial(
        fit_shown_pose,
        Rig.of(layer, runtime.rig),
        replace(clip, sliders=shown),
        frame,
        runtime.store.sampler,
        with_sliders=True,
    )
    if project.unkeyed_pose is not None:
        project.history.set_preview_pose(None)
    pending_changes.begin_pending_change(session, project, SETTING, work, take)
