"""The figure's library: poses under names, which are put on the timeline or blended in."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from app.document import Figure, Keyframe, Pose, Target, pose_commands
from app.editor.actions import editing, playback, posing
from app.editor.poses import putting
from app.editor.project import PoseBlend, Project
from app.editor.session import Session, with_project
from app.editor.work import Kind, Start

KEEPING = Kind("Keeping a pose", "The pose could not be kept", "hand")


@with_project
def keep(session: Session, project: Project) -> None:
    """Put the pose at the playhead into the library."""
    putting.take_pose(session, project, KEEPING, partial(_keep, session, project))


def _keep(session: Session, project: Project, figure: Figure, pose: Pose) -> None:
    if figure.domain is not project.figure.domain:
        session.tell("The pose was not kept: the shape changed meanwhile.")
        return
    taken = [Keyframe(frame=0, pose=pose)]
    (key,) = putting.fitted(project, project.active, taken, figure.bounds)
    editing.edit(session, pose_commands.keep_pose(project.active, key.pose))
    project.picked_pose = project.figure.library[-1].name


@with_project
def apply(session: Session, project: Project, name: str) -> None:
    """Put a pose of the library into a key at the present frame."""
    _put(session, project, name, putting.stand_at_frame(session, project))


@with_project
def apply_at(session: Session, project: Project, name: str, frame: int) -> None:
    """Put a pose of the library into a key at a frame, and go there."""
    putting.stand_at_frame(session, project)
    _put(session, project, name, frame)
    playback.seek(session, frame)


def _put(session: Session, project: Project, name: str, frame: int) -> None:
    pose = project.figure.kept_pose(name).pose
    project.picked_pose = name
    keys = {project.active: [Keyframe(frame=0, pose=pose)]}
    putting.put(session, project, frame, keys, label="Use pose")


@with_project
def blend(session: Session, project: Project, name: str, share: float) -> None:
    """Mix a pose of the library into the one that is shown, as it was when this began.

    Parameters
    ----------
    name : str
    share : float
        Of the pose in the library: 0 changes nothing, 1 is that pose itself. Between them the
        handles are on the way, and the shape follows within its limits.
    """
    pose = project.figure.kept_pose(name).pose
    if project.blend is None or project.blend.name != name:
        project.blend = PoseBlend(name=name, gesture=object())
    project.blend = replace(project.blend, share=share)

    def mix(start: Start, _: Mapping[int, Target]) -> Mapping[int, Target]:
        return {
            identity: _between(start.targets[identity], target, share)
            for identity, target in pose.targets.items()
            if identity in start.targets
        }

    posing.pull(session, mix, gesture=project.blend.gesture)


@with_project
def end_blend(session: Session, project: Project) -> None:
    """Let the pose be as it is mixed now; wholly mixed in, it is that of the library itself."""
    blend, project.blend = project.blend, None
    posing.let_go(session)
    if blend is not None and blend.share >= 1.0:
        for pull in [pull for pull in project.pulls if blend.gesture in pull.wishes]:
            pose = project.document.figure(pull.figure).kept_pose(blend.name).pose
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
    editing.edit_figure(session, pose_commands.rename_pose, name, to)
    project.picked_pose = to


def delete(session: Session, name: str) -> None:
    """Take a pose out of the library; keys that were made of it stay."""
    editing.edit_figure(session, pose_commands.delete_pose, name)
