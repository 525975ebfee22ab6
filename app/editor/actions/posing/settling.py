"""A pose that was let go, on its way to rest: the in-betweens of it as it is, and who has them."""

from app.document import Clip, Pose, clip_of
from app.editor.actions import playback
from app.editor.actions.posing.steps import POSING, end, follow, hold, holding
from app.editor.project import PoseInProgress, Project, Trial
from app.editor.session import Session


def settle(session: Session) -> None:
    """Follow the playhead that leaves a pose on its way to rest, or comes back; once a frame."""
    project = session.project
    settling = project.settling if project else None
    if project is None or settling is None:
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
    pose, trial = settling.prepared, settling.trial
    settling.prepared = None
    if pose is None and trial is not None:
        pose, settling.trial = trial.pose, None
        project.puppet.coarse.value = trial.motion
    if pose is None or settling.frame not in project.figure.key_frames:
        return
    newest = project.figure.key(settling.frame).pose
    if newest is not pose:
        settling.found, settling.taken = settling.found or newest, pose
        hold(session, project, settling.frame, pose, gesture=settling.gesture)


def next_trial(session: Session, project: Project) -> Trial | None:
    """Return the pose that was let go, as it is now, with what there is of its in-betweens.

    While some are missing it stays wanted, however far the solver goes on. None where all are
    there, and where nothing was let go.
    """
    moving = _let_go(session, project)
    if moving is None:
        return None
    if moving.trial is None:
        pose = moving.found
        if moving is project.posing and moving.frame in project.figure.key_frames:
            pose = project.figure.key(moving.frame).pose
        if pose is None or pose is moving.prepared:
            return None
        moving.trial = Trial(pose=pose, motion=project.puppet.coarse.value)
    return moving.trial


def trial_clip(session: Session, project: Project, pose: Pose) -> Clip | None:
    """Return the clip with a pose that was let go; None where nothing was."""
    moving = _let_go(session, project)
    if moving is None:
        return None
    command = holding(session, project, moving.frame, pose)
    return clip_of(command(project.document), project.active)


def take_trial(session: Session, project: Project, trial: Trial) -> None:
    """Take note of what was prepared; the document has the pose as soon as that is all of it."""
    if project is not session.project:
        return
    moving, clip = _let_go(session, project), trial_clip(session, project, trial.pose)
    if moving is None or clip is None:
        return
    coarse = project.puppet.coarse
    if moving is project.settling and trial.pose in [key.pose for key in project.figure.keys]:
        coarse.take(project.clip, trial.motion)
    elif moving.trial is not None and moving.trial.pose is trial.pose:
        if not trial.motion.knows(clip) and coarse.failure is None:
            moving.trial = trial
            return
        moving.trial = None
        coarse.take(clip, trial.motion)
        if moving is project.posing:
            moving.prepared = trial.pose
            return
        hold(session, project, moving.frame, trial.pose, gesture=moving.gesture)
        moving.taken = trial.pose
        if moving.found is trial.pose:
            moving.found = None


def _let_go(session: Session, project: Project) -> PoseInProgress | None:
    """Return the pose that was let go, and is on its way to rest in a key."""
    moving = project.settling or project.posing
    is_loose = moving is not None and not moving.is_held and session.preferences.auto_key
    return moving if is_loose else None
