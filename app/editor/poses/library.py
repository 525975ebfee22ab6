"""Libraries: poses under names, which are put on the timeline or blended in."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from app.document import Keyframe, Layer, LibraryPose, Pose, Target, pose_commands
from app.editor.actions import editing, playback, posing
from app.editor.poses import pasting, putting
from app.editor.poses.receiving import Landing, landing_on
from app.editor.project import PoseBlend, Project
from app.editor.session import CopiedKeys, Session, with_project
from app.editor.work import Kind, Start

KEEPING = Kind("Keeping a pose", "The pose could not be kept", "hand")


@with_project
def keep(session: Session, project: Project) -> None:
    """Put the pose at the playhead into the library."""
    putting.take_pose(session, project, KEEPING, partial(_keep, session, project))


def _keep(session: Session, project: Project, layer: Layer, pose: Pose) -> None:
    if layer.domain is not project.layer.domain:
        session.tell("The pose was not kept: the shape changed meanwhile.")
        return
    taken = [Keyframe(frame=0, pose=pose)]
    (key,) = putting.fitted(project, project.active, taken, layer.bounds)
    editing.edit(session, pose_commands.save_pose(project.active, key.pose))
    project.picked_pose = (project.active, project.layer.library[-1].name)


class PoseOffer(NamedTuple):
    """A pose of a library that the layer that is posed can take, and whose it is."""

    owner: Layer
    kept: LibraryPose


def offers(project: Project) -> list[PoseOffer]:
    """Return the poses of the layer's own library, then those of others with its handles' names.

    They come to it as they do by pasting.
    """
    own = project.layer
    layers = [own, *(each for each in project.document.layers if each is not own)]
    return [
        PoseOffer(each, kept)
        for each in layers
        if each.library and not _landing(project, PoseOffer(each, each.library[0])).hindrance
        for kept in each.library
    ]


@with_project
def apply(session: Session, project: Project, name: str, owner: int | None = None) -> None:
    """Put a pose of a library into a key at the present frame; by default the layer's own."""
    _put(session, project, _offer(project, name, owner), putting.stand_at_frame(session, project))


@with_project
def apply_at(
    session: Session, project: Project, name: str, frame: int, owner: int | None = None
) -> None:
    """Put a pose of a library into a key at a frame, and go there."""
    putting.stand_at_frame(session, project)
    _put(session, project, _offer(project, name, owner), frame)
    playback.seek(session, frame)


def _offer(project: Project, name: str, owner: int | None) -> PoseOffer:
    layer = project.layer if owner is None else project.document.layer(owner)
    return PoseOffer(layer, layer.library_pose(name))


def _landing(project: Project, offer: PoseOffer) -> Landing:
    copied = CopiedKeys(offer.owner, (Keyframe(frame=0, pose=offer.kept.pose),))
    return landing_on(project.document, copied, project.layer, "as it is")


def _put(session: Session, project: Project, offer: PoseOffer, frame: int) -> None:
    landing = _landing(project, offer)
    if landing.hindrance:
        session.tell(landing.hindrance)
        return
    project.picked_pose = (offer.owner.id, offer.kept.name)
    pasting.bring(session, project, [landing], "as it is", frame, label="Use pose")


@with_project
def blend(
    session: Session, project: Project, name: str, share: float, owner: int | None = None
) -> None:
    """Mix a pose of a library into the one that is shown, as it was when this began.

    Parameters
    ----------
    name : str
    share : float
        Of the pose in the library: 0 changes nothing, 1 is that pose itself. Between them the
        handles are on the way, and the shape follows within its limits.
    owner : int, optional
        Whose pose it is; by default the layer's own.
    """
    offer = _offer(project, name, owner)
    begun = project.blend
    if begun is None or (begun.name, begun.owner) != (name, offer.owner.id):
        project.blend = begun = PoseBlend(name=name, owner=offer.owner.id, gesture=object())
    project.blend = replace(begun, share=share)
    wishes = pasting.wishes_of(project, _landing(project, offer), "as it is")

    def mix(start: Start, _: Mapping[int, Target]) -> Mapping[int, Target]:
        return {
            identity: _between(start.targets[identity], target, share)
            for identity, target in wishes.items()
            if identity in start.targets
        }

    posing.pull(session, mix, gesture=begun.gesture)


@with_project
def end_blend(session: Session, project: Project) -> None:
    """Let the pose be as it is mixed now; wholly mixed in, it is that of the library itself."""
    blend, project.blend = project.blend, None
    posing.let_go(session)
    if blend is not None and blend.share >= 1.0 and blend.owner == project.active:
        for pull in [pull for pull in project.pulls if blend.gesture in pull.wishes]:
            pose = project.document.layer(pull.layer).library_pose(blend.name).pose
            posing.end_at(session, project, pull, pose)


def _between(one: Target, other: Target, share: float) -> Target:
    position = (1 - share) * one.position + share * other.position
    if one.rotation is None or other.rotation is None:
        rotation = one.rotation if share < 0.5 else other.rotation
    else:
        rotation = (1 - share) * one.rotation + share * other.rotation
    return Target(position=position, rotation=rotation)


@with_project
def rename(session: Session, project: Project, name: str, to: str) -> None:
    """Give a pose of the library another name."""
    editing.edit_layer(session, pose_commands.rename_pose, name, to)
    project.picked_pose = (project.active, to)


def delete(session: Session, name: str) -> None:
    """Take a pose out of the library; keys that were made of it stay."""
    editing.edit_layer(session, pose_commands.delete_pose, name)
