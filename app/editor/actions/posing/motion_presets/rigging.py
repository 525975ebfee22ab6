"""Rig a drawing in one step: handles, bones, sides, rigid ends and names."""

from dataclasses import replace

from app.document import Command, Document
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.motion_setup import MotionSetup
from app.solving import PARTED, MotionRequest, find_limb_cuts, find_rest_body, rig_body
from app.texts import _, ngettext


@named_action(
    _("Rig this"),
    icon="BONE",
    hint=_("Find the joints, and make handles and bones with names and near limbs in front"),
    why_disabled=preset_setup.motion_disabled_reason,
)
@with_project
def rig_layer(session: Session, project: Project) -> None:
    """Rig the active layer by its guessed joints, or by those of the draft.

    Where the guess is not sure, a draft of a motion preset asks first.
    """
    draft = session.tools.motion_setup
    if draft is None:
        frame = playback.current_frame(session, project)
        draft = preset_setup.new_motion_setup(project, project.layer, frame)
    if not draft.joints:
        session.notices.show(
            _("Lissom found no limbs. Choose the kind of body and place its joints.")
        )
        preset_setup.begin_motion_setup(session)
    elif draft.unsure:
        preset_setup.begin_motion_setup(session)
        session.notices.show(_("Say which limbs are nearer. Then press “Rig this” again."))
    else:
        _rig(session, project, draft)


def _rig(session: Session, project: Project, draft: MotionSetup) -> None:
    """Make the rig of a draft's joints, in one undo step."""
    layer = project.document.layer(draft.layer)
    order = MotionRequest(
        motion=draft.motion, kind=draft.kind, joints=draft.joints, facing=draft.facing
    )
    body = find_rest_body(layer, order)
    rgba = project.runtimes.layers[layer.id].picture.rgba
    cuts = None if layer.is_stale else find_limb_cuts(layer, body, rgba)
    if cuts is not None:
        body = replace(body, joints=cuts.joints)

    def rigged(document: Document) -> Document:
        made = rig_body(document, layer.id, body, {})[0]
        if cuts is None:
            return made
        # The domain is rebuilt, and keys are solved again, as after each change of the cut-out.
        parted = replace(made.layer(layer.id), cut_out=cuts.cut_out, is_stale=True)
        return made.with_layer(parted)

    if session.tools.motion_setup is not None:
        preset_setup.close_motion_setup(session)
    project.history.do(Command(_("Rig this"), rigged))
    made = project.document.layer(layer.id)
    bones = len(made.bones) - len(layer.bones)
    text = _("{layer} has this rig already.")
    if bones or len(made.handles) > len(layer.handles):
        text = ngettext(
            "{layer} has a rig now: {count} bone more.",
            "{layer} has a rig now: {count} bones more.",
            bones,
        )
    text = text.format(layer=made.name, count=bones)
    session.notices.show(text if cuts is None else f"{text} {_(PARTED)}")
