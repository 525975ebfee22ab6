"""Inserting keys of the poses that frames show."""

from collections.abc import Callable
from functools import partial

from app.document import Clip, Pose, PreviewPose, clip_of
from app.editor import pending_changes
from app.editor.actions import playback
from app.editor.actions.posing.pose_commit import key_pose_command
from app.editor.actions.posing.pose_solver import finish_drag
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.solving import Rig, fit_shown_pose
from app.texts import N_, _

IS_KEYED = N_("Frame {frame} already has a key. Drag a handle to change it.")
INSERTING = JobKind(_("Inserting a key"), _("The key could not be inserted"), "hand")


@with_project
def insert_key(session: Session, project: Project) -> None:
    """Insert a key of the shown pose at the present frame, in each selected layer."""
    playback.stop_playback(session)
    if project.selection.other_layers:
        here, gesture = playback.current_frame(session, project), object()
        chosen = [project.document.layer(each) for each in project.selected_layers]
        for layer in (each for each in chosen if not each.still):
            if (at := layer.source_of(here)) not in layer.key_frames:
                insert_key_at(session, layer.id, at, gesture)
        return
    insert_key_at(session, project.selection.active, playback.edited_frame(session, project))


@with_project
def insert_key_at(
    session: Session, project: Project, layer: int, frame: int, gesture: object | None = None
) -> None:
    """Insert a key of the pose of a layer at a frame; inserts of a gesture are one undo step."""
    if layer not in project.runtimes.layers:
        return
    finish_drag(session, project)
    unkeyed = project.history.preview_pose
    if unkeyed is not None and (unkeyed.layer, unkeyed.frame) == (layer, frame):
        gesture = gesture or object()
        project.history.do(key_pose_command(session, project, unkeyed), gesture=gesture)
        project.history.set_preview_pose(None, gesture=gesture)
    elif frame not in project.document.layer(layer).key_frames:
        clip = clip_of(project.document, layer)
        take = partial(_insert, session, project, clip, frame, gesture)
        solve_nearest_pose(session, project, clip, frame, take, kind=INSERTING)
    else:
        session.notices.show(_(IS_KEYED).format(frame=frame))


def solve_nearest_pose(
    session: Session,
    project: Project,
    clip: Clip,
    frame: int,
    take: Callable[[Pose], None],
    *,
    kind: JobKind,
) -> None:
    """Solve for the pose nearest to a clip's in-between at a frame, on the worker."""
    runtime = project.runtimes.layers[clip.layer.id]
    rig, sibling = Rig.of(clip.layer, runtime.rig), runtime.store.sampler

    def work() -> Pose:
        return fit_shown_pose(rig, clip, frame, sibling)

    pending_changes.begin_pending_change(session, project, kind, work, take)


def _insert(
    session: Session, project: Project, clip: Clip, frame: int, gesture: object | None, pose: Pose
) -> None:
    layer = clip.layer.id
    if layer in project.runtimes.layers and clip_of(project.document, layer) == clip:
        found = PreviewPose(layer=layer, frame=frame, pose=pose)
        project.history.do(key_pose_command(session, project, found), gesture=gesture)
        if project.selection.active == layer:
            project.selection.select_pose_key(frame)
    else:
        # Other keys changed meanwhile, so the layer's shown pose there has changed.
        insert_key_at(session, layer, frame, gesture)
