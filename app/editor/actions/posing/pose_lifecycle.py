"""The life of drags until they rest: when their poses are committed to the document."""

from collections.abc import Sequence

from app.document import Clip, clip_of, with_replaced_pose
from app.editor.actions.posing.pose_commit import commit_pose
from app.editor.actions.posing.pose_solver import is_drag_at_playhead, step_pose_solver
from app.editor.project import Project
from app.editor.session import Session
from app.editor.work.pull import Pull

MOST_UNSEEN = 8  # most undone drags that are still solved, in case they are redone


def update_pose_drags(session: Session, project: Project) -> None:
    """Commit the results of all drags; once a frame."""
    for pull in project.pulls:
        _follow_key(project, pull)
        if pull.newest is not None and pull.is_in(project.history):
            _commit_newest(
                session, project, pull, is_here=is_drag_at_playhead(session, project, pull)
            )
        if pull.is_settled and not pull.is_held and pull in project.pending:
            project.pending.remove(pull)
    unseen = [pull for pull in project.pulls if not pull.is_in(project.history)]
    for pull in unseen:
        # An undone drag shows no in-betweens; it waits for the solver only.
        if pull.newest is not None:
            commit_pose(session, project, pull, pull.newest)
    for pull in unseen[:-MOST_UNSEEN]:
        if pull in project.pending:
            project.pending.remove(pull)
    step_pose_solver(session, project)


def _commit_newest(session: Session, project: Project, pull: Pull, *, is_here: bool) -> None:
    """Commit the newest pose of a drag at the playhead.

    At another frame, commit the newest pose with prepared in-betweens. The in-betweens shown
    meanwhile stay exact while the pose comes to rest.
    """
    newest = pull.newest
    if newest is None:
        return
    if is_here:
        pull.is_left = False
        commit_pose(session, project, pull, newest)
    elif not pull.is_left:
        pull.is_left, pull.is_held = True, False
        if pull.ready is not None:
            commit_pose(session, project, pull, pull.ready)
    if pull.is_held:
        pull.tried = None
        return
    clip = _candidate_clip(project, pull)
    if clip is not None and _has_inbetweens(project, clip):
        pull.ready, pull.tried = pull.tried, None
    if pull.tried is None and newest not in (pull.ready, pull.kept if not is_here else None):
        pull.tried = newest
    # In-betweens of still pictures are never prepared.
    layers = project.document.layers
    is_still = any(layer.id == pull.layer and layer.still for layer in layers)
    if not is_here and pull.is_at_rest and (is_still or project.deferred):
        commit_pose(session, project, pull, newest)
    elif not is_here and pull.ready is not None:
        commit_pose(session, project, pull, pull.ready)


def candidate_clips(project: Project, *, left: bool = False) -> Sequence[Clip]:
    """Return clips with poses that are not committed yet, to prepare their in-betweens.

    With `left`, return only clips of drags at other frames than the playhead's.
    """
    tried = (_candidate_clip(project, pull) for pull in project.pulls if pull.is_left or not left)
    return [clip for clip in tried if clip is not None]


def commit_all_poses(session: Session, project: Project) -> None:
    """Commit the newest pose of each drag, before the program may end."""
    for pull in project.pulls:
        if pull.newest is not None:
            commit_pose(session, project, pull, pull.newest)


def _candidate_clip(project: Project, pull: Pull) -> Clip | None:
    if pull.tried is None or pull.kept is None or pull.layer not in project.layer_runtimes:
        return None
    source = (project.document, pull.kept, pull.tried)
    if not pull.trial.follows(source):
        document = with_replaced_pose(project.document, pull.kept, pull.brought_to(pull.tried))
        pull.trial.set(source, clip_of(document, pull.layer))
    return pull.trial.value


def _has_inbetweens(project: Project, clip: Clip) -> bool:
    """Return whether all in-betweens of a clip exist or have failed."""
    store = project.layer_runtimes[clip.layer.id].store
    return store.has(clip) or store.has_failed(clip)


def _follow_key(project: Project, pull: Pull) -> None:
    """Update a drag's frame after its key has moved."""
    if pull.kept is None or pull.layer not in project.layer_runtimes:
        return
    keys = project.document.layer(pull.layer).keys
    frames = [key.frame for key in keys if key.pose.phi is pull.kept.phi]
    if frames and pull.frame not in frames:
        pull.frame = frames[0]
