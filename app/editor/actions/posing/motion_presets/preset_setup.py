"""The draft of a motion preset: motion, body kind and parameters."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any, TypeVar

from app.document import AppliedMotion, is_motion_unedited
from app.editor import pending_changes
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.posing.motion_presets.new_setup import (
    find_first_motion,
    find_joints,
    new_motion_setup,
    setup_of_applied_motion,
)
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.motion_setup import MotionSetup
from app.editor.work.pending_change import PendingChange
from app.rigging import MOTIONS
from app.solving import JointGuess
from app.texts import _, ngettext

Found = TypeVar("Found")

MOST_ROUNDS = 50
PANEL = "Animate"
FINDING = JobKind(_("Finding the joints"), _("The joints were not found"), "hand")


def motion_disabled_reason(_session: Session, project: Project) -> str | None:
    """Return why the active layer cannot get a motion; None if it can."""
    layer = project.layer
    if layer.still:
        text = _("{layer} is a still picture. Make it posable first.")
        return text.format(layer=layer.name)
    if layer.locked:
        text = _("{layer} is locked. Unlock it in the Layers tab first.")
        return text.format(layer=layer.name)
    return None


@named_action(
    _("Apply motion preset…"),
    "A",
    icon="PERSON_WALKING",
    hint=_("Make the layer walk, wave or breathe: place its joints and choose a motion"),
    why_disabled=motion_disabled_reason,
    active=lambda session: session.tools.motion_setup,
)
@with_project
def begin_motion_setup(session: Session, project: Project) -> None:
    """Draft a motion for the active layer: its motion at this frame, or a new one.

    An existing draft is shown again.
    """
    session.display.focus_panel(PANEL)
    if (
        session.tools.motion_setup is not None
        or project.motion_job is not None
        or session.tools.active_tool is not None
    ):
        return
    playback.stop_playback(session)
    project.selection.deselect_handles(project.selection.handles)
    layer, rgba = project.layer, project.layer_runtime.picture.rgba
    frame, kept = playback.current_frame(session, project), kept_motion_setup(session, project)
    here = [each for each in layer.motions if each.first <= frame < each.last]
    if here:
        show_motion_setup(session, setup_of_applied_motion(layer, here[-1]))
        search = partial(find_joints, layer, rgba, here[-1].kind)
        _find(session, project, search, partial(_suggest_joints, session))
    elif kept is not None:
        show_motion_setup(session, replace(kept, first=frame, past=(), selected_joint=None))
    else:
        session.tools.select("pose")
        work = partial(new_motion_setup, layer, rgba, frame)
        _find(session, project, work, partial(_show_found_setup, session))


def show_motion_setup(session: Session, draft: MotionSetup) -> None:
    """Show a draft in its panel."""
    session.display.focus_panel(PANEL)
    session.tools.select(draft)
    # Motion setup has its own hints.
    session.tutorial.end()


def _show_found_setup(session: Session, draft: MotionSetup) -> None:
    """Show a new draft, unless another tool is selected meanwhile."""
    if session.tools.mode == "pose":
        show_motion_setup(session, draft)


def _find(
    session: Session,
    project: Project,
    work: Callable[[], Found],
    done: Callable[[Found], None],
) -> None:
    """Find joints of the active layer on the worker; an earlier search is dropped."""
    layer = project.layer
    pending_changes.cancel_pending_change(session, project, FINDING)

    def found(result: Found) -> None:
        if project.layer.id == layer.id and project.layer.domain is layer.domain:
            done(result)

    change = PendingChange(label=FINDING.label, changes=False)
    pending_changes.begin_pending_change(session, project, FINDING, work, found, change=change)


def _suggest_joints(session: Session, guess: JointGuess) -> None:
    """Take the joints that are found for an applied motion as suggestions."""
    draft = session.tools.motion_setup
    if draft is not None:
        session.tools.select(replace(draft, suggested=guess.joints))


@with_project
def edit_applied_motion(session: Session, project: Project, given: AppliedMotion) -> None:
    """Draft a layer's applied motion again, to apply it with changes."""
    if given in project.layer.motions:
        playback.scrub(session, given.first)
        begin_motion_setup(session)


@with_project
def append_motion(session: Session, project: Project, given: AppliedMotion) -> None:
    """Draft another motion to follow an applied motion; joints stay."""
    draft = session.tools.motion_setup
    if draft is None:
        playback.scrub(session, given.last)
        begin_motion_setup(session)
    elif given in project.layer.motions:
        playback.scrub(session, given.last)
        session.tools.select(replace(draft, applied_motion=None, first=given.last))


def kept_motion_setup(session: Session, project: Project) -> MotionSetup | None:
    """Return the draft that was left last if it is of the active layer and was not applied."""
    draft, layer = session.tools.last_motion_setup, project.layer
    if draft is None or layer.motions or draft.applied_motion is not None:
        return None
    return draft if (draft.layer, draft.domain) == (layer.id, layer.domain) else None


@with_project
def set_body_kind(session: Session, project: Project, kind: str) -> None:
    """Set the body kind; its joints are its earlier ones, or are found on the worker."""
    work = partial(find_joints, project.layer, project.layer_runtime.picture.rgba, kind)
    _find(session, project, work, partial(_take_body_kind, session, kind))


def _take_body_kind(session: Session, kind: str, guess: JointGuess) -> None:
    draft = session.tools.motion_setup
    if draft is None or kind == draft.kind:
        return
    others = {**draft.others, draft.kind: draft.joints}
    joints = others.get(kind, guess.joints)
    fits = kind in MOTIONS[draft.motion].templates
    session.tools.select(
        replace(
            draft,
            kind=kind,
            joints=joints,
            suggested=guess.joints,
            unsure=guess.unsure,
            others=others,
            motion=draft.motion if fits else find_first_motion(kind, joints),
            facing=None,
            selected_joint=None,
            past=(),
        )
    )


def set_motion_preset(session: Session, motion: str) -> None:
    """Set the motion; only motions with steps travel."""
    draft = session.tools.motion_setup
    if draft is not None and draft.kind in MOTIONS[motion].templates:
        travels = draft.parameters.travel and MOTIONS[motion].template_for(draft.kind).can_travel
        parameters = replace(draft.parameters, travel=travels)
        session.tools.select(replace(draft, motion=motion, parameters=parameters))


def set_motion_parameters(session: Session, /, **values: Any) -> None:
    """Set parameters by name."""
    draft = session.tools.motion_setup
    if draft is not None:
        session.tools.select(replace(draft, parameters=replace(draft.parameters, **values)))


def set_motion_options(session: Session, /, **values: Any) -> None:
    """Set rounds or facing."""
    if session.tools.motion_setup is not None:
        session.tools.select(replace(session.tools.motion_setup, **values))


def are_edits_lost(session: Session, project: Project) -> bool:
    """Return whether the draft cannot keep edits by hand: it is of another motion preset."""
    draft = session.tools.motion_setup
    if draft is None or draft.applied_motion is None:
        return False
    given = draft.applied_motion
    is_same = given.motion == draft.motion and given.kind == draft.kind and bool(given.made)
    return not is_same and not is_motion_unedited(project.layer, given)


def apply_motion_disabled_reason(session: Session, project: Project) -> str | None:
    """Return why the draft cannot be applied; None if it can."""
    draft = session.tools.motion_setup
    if draft is None:
        return _("Choose a motion preset first.")
    if draft.missing_joints:
        text = ngettext(
            "{motion} needs {joints}: click on this joint in the diagram to add it.",
            "{motion} needs {joints}: click on each of these joints in the diagram to add it.",
            len(draft.missing_joints),
        )
        missing = ", ".join(map(_, draft.missing_joints))
        return text.format(motion=draft.preset.label, joints=missing)
    if are_edits_lost(session, project) and not draft.replaces_edits:
        return _("You edited the motion by hand. Tick “Replace edits” to apply another one.")
    return None


def close_motion_setup(session: Session) -> None:
    """Close the draft without changes to the layer; its joints are remembered."""
    session.tools.select("pose")


@with_project
def update_motion_setup(session: Session, project: Project) -> None:
    """Leave a draft if another layer is active or its shape has changed; once a frame."""
    draft = session.tools.motion_setup
    if draft is None:
        return
    layer = project.layer
    if draft.layer != project.selection.active or draft.domain is not layer.domain or layer.still:
        session.tools.select("pose")
    elif draft.applied_motion is not None and draft.applied_motion not in layer.motions:
        session.tools.select(replace(draft, applied_motion=None))
