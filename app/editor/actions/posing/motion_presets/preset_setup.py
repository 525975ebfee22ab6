"""The draft of a motion preset: motion, body kind and parameters."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from app.document import AppliedMotion, Layer, is_motion_unedited
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.posing.motion_presets.joint_placement import find_joints
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.motion_setup import MotionSetup
from app.rigging import MOTIONS, Parameters
from app.solving import guess_layer_kind
from app.texts import _, ngettext

MOST_ROUNDS = 50
PANEL = "Animate"
LINKS = 6


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
    frame = playback.current_frame(session, project)
    here = [each for each in project.layer.motions if each.first <= frame < each.last]
    if here:
        draft = setup_of_applied_motion(project, project.layer, here[-1])
    else:
        kept = kept_motion_setup(session, project)
        draft = (
            new_motion_setup(project, project.layer, frame)
            if kept is None
            else replace(kept, first=frame, past=(), selected_joint=None)
        )
    session.tools.select(draft)
    # Motion setup has its own hints.
    session.tutorial.end()


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


def new_motion_setup(project: Project, layer: Layer, frame: int) -> MotionSetup:
    """Return a draft for a layer without a motion at a frame: like the last motion, or a guess.

    The joints of the last motion are reused.
    """
    earlier = [each for each in layer.motions if each.first <= frame]
    if earlier:
        draft = setup_of_applied_motion(project, layer, earlier[-1])
        return replace(draft, applied_motion=None, first=frame, parameters=Parameters(), rounds=1)
    kind = guess_layer_kind(layer, project.runtimes.layers[layer.id].picture.rgba)
    guess = find_joints(project, layer, kind.name)
    return MotionSetup(
        layer=layer.id,
        domain=layer.domain,
        kind=kind.name,
        motion=_first_motion(kind.name, guess.joints),
        joints=guess.joints,
        suggested=guess.joints,
        unsure=guess.unsure,
        first=frame,
    )


def setup_of_applied_motion(project: Project, layer: Layer, given: AppliedMotion) -> MotionSetup:
    """Return the draft that gives an applied motion."""
    there = {handle.id: handle.position for handle in layer.handles}
    names = given.joints.items()
    joints = {name: there[handle] for name, handle in names if handle in there}
    return MotionSetup(
        layer=layer.id,
        domain=layer.domain,
        kind=given.kind,
        motion=given.motion,
        joints=joints if given.kind != "anything" else {},
        suggested=find_joints(project, layer, given.kind).joints,
        parameters=given.parameters,
        rounds=given.repeat_count,
        facing=given.facing,
        first=given.first,
        applied_motion=given,
    )


def _first_motion(kind: str, joints: Collection[str]) -> str:
    """Return the first motion that fits a body kind and its joints; travelling ones first.

    A chain of few links, such as a fish, gets a tail wag instead of a wave.
    """
    if kind == "chain" and len(joints) < LINKS:
        return "wag"
    fitting = [name for name, motion in MOTIONS.items() if kind in motion.templates]
    possible = [name for name in fitting if {*MOTIONS[name].template_for(kind).needed} <= {*joints}]
    getting_on = [name for name in possible if MOTIONS[name].template_for(kind).can_travel]
    return (getting_on or possible or fitting)[0]


@with_project
def set_body_kind(session: Session, project: Project, kind: str) -> None:
    """Set the body kind; its joints are its earlier or suggested ones."""
    draft = session.tools.motion_setup
    if draft is None or kind == draft.kind:
        return
    others = {**draft.others, draft.kind: draft.joints}
    guess = find_joints(project, project.layer, kind)
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
            motion=draft.motion if fits else _first_motion(kind, joints),
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
