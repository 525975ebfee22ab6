"""Copying poses and keys, and pasting them, as they are or onto the selected handles."""

from collections.abc import Mapping, Sequence
from functools import partial

from app.document import Figure, Keyframe, Pose, Target
from app.editor import promises
from app.editor.action import do
from app.editor.actions import playback, posing
from app.editor.poses import putting
from app.editor.project import Project
from app.editor.session import CopiedKeys, Session, with_project
from app.editor.work import Kind

COPYING = Kind("Copying a pose", "The pose could not be copied", "hand")


@with_project
def copy(session: Session, project: Project) -> None:
    """Copy the pose at the playhead or, in the timeline, the keys that are chosen there."""
    if copies_keys(session, project):
        copy_keys(session)
    else:
        frame = playback.current_frame(session, project)
        putting.take_pose(session, project, COPYING, partial(_copy, session, frame))


def copies_keys(session: Session, project: Project) -> bool:
    """Tell whether keys would be copied, and not the pose at the playhead."""
    return session.in_timeline and bool(project.chosen_of)


@with_project
def copy_keys(session: Session, project: Project) -> None:
    """Copy the chosen keys; poses on their way come to rest in the copies, too."""
    figures = [(project.document.figure(i), at) for i, at in project.chosen_of.items()]
    keys = [CopiedKeys(figure, tuple(map(figure.key, sorted(at)))) for figure, at in figures]
    _take(session, keys)


def _copy(session: Session, frame: int, figure: Figure, pose: Pose) -> None:
    _take(session, [CopiedKeys(figure, (Keyframe(frame=frame, pose=pose),))])


def _take(session: Session, copied: Sequence[CopiedKeys]) -> None:
    session.copied = tuple(copied)
    first, *more = (key for each in copied for key in each.keys)
    what = f"{1 + len(more)} keys" if more else f"Pose at frame {first.frame}"
    session.tell(f"{what} copied.", topic="copy")


def copied_for(session: Session, project: Project) -> Mapping[int, CopiedKeys]:
    """Return what was copied of each figure, by the id of that on which it can be pasted.

    Keys of several figures go to those that they are of, keys of one to that which is posed.
    """
    copied = session.copied
    if len(copied) > 1:
        domains = {figure.id: figure.domain for figure in project.document.figures}
        return {
            each.figure.id: each
            for each in copied
            if domains.get(each.figure.id) is each.figure.domain
        }
    if copied and copied[0].figure.domain is project.figure.domain:
        return {project.active: copied[0]}
    return {}


def copied_here(session: Session, project: Project) -> CopiedKeys | None:
    """Return what was copied for the figure that is posed, None where that is nothing."""
    return copied_for(session, project).get(project.active)


def copied_for_selected(session: Session, project: Project) -> CopiedKeys | None:
    """Return what was copied for the figure that is posed, if handles of it are selected."""
    return copied_here(session, project) if project.selected else None


@with_project
def paste(session: Session, project: Project) -> None:
    """Put what was copied into a key at the present frame: of several keys, the first one."""
    frame = putting.stand_at_frame(session, project)
    promises.once_settled(session, do(_paste, frame), "Paste")


@with_project
def _paste(session: Session, project: Project, frame: int) -> None:
    copied = copied_for(session, project)
    if not copied:
        return
    keys = {
        figure: putting.fitted(project, figure, each.keys, each.figure.bounds)
        for figure, each in copied.items()
    }
    putting.put(session, project, frame, keys)


@with_project
def paste_on_selected(session: Session, project: Project) -> None:
    """Let the selected handles go where they were in what was copied, and the shape follow."""
    copied = copied_for_selected(session, project)
    if copied is not None:
        pull_selected(session, project, copied.keys[0].pose.targets)


def pull_selected(session: Session, project: Project, targets: Mapping[int, Target]) -> None:
    """Wish the selected handles, as far as they are known, where a pose has them."""
    wishes = {i: targets[i] for i in project.selected if i in targets}
    if wishes:
        posing.wish(session, wishes)
