"""Write solved poses to the document: as a key, or as an unkeyed preview pose without auto-key."""

from dataclasses import replace

from app.document import Command, Keyframe, Layer, Pose, PreviewPose, key_commands, with_all_targets
from app.editor.error_reports import report_failure
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.pull import Pull
from app.errors import LissomError
from app.texts import _

NO_POSE = _("The pose could not be keyed")


def commit_pose(session: Session, project: Project, pull: Pull, pose: Pose) -> None:
    """Replace the last pose of a drag in the document by a newer pose.

    If this fails, because its key was deleted or a command refuses the pose, the drag ends.
    """
    if pose is pull.kept:
        return
    _follow_copies(session, pull, pose)
    try:
        if pull.kept is None:
            is_adopted = _commit_first(session, project, pull, pose)
        else:
            is_adopted = project.history.amend(pull.gesture, pull.kept, pull.brought_to(pose))
    except LissomError as error:
        report_failure(session, NO_POSE, error)
        is_adopted = False
    pull.kept = pose
    if not is_adopted and pull in project.pending:
        project.pending.remove(pull)


def commit_targets(session: Session, project: Project, pull: Pull) -> bool:
    """Commit the targets of a released drag before the solver has found a pose.

    Return whether they were committed. A drag with an unknown start or of several gestures cannot
    be one undo step.
    """
    if (
        pull.is_held
        or pull.before is None
        or pull.world_targets is None
        or len(pull.target_changes) != 1
    ):
        return False
    commit_pose(
        session, project, pull, pull.newest or replace(pull.before, targets=pull.world_targets)
    )
    return pull in project.pending


def _follow_copies(session: Session, pull: Pull, pose: Pose) -> None:
    """Update copied keys that hold an earlier pose of the drag."""
    kept, copied = pull.kept, session.clipboard.poses
    if kept is None or all(k.pose.phi is not kept.phi for c in copied for k in c.keys):
        return
    bring = pull.brought_to(pose)

    def follow(layer: Layer, key: Keyframe) -> Keyframe:
        return replace(key, pose=bring(layer, key.pose)) if key.pose.phi is kept.phi else key

    session.clipboard.change_keys(follow)


def _commit_first(session: Session, project: Project, pull: Pull, pose: Pose) -> bool:
    """Commit the first pose of a drag as a new undo step; return whether this succeeded."""
    if pull.layer not in project.layer_runtimes:
        return False
    layer = project.document.layer(pull.layer)
    if layer.domain is not pull.clip.layer.domain:
        return False
    frames = _frames_now(layer, pull)
    if not frames:
        return False
    pull.frame = pull.frame if pull.frame in frames else min(frames)
    pose = pull.brought_to(pose)(layer, with_all_targets(layer, pose))
    if not pull.is_keyed:
        unkeyed = PreviewPose(layer=pull.layer, frame=pull.frame, pose=pose)
        project.history.set_preview_pose(unkeyed, gesture=pull.gesture)
        return True
    for frame in frames:
        found = PreviewPose(layer=pull.layer, frame=frame, pose=pose)
        command = replace(
            key_pose_command(session, project, found),
            label=_("Move") if pull.translations else _("Pose"),
        )
        project.history.do(command, gesture=pull.gesture)
    left = project.history.preview_pose
    if left is not None and (left.layer, left.frame) == (pull.layer, pull.frame):
        project.history.set_preview_pose(None, gesture=pull.gesture)
    return True


def _frames_now(layer: Layer, pull: Pull) -> set[int]:
    """Return the present frames of a drag's pose.

    These are the frames of the dragged key and of its copies. For a new key it is the drag's frame.
    """
    then = pull.clip.layer
    if pull.frame not in then.key_frames:
        return {pull.frame}
    was = then.key(pull.frame).pose
    alike = {key.frame for key in layer.keys if key.pose.phi is was.phi}
    return (alike - then.key_frames) | ({pull.frame} & layer.key_frames)


def key_pose_command(session: Session, project: Project, unkeyed: PreviewPose) -> Command:
    """Return the command that sets the pose of the key at its frame, or inserts a key."""
    layer, frame, pose = unkeyed.layer, unkeyed.frame, unkeyed.pose
    if frame in project.document.layer(layer).key_frames:
        return key_commands.replace_key_pose(layer, frame, pose)
    return key_commands.insert_key(layer, frame, pose, easing=session.settings.preferences.easing)
