"""Pose libraries: named poses that are keyed or blended in."""

from collections.abc import Mapping
from functools import partial
from typing import NamedTuple

from app.document import Keyframe, Layer, LibraryPose, Pose, Target, pose_commands
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action
from app.editor.actions.posing.pose_commit import commit_drag
from app.editor.actions.posing.pose_drag import drag_handles, release_drag
from app.editor.parts.clipboard import CopiedKeys
from app.editor.poses import pasting, pasting_targets, pose_insertion
from app.editor.poses.paste_destinations import PasteDestination, find_paste_destination
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.drag_session import DragStart
from app.editor.work.jobs import JobKind
from app.texts import _

KEEPING = JobKind(_("Saving a pose"), _("The pose could not be keyed"), "hand")


@named_action(_("Save pose"), "Shift+K", icon="PLUS", hint=_("Add this pose to the library"))
@with_project
def save_pose_to_library(session: Session, project: Project) -> None:
    """Save the pose at the playhead to the library."""
    pose_insertion.request_pose_at_playhead(
        session, project, KEEPING, partial(_save_pose, session, project)
    )


def _save_pose(session: Session, project: Project, layer: Layer, pose: Pose) -> None:
    if layer.domain is not project.layer.domain:
        session.notices.show(
            _("The pose was not saved: the shape changed meanwhile. Save it again.")
        )
        return
    taken = [Keyframe(frame=0, pose=pose)]
    (key,) = pose_insertion.fit_keys_to_layer(
        project, project.selection.active, taken, layer.bounds
    )
    editing.edit_layer(session, pose_commands.save_pose, key.pose)
    project.pose_edits.pick(project.selection.active, project.layer.library[-1].name)


class PoseOffer(NamedTuple):
    """A library pose that the active layer can take, and its owner."""

    owner: Layer
    kept: LibraryPose


def list_library_poses(project: Project) -> list[PoseOffer]:
    """Return the poses of the active layer's library, then fitting poses of other layers.

    A pose of another layer fits by handle names, as in pasting.
    """
    own = project.layer
    layers = [own, *(each for each in project.document.layers if each is not own)]
    return [
        PoseOffer(each, kept)
        for each in layers
        if each.library
        and not _paste_destination(project, PoseOffer(each, each.library[0])).disabled_reason
        for kept in each.library
    ]


@with_project
def apply_library_pose(
    session: Session, project: Project, name: str, owner: int | None = None
) -> None:
    """Key a library pose at the present frame; by default from the layer's own library."""
    _put(
        session,
        project,
        _find_library_pose(project, name, owner),
        pose_insertion.stop_and_get_frame(session, project),
    )


@with_project
def apply_library_pose_at(
    session: Session, project: Project, name: str, frame: int, owner: int | None = None
) -> None:
    """Key a library pose at a frame, and go there."""
    pose_insertion.stop_and_get_frame(session, project)
    _put(session, project, _find_library_pose(project, name, owner), frame)
    playback.seek(session, frame)


def _find_library_pose(project: Project, name: str, owner: int | None) -> PoseOffer:
    layer = project.layer if owner is None else project.document.layer(owner)
    return PoseOffer(layer, layer.library_pose(name))


def _paste_destination(project: Project, offer: PoseOffer) -> PasteDestination:
    copied = CopiedKeys(offer.owner, (Keyframe(frame=0, pose=offer.kept.pose),))
    return find_paste_destination(project.document, copied, project.layer, "as it is")


def _put(session: Session, project: Project, offer: PoseOffer, frame: int) -> None:
    landing = _paste_destination(project, offer)
    if landing.disabled_reason:
        session.notices.show(landing.disabled_reason)
        return
    project.pose_edits.pick(offer.owner.id, offer.kept.name)
    pasting.paste_poses(session, project, [landing], "as it is", frame, label=_("Use pose"))


@with_project
def blend_library_pose(
    session: Session, project: Project, name: str, share: float, owner: int | None = None
) -> None:
    """Blend a library pose into the pose that was shown when the blend began.

    Parameters
    ----------
    share : float
        Weight of the library pose: 0 changes nothing, 1 is that pose. In between, targets are
        interpolated, and the shape follows within its limits.
    owner : int, optional
        The layer of the library; by default the active layer.
    """
    offer = _find_library_pose(project, name, owner)
    blend = project.pose_edits.blend(name, offer.owner.id, share)
    targets = pasting_targets.pasted_targets(
        project, _paste_destination(project, offer), "as it is"
    )

    def mix(start: DragStart, _: Mapping[int, Target]) -> Mapping[int, Target]:
        return {
            identity: _between(start.targets[identity], target, share)
            for identity, target in targets.items()
            if identity in start.targets
        }

    drag_handles(session, mix, gesture=blend.gesture)


@with_project
def end_pose_blend(session: Session, project: Project) -> None:
    """Keep the blended pose; with a share of 1, key the library pose exactly."""
    blend = project.pose_edits.end_blend()
    release_drag(session)
    drag = project.drag
    if blend is None or drag is None or blend.gesture not in drag.target_changes:
        return
    if blend.share >= 1.0 and blend.owner == project.selection.active:
        pose = project.document.layer(drag.layer).library_pose(blend.name).pose
        commit_drag(session, project, drag, pose)


def _between(one: Target, other: Target, share: float) -> Target:
    position = (1 - share) * one.position + share * other.position
    if one.rotation is None or other.rotation is None:
        rotation = one.rotation if share < 0.5 else other.rotation
    else:
        rotation = (1 - share) * one.rotation + share * other.rotation
    return Target(position=position, rotation=rotation)


@with_project
def rename_library_pose(session: Session, project: Project, name: str, to: str) -> None:
    editing.edit_layer(session, pose_commands.rename_pose, name, to)
    project.pose_edits.pick(project.selection.active, to)
