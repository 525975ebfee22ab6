"""A pose that was let go, on its way to rest: the in-betweens of it as it is, and who has them."""

from collections.abc import Sequence

from app.document import Clip, clip_of
from app.editor.actions import playback
from app.editor.actions.posing.steps import POSING, end, follow, hold, holding
from app.editor.project import PoseInProgress, Project
from app.editor.session import Session


def settle(session: Session) -> None:
    """Follow the playhead that leaves a pose on its way to rest, or comes back; once a frame."""
    project = session.project
    if project is None:
        return
    _take_tried(session, project)
    settling = project.settling
    if settling is None:
        return
    if not settling.is_left:
        settling.is_left = True
        _step_back(session, project, settling)
    is_here = playback.current_frame(session, project) == settling.frame
    if is_here and project.playhead.since is None:
        if settling.found is not None:
            hold(session, project, settling.frame, settling.found, gesture=settling.gesture)
        settling.found, settling.is_left = None, False
        project.posing, project.settling = settling, None
    if settling.is_paused:
        follow(session, project, settling)
    elif settling.found is None and POSING not in session.jobs.kinds:
        end(project, settling)


def _step_back(session: Session, project: Project, settling: PoseInProgress) -> None:
    """Let the document have the newest pose with in-betweens, as long as the solver's has none."""
    pose = settling.prepared or settling.trial
    settling.prepared = settling.trial = None
    if pose is None or settling.frame not in project.figure.key_frames:
        return
    newest = project.figure.key(settling.frame).pose
    if newest is not pose:
        settling.found, settling.taken = settling.found or newest, pose
        hold(session, project, settling.frame, pose, gesture=settling.gesture)


def tried_clips(session: Session, project: Project) -> Sequence[Clip]:
    """Return the clip with the pose that was let go, as it is while its in-betweens are prepared.

    While some are missing it stays wanted, however far the solver goes on. None where all are
    there, and where nothing was let go.
    """
    moving = _let_go(session, project)
    if moving is None:
        return ()
    if moving.trial is None:
        pose = moving.found
        if moving is project.posing and moving.frame in project.figure.key_frames:
            pose = project.figure.key(moving.frame).pose
        if pose is None or pose is moving.prepared:
            return ()
        moving.trial = pose
    command = holding(session, project, moving.frame, moving.trial)
    return (clip_of(command(project.document), project.active),)


def _take_tried(session: Session, project: Project) -> None:
    """Let the document have the pose whose in-betweens are all there, if it was left."""
    moving, store = _let_go(session, project), project.puppet.store
    clips = tried_clips(session, project)
    if moving is None or moving.trial is None:
        return
    if not any(store.has(clip) or store.has_failed(clip) for clip in clips):
        return
    pose, moving.trial = moving.trial, None
    if moving is project.posing:
        moving.prepared = pose
        return
    hold(session, project, moving.frame, pose, gesture=moving.gesture)
    moving.taken = pose
    if moving.found is pose:
        moving.found = None


def _let_go(session: Session, project: Project) -> PoseInProgress | None:
    """Return the pose that was let go, and is on its way to rest in a key."""
    moving = project.settling or project.posing
    is_loose = moving is not None and not moving.is_held and session.preferences.auto_key
    return moving if is_loose else None
