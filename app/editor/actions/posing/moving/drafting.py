"""A motion that is about to be given: which one, to what kind of body, and how."""

from collections.abc import Collection
from dataclasses import replace
from typing import Any

from app.document import AppliedMotion, Layer, is_motion_unedited
from app.editor.actions import playback
from app.editor.actions.posing.moving.placing import joints_in
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work import MotionDraft
from engine.domain import guessed_kind
from engine.geometry.motions import MOTIONS, Parameters

MOST_ROUNDS = 50
PANEL = "Motion"
LINKS = 6


def why_not(_: Session, project: Project) -> str:
    """Return why the layer that is posed can be given no motion; empty where it can."""
    layer = project.layer
    if layer.still:
        return f"{layer.name} is a still picture: there is no shape on it to be moved."
    if layer.locked:
        return f"{layer.name} is locked: unlock it in the list of layers first."
    return ""


@with_project
def begin(session: Session, project: Project) -> None:
    """Draft a motion for the layer that is posed: the one that it has at this frame, or a new one.

    What is drafted already is shown.
    """
    session.wanted_panel = PANEL
    if project.draft is not None or project.errand is not None or session.pointer is not None:
        return
    playback.halt(session)
    session.cutting = session.material = None
    session.moves = session.records = False
    project.selected = frozenset()
    frame = playback.current_frame(session, project)
    here = [each for each in project.layer.motions if each.first <= frame < each.last]
    if here:
        project.draft = draft_again(project.layer, here[-1])
    else:
        project.draft = _put_away(project, frame) or _new(project.layer, frame)
    # It has hints of its own.
    session.guide = None


@with_project
def begin_again(session: Session, project: Project, given: AppliedMotion) -> None:
    """Draft a motion that the layer was given once more, to give it in another way."""
    if given in project.layer.motions:
        playback.scrub(session, given.first)
        begin(session)


@with_project
def begin_after(session: Session, project: Project, given: AppliedMotion) -> None:
    """Draft another motion, to follow one that the layer was given; joints stay as they are."""
    draft = project.draft
    if draft is None:
        playback.scrub(session, given.last)
        begin(session)
    elif given in project.layer.motions:
        playback.scrub(session, given.last)
        project.draft = replace(draft, given=None, first=given.last)


def _put_away(project: Project, frame: int) -> MotionDraft | None:
    """Return the draft that was put away last, if it was of the same shape, and a first motion."""
    draft, layer = project.last_draft, project.layer
    if draft is None or layer.motions or draft.given is not None:
        return None
    is_same = (draft.layer, draft.domain) == (layer.id, layer.domain)
    return replace(draft, first=frame, past=(), chosen=None) if is_same else None


def _new(layer: Layer, frame: int) -> MotionDraft:
    """Return what a layer is given that has nothing at a frame: as the last one, or as it seems.

    Joints of the motion before are those of this one.
    """
    earlier = [each for each in layer.motions if each.first <= frame]
    if earlier:
        draft = draft_again(layer, earlier[-1])
        return replace(draft, given=None, first=frame, parameters=Parameters(), rounds=1)
    kind = guessed_kind(layer.domain.loops)
    joints = joints_in(layer, kind.name)
    return MotionDraft(
        layer=layer.id,
        domain=layer.domain,
        kind=kind.name,
        motion=_first_motion(kind.name, joints),
        joints=joints,
        suggested=joints,
        first=frame,
    )


def draft_again(layer: Layer, given: AppliedMotion) -> MotionDraft:
    """Return the draft by which a layer was given a motion."""
    there = {handle.id: handle.position for handle in layer.handles}
    names = given.joints.items()
    joints = {name: there[handle] for name, handle in names if handle in there}
    ends = {handle for bone in layer.bones for handle in bone.ends}
    return MotionDraft(
        layer=layer.id,
        domain=layer.domain,
        kind=given.kind,
        motion=given.motion,
        joints=joints if given.kind != "anything" else {},
        suggested=joints_in(layer, given.kind),
        parameters=given.parameters,
        rounds=given.repeat_count,
        facing=given.facing,
        bones=not ends.isdisjoint(limb_joints(given)),
        first=given.first,
        given=given,
    )


def limb_joints(given: AppliedMotion) -> set[int]:
    """Return the ids of the handles that are joints of limbs, or links of a chain."""
    return {handle for name, handle in given.joints.items() if "." in name}


def _first_motion(kind: str, joints: Collection[str]) -> str:
    """Return the first motion that fits a kind and its joints, one that gets on before others.

    Along few links, as of a fish, no wave runs: it wags its tail.
    """
    if kind == "chain" and len(joints) < LINKS:
        return "wag"
    fitting = [name for name, motion in MOTIONS.items() if kind in motion.courses]
    possible = [name for name in fitting if {*MOTIONS[name].course(kind).needed} <= {*joints}]
    getting_on = [name for name in possible if MOTIONS[name].course(kind).travels]
    return (getting_on or possible or fitting)[0]


@with_project
def choose_kind(_: Session, project: Project, kind: str) -> None:
    """Take the drawing for another kind of body; its joints are those that it had, or suggested."""
    draft = project.draft
    if draft is None or kind == draft.kind:
        return
    others = {**draft.others, draft.kind: draft.joints}
    suggested = joints_in(project.layer, kind)
    joints = others.get(kind, suggested)
    fits = kind in MOTIONS[draft.motion].courses
    project.draft = replace(
        draft,
        kind=kind,
        joints=joints,
        suggested=suggested,
        others=others,
        motion=draft.motion if fits else _first_motion(kind, joints),
        facing=None,
        chosen=None,
        past=(),
    )


@with_project
def choose_motion(_: Session, project: Project, motion: str) -> None:
    """Choose what it is to do; only what has steps travels."""
    draft = project.draft
    if draft is not None and draft.kind in MOTIONS[motion].courses:
        travels = draft.parameters.travel and MOTIONS[motion].course(draft.kind).travels
        parameters = replace(draft.parameters, travel=travels)
        project.draft = replace(draft, motion=motion, parameters=parameters)


@with_project
def set_parameters(_: Session, project: Project, /, **values: Any) -> None:
    """Set how it is to be done: speed, size, energy, mirrored, start, travel."""
    if project.draft is not None:
        parameters = replace(project.draft.parameters, **values)
        project.draft = replace(project.draft, parameters=parameters)


@with_project
def set_up(_: Session, project: Project, /, **values: Any) -> None:
    """Set what else is to be: rounds, facing, bones, whether edits are replaced."""
    if project.draft is not None:
        project.draft = replace(project.draft, **values)


def was_edited(project: Project) -> bool:
    """Tell whether what a draft takes the place of was edited by hand since it was given."""
    draft = project.draft
    return (
        draft is not None
        and draft.given is not None
        and not is_motion_unedited(project.layer, draft.given)
    )


def hindrance(project: Project) -> str:
    """Return why the draft cannot be given as it is; empty where it can."""
    draft = project.draft
    if draft is None:
        return "There is no motion to be given."
    if draft.lacking:
        missing = ", ".join(draft.lacking)
        return f"{draft.ready.label} needs {missing}: click on it in the diagram to add it."
    if was_edited(project) and not draft.replaces_edits:
        return "It was edited by hand since it was given, which would be lost."
    return ""


@with_project
def give_up(_: Session, project: Project) -> None:
    """Put the draft away; nothing of it was done to the layer, and its joints are remembered."""
    project.last_draft, project.draft = project.draft, None


@with_project
def maintain(_: Session, project: Project) -> None:
    """Forget a draft whose layer is not posed any more, or has another shape; once a frame."""
    draft = project.draft
    if draft is None:
        return
    layer = project.layer
    if draft.layer != project.active or draft.domain is not layer.domain or layer.still:
        project.draft = None
    elif draft.given is not None and draft.given not in layer.motions:
        project.draft = replace(draft, given=None)
