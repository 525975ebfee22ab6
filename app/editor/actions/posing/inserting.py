"""Keys of what the present frame shows."""

from collections.abc import Callable
from functools import partial

from app.document import Clip, Pose
from app.editor.actions import playback
from app.editor.actions.posing.pulling import drop
from app.editor.actions.posing.steps import hold, inserting
from app.editor.failures import report
from app.editor.jobs import Job
from app.editor.project import Project
from app.editor.session import Session
from app.solving import Rig, pose_at

INSERTING = "Inserting a key"


def insert_key(session: Session) -> None:
    """Hold the pose that is shown in a key at the present frame."""
    project = session.project
    if project is None:
        return
    drop(session)
    frame = playback.current_frame(session, project)
    playback.halt(session)
    if project.unkeyed is not None:
        hold(session, project, frame, project.unkeyed, gesture=object())
    elif frame not in project.figure.key_frames:
        complaint = "The key could not be inserted"
        fit_pose(session, project, INSERTING, complaint, partial(_insert, session, project))
    else:
        session.tell(f"Frame {frame} has a key already. Drag a handle to change it.")


def fit_pose(
    session: Session,
    project: Project,
    kind: str,
    complaint: str,
    take: Callable[[Clip, int, Pose], None],
) -> None:
    """Let the worker find the pose that is nearest to what the present frame shows."""
    clip, frame = project.clip, playback.current_frame(session, project)
    rig, sibling = Rig.of(clip.figure, project.puppet.rig), project.puppet.store.sampler
    session.jobs.put(
        Job(
            kind=kind,
            work=lambda: pose_at(rig, clip, frame, sibling),
            done=lambda pose: take(clip, frame, pose),
            failed=lambda error: report(session, complaint, error),
            lane="hand",
        )
    )


def _insert(session: Session, project: Project, clip: Clip, frame: int, pose: Pose) -> None:
    if project is session.project and project.clip == clip:
        project.history.do(inserting(session, project, frame, pose))
        project.chosen = frozenset({frame})
