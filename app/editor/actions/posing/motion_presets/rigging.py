"""Rig a drawing in one step: handles, bones, sides, rigid ends and names."""

from dataclasses import replace
from functools import partial
from typing import NamedTuple

from app.document import Command, Document, Layer, clip_of
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.motion_presets import preset_setup
from app.editor.actions.posing.motion_presets.new_setup import new_motion_setup
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.motion_setup import MotionSetup
from app.errors import report_progress
from app.solving import PARTED, MotionRequest, find_limb_cuts, find_rest_body, rig_body
from app.texts import _, ngettext
from engine.arrays import Bytes

RIGGING = JobKind(_("Rigging the drawing"), _("The drawing was not rigged"), "hand")
DRAFTED = 0.4  # share of the work after which the joints are found


class FoundRig(NamedTuple):
    """A draft of joints, and the layer with their rig; None if the joints are not sure."""

    draft: MotionSetup
    layer: Layer | None


@named_action(
    _("Rig this"),
    icon="BONE",
    hint=_("Find the joints, and make handles and bones with names and near limbs in front"),
    why_disabled=preset_setup.motion_disabled_reason,
)
def rig_layer(session: Session) -> None:
    """Rig the active layer by its guessed joints, or by those of the draft, on the worker.

    Where the guess is not sure, a draft of a motion preset asks first.
    """
    pending_changes.run_when_idle(session, do(_begin), _("Rig this"))


@with_project
def _begin(session: Session, project: Project) -> None:
    layer, draft = project.layer, session.tools.motion_setup
    rgba, frame = project.layer_runtime.picture.rgba, playback.current_frame(session, project)
    document, runtime = project.document, project.layer_runtime
    meshes = [store.mesh for store in (runtime.store, runtime.fine) if store is not None]

    def work() -> FoundRig:
        found = _find_rig(document, layer, rgba, draft or frame)
        if found.layer is not None:
            # Until the domain is rebuilt, the rig is shown on the present meshes.
            clip = clip_of(document.with_layer(found.layer), layer.id)
            for mesh in meshes:
                mesh.prepared(clip, frame)
        return found

    done = partial(_take_rig, session, project, layer)
    pending_changes.cancel_pending_change(session, project, RIGGING)
    pending_changes.begin_pending_change(session, project, RIGGING, work, done)


def _find_rig(document: Document, layer: Layer, rgba: Bytes, origin: MotionSetup | int) -> FoundRig:
    """Return the rig of a draft's joints, or of those that are found at a frame."""
    report_progress(0.0)
    draft = origin if isinstance(origin, MotionSetup) else new_motion_setup(layer, rgba, origin)
    if draft.unsure or not draft.joints:
        return FoundRig(draft, None)
    report_progress(DRAFTED)
    order = MotionRequest(
        motion=draft.motion, kind=draft.kind, joints=draft.joints, facing=draft.facing
    )
    body = find_rest_body(layer, order)
    cuts = None if layer.is_stale else find_limb_cuts(layer, body, rgba)
    if cuts is None:
        return FoundRig(draft, rig_body(document, layer.id, body, {})[0].layer(layer.id))
    body = replace(body, joints=cuts.joints)
    rigged = rig_body(document, layer.id, body, {})[0].layer(layer.id)
    # The domain is rebuilt, and keys are solved again, as after each change of the cut-out.
    return FoundRig(draft, replace(rigged, cut_out=cuts.cut_out, is_stale=True))


def _take_rig(session: Session, project: Project, before: Layer, found: FoundRig) -> None:
    """Make the found rig in one undo step, or ask what is not sure."""
    draft, rigged = found
    if before not in project.document.layers:
        session.notices.show(
            _("The drawing was not rigged: it changed meanwhile. Press “Rig this” again.")
        )
        return
    if rigged is None:
        session.notices.show(
            _("Say which limbs are nearer. Then press “Rig this” again.")
            if draft.unsure
            else _("Lissom found no limbs. Choose the kind of body and place its joints.")
        )
        preset_setup.show_motion_setup(session, draft)
        return
    if session.tools.motion_setup is not None:
        preset_setup.close_motion_setup(session)
    project.history.do(Command(_("Rig this"), lambda document: document.with_layer(rigged)))
    bones = len(rigged.bones) - len(before.bones)
    text = _("{layer} has this rig already.")
    if bones or len(rigged.handles) > len(before.handles):
        text = ngettext(
            "{layer} has a rig now: {count} bone more.",
            "{layer} has a rig now: {count} bones more.",
            bones,
        )
    text = text.format(layer=rigged.name, count=bones)
    is_parted = rigged.cut_out is not before.cut_out
    session.notices.show(f"{text} {_(PARTED)}" if is_parted else text)


@named_action(
    _("Cancel rigging"),
    "Escape",
    why_disabled=unless(
        lambda session, _: {RIGGING, preset_setup.FINDING} & {*session.jobs.kinds},
        _("No joints are being found."),
    ),
)
@with_project
def cancel_rigging(session: Session, project: Project) -> None:
    """Cancel the search for joints, for a rig or for a motion preset."""
    pending_changes.cancel_pending_change(session, project, RIGGING)
    pending_changes.cancel_pending_change(session, project, preset_setup.FINDING)
