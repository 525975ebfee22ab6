"""Write solved poses to the document: as a key, or as an unkeyed preview pose without auto-key."""

from app.document import Command, Pose, PreviewPose, key_commands
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.drag_session import DragSession
from app.editor.work.jobs import JobKind
from app.texts import _

POSING = JobKind(_("Posing"), _("This pose could not be found"), "hand")


def drop_drag(session: Session, project: Project, drag: DragSession) -> None:
    """End a drag without a step; a result that is still computed is dropped."""
    _end_drag(session, project, drag)
    project.history.revert(drag.gesture)
    # The key that only the drag displayed may be selected.
    project.selection.keep_existing(project.document)


def _end_drag(session: Session, project: Project, drag: DragSession) -> None:
    if drag in project.pending.changes:
        project.pending.remove(drag)
        session.jobs.drop(POSING)


def commit_drag(session: Session, project: Project, drag: DragSession, pose: Pose) -> None:
    """End a drag with its final pose."""
    _end_drag(session, project, drag)
    preview_pose(project, drag, pose)
    project.history.settle()


def preview_pose(project: Project, drag: DragSession, pose: Pose) -> None:
    """Display the pose of a drag: as a key, or as the unkeyed pose without auto-key."""
    if drag.preview is pose:
        return
    history, drag.preview = project.history, pose
    if not drag.is_keyed:
        unkeyed = PreviewPose(layer=drag.layer, frame=drag.frame, pose=pose)
        history.set_preview_pose(unkeyed, gesture=drag.gesture)
        return
    command = key_commands.insert_pose(drag.layer, drag.frame, pose, drag.easing)
    label = _("Move") if drag.translations else _("Pose")
    history.do(Command(label, command.change), gesture=drag.gesture)
    left = history.preview_pose
    if left is not None and (left.layer, left.frame) == (drag.layer, drag.frame):
        history.set_preview_pose(None, gesture=drag.gesture)


def key_pose_command(session: Session, project: Project, unkeyed: PreviewPose) -> Command:
    """Return the command that sets the pose of the key at its frame, or inserts a key."""
    layer, frame, pose = unkeyed.layer, unkeyed.frame, unkeyed.pose
    if frame in project.document.layer(layer).key_frames:
        return key_commands.replace_key_pose(layer, frame, pose)
    return key_commands.insert_key(layer, frame, pose, easing=session.settings.preferences.easing)
