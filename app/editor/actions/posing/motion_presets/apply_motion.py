"""Applying a motion preset: the worker solves key after key, and the layer gets one undo step."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

from app.document import (
    Command,
    Document,
    Layer,
    clip_of,
    find_motion_edits,
    without_motion_springs,
)
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.posing.motion_presets.new_setup import setup_of_applied_motion
from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.motion_setup import MotionJob, MotionSetup
from app.editor.work.pending_change import PendingChange
from app.motion import DeformMesh, InbetweenCache
from app.solving import PARTED, MotionRequest, MotionSolve, start_motion_solve, step_motion_solve
from app.texts import _, ngettext
from engine.arrays import Bytes

GIVING = JobKind(_("Applying the motion"), _("The motion was not applied"), "hand")
MOST_NAMED = 3  # most unreached joints that a notice names


@with_project
def apply_motion_preset(session: Session, project: Project) -> None:
    """Apply the drafted motion to the layer, as soon as no change is pending."""
    draft = session.tools.motion_setup
    if draft is not None and not preset_setup.apply_motion_disabled_reason(session, project):
        preset_setup.close_motion_setup(session)
        pending_changes.run_when_idle(session, do(_begin, draft), _("Apply motion preset"))


@with_project
def _begin(session: Session, project: Project, draft: MotionSetup) -> None:
    if draft.layer not in project.runtimes.layers:
        return
    before = project.document.layer(draft.layer)
    if before.domain is not draft.domain:
        session.notices.show(
            _(
                "The motion was not applied: the drawing's shape changed meanwhile. Apply the "
                "motion again."
            )
        )
        return
    base = _without(project.document, draft)
    frames = project.runtimes.shown_frames
    task = MotionJob(setup=draft, before=before, base=base, frames_before=frames)
    order = _motion_request(draft, before)
    rgba = project.runtimes.layers[before.id].picture.rgba
    _step(session, project, task, partial(_prepare, task, order, rgba))


def _prepare(task: MotionJob, order: MotionRequest, rgba: Bytes) -> MotionJob:
    """Return a job ready for its first pose, with the mesh that shows poses; on the worker."""
    solve = start_motion_solve(task.base, task.before.id, order, rgba)
    clip = clip_of(solve.document, task.before.id)
    mesh = DeformMesh.coarse(clip.layer.domain).prepared(clip, order.first)
    return replace(task, solve=solve, preview=InbetweenCache(mesh=mesh))


def _motion_request(draft: MotionSetup, before: Layer) -> MotionRequest:
    """Return the request for the solver; what was edited by hand stays in the same preset."""
    edits: dict[str, Any] = {}
    given = draft.applied_motion
    if given is not None and given.motion == draft.motion and not draft.replaces_edits:
        edits = {
            "edits": find_motion_edits(before, given),
            "edited_start": given.start,
            "edited_period": (given.last - given.start) // given.repeat_count,
        }
    return MotionRequest(
        motion=draft.motion,
        kind=draft.kind,
        joints=draft.joints,
        parameters=draft.parameters,
        first=draft.first,
        repeat_count=draft.rounds,
        facing=draft.facing,
        # The motion's own handles go to its dragged joints.
        handles={} if given is None else given.joints,
        **edits,
    )


def _without(document: Document, draft: MotionSetup) -> Document:
    """Return a document without the motion that a draft replaces.

    Only its own keys and springs are deleted, also keys that were moved. One of them stays if the
    layer has no other.
    """
    given, layer = draft.applied_motion, document.layer(draft.layer)
    if given is None:
        return document
    layer = without_motion_springs(layer, given)
    if draft.replaces_edits:
        made = {spring.handle for spring in given.springs}
        springs = tuple(each for each in layer.springs if each.handle not in made)
        layer = replace(layer, springs=springs)
    kept = [key for key in layer.keys if key.motion != given.id]
    return document.with_layer(
        replace(
            layer,
            keys=tuple(kept) or layer.keys[:1],
            cycles=tuple(each for each in layer.cycles if each.first != given.start),
            motions=tuple(each for each in layer.motions if each is not given),
        )
    )


def _step(
    session: Session, project: Project, task: MotionJob, work: Callable[[], MotionJob]
) -> None:
    """Run one step on the worker."""

    def failed(error: Exception) -> None:
        _give_up(session, project, task)
        report_failure(session, GIVING.complaint, error)

    def arrived(task: MotionJob) -> None:
        _go_on(session, project, task)

    change = PendingChange(label=GIVING.label, motion_job=task)
    pending_changes.begin_pending_change(
        session, project, GIVING, work, arrived, failed, change=change
    )


def _give_up(session: Session, project: Project, task: MotionJob) -> None:
    """Show the frames as they were, and the draft, unless another tool is selected meanwhile."""
    project.runtimes.show_again(task.frames_before)
    is_active = task.before.id == project.selection.active
    if session.project is project and session.tools.mode == "pose" and is_active:
        session.tools.select(task.setup)


def _go_on(session: Session, project: Project, task: MotionJob) -> None:
    """Take the next step, or write the motion to the layer."""
    if task.solve is not None and not task.solve.is_over:
        solve = task.solve
        _step(session, project, task, lambda: replace(task, solve=step_motion_solve(solve)))
    elif task.solve is not None:
        _accept(session, project, task, task.solve)


def _accept(session: Session, project: Project, task: MotionJob, giving: MotionSolve) -> None:
    """Write the motion to the layer and play it; if the layer changed meanwhile, show a notice."""
    before = task.before
    if before not in project.document.layers:
        session.notices.show(
            _("The motion was not applied: the drawing changed meanwhile. Apply the motion again.")
        )
        _give_up(session, project, task)
        return
    gesture, command = object(), giving.command
    change = Command(command.label, lambda document: command(_without(document, task.setup)))
    project.history.do(change, gesture=gesture)
    unkeyed = project.history.preview_pose
    if unkeyed is not None and unkeyed.layer == before.id:
        project.history.set_preview_pose(None, gesture=gesture)
    if giving.parted:
        session.notices.show(_(PARTED))
    _show_unreached_joints(session, giving)
    if session.tools.active_tool is None:
        playback.scrub(session, giving.applied.first)
        playback.toggle_play(session)


def _show_unreached_joints(session: Session, giving: MotionSolve) -> None:
    """Show a notice of joints that are out of reach, and offer a size that reaches all."""
    if not giving.target_errors:
        return
    parts = [
        _("{joint} ({distance:.0f} px short)").format(joint=_(name), distance=error)
        for name, (error, *_rest) in giving.target_errors.items()
    ]
    named, more = ", ".join(parts[:MOST_NAMED]), len(parts) - MOST_NAMED
    if more > 0:
        text = ngettext(
            "The limits keep some joints from following the motion: {joints} and {count} more "
            "joint.",
            "The limits keep some joints from following the motion: {joints} and {count} more "
            "joints.",
            more,
        ).format(joints=named, count=more)
    else:
        text = _("The limits keep some joints from following the motion: {joints}.")
        text = text.format(joints=named)
    size = giving.reachable_size
    if size is None:
        session.notices.show(text, topic="motion")
        return
    session.notices.show(
        text,
        topic="motion",
        label=_("Use size {size:.2f}").format(size=size),
        action=do(change_applied_motion, giving.before.id, giving.applied.first, size=size),
    )


@with_project
def change_applied_motion(
    session: Session, project: Project, layer: int, first: int, /, **values: Any
) -> None:
    """Apply a motion that begins at a frame again, with other parameters.

    What was edited by hand stays.
    """
    found = project.document.layer(layer) if layer in project.runtimes.layers else None
    given = next((each for each in found.motions if each.first == first), None) if found else None
    if found is None or given is None:
        session.notices.show(_("This motion was deleted."))
        return
    draft = setup_of_applied_motion(found, given)
    parameters = replace(draft.parameters, **values)
    pending_changes.run_when_idle(
        session, do(_begin, replace(draft, parameters=parameters)), _("Apply motion preset")
    )


@named_action(
    _("Cancel motion preset"),
    "Escape",
    why_disabled=unless(
        lambda _, project: project.motion_job, _("No motion preset is being applied.")
    ),
)
@with_project
def cancel_motion_job(session: Session, project: Project) -> None:
    """Cancel the pending motion; its draft opens again."""
    task = project.motion_job
    if task is not None:
        pending_changes.cancel_pending_change(session, project, GIVING)
        _give_up(session, project, task)
