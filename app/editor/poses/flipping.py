"""The mirror axis of poses, and repeated flips after it was moved."""

from app.document import pose_commands
from app.editor.parts.clipboard import CopiedKeys
from app.editor.poses import pasting
from app.editor.poses.paste_destinations import find_paste_destination
from app.editor.project import Project
from app.editor.session import Session, with_project


def can_flip_again(project: Project) -> bool:
    """Return whether the selected keys still hold the last flipped poses."""
    flip = project.pose_edits.last_flip
    if (
        flip is None
        or project.selection.frames != flip.frames
        or project.selection.active != flip.layer
    ):
        return False
    return all(
        project.layer.key(frame).pose is pose
        for frame, pose in zip(sorted(flip.frames), flip.poses, strict=True)
    )


def is_mirror_axis_shown(session: Session, project: Project) -> bool:
    """Return whether the axis is shown: after a flip, while its overlay is on."""
    return project.timeline.playhead.since is None and (
        session.display.overlays.mirror or can_flip_again(project)
    )


@with_project
def move_mirror_axis(_: Session, project: Project, x: float | None, gesture: object) -> None:
    """Set the axis during a gesture of the hand; None is the middle."""
    project.history.preview(pose_commands.set_mirror(project.selection.active, x), gesture)


@with_project
def flip_pose_again(session: Session, project: Project, gesture: object) -> None:
    """Flip the last flipped poses again, at the present axis."""
    flip = project.pose_edits.last_flip
    if flip is not None and can_flip_again(project):
        copied = CopiedKeys(project.layer, flip.keys)
        found = [find_paste_destination(project.document, copied, project.layer, "flipped")]
        by = min(flip.frames) - min(key.frame for key in flip.keys)
        pasting.paste_poses(session, project, found, "flipped", by, gesture=gesture)


@with_project
def set_mirror_axis(session: Session, project: Project, x: float | None) -> None:
    """Set the axis, None is the middle, and flip the last flipped poses again."""
    gesture = object()
    move_mirror_axis(session, x, gesture)
    flip_pose_again(session, gesture)
    project.history.release(gesture)
