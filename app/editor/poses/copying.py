"""Copying poses and keys, and pasting them, as they are or onto the selected handles."""

from collections.abc import Mapping
from functools import partial

from app.document import Figure, Keyframe, Target
from app.editor.actions import posing
from app.editor.poses import putting
from app.editor.session import CopiedKeys, Session

COPYING = "Copying a pose"


def copy(session: Session) -> None:
    """Copy the chosen keys, or else the pose that is shown."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    keys = putting.shown_keys(project)
    if keys:
        _take(session, project.figure, keys)
    else:
        complaint = "The pose could not be copied"
        putting.find_pose(session, project, COPYING, complaint, partial(_take, session))


def _take(session: Session, figure: Figure, keys: tuple[Keyframe, ...]) -> None:
    session.copied = CopiedKeys(figure, keys)


def can_paste(session: Session) -> bool:
    """Tell whether what was copied is of the figure that is posed now."""
    project, copied = session.project, session.copied
    return (
        project is not None and copied is not None and copied.figure.domain is project.figure.domain
    )


def can_paste_on_selected(session: Session) -> bool:
    """Tell whether there are handles on which what was copied can be pasted."""
    return can_paste(session) and session.project is not None and bool(session.project.selected)


def paste(session: Session) -> None:
    """Let a key at the present frame hold what was copied; of several keys, the first one."""
    project, copied = session.project, session.copied
    if project is None or copied is None or not can_paste(session):
        return
    frame = putting.stand_at_frame(session, project)
    keys = putting.fitted(project, copied.keys, copied.figure.bounds)
    label = "Paste keys" if len(keys) > 1 else "Paste pose"
    putting.put(session, project, frame, keys, label=label)


def paste_on_selected(session: Session) -> None:
    """Let the selected handles go where they were in what was copied, and the shape follow."""
    if session.copied is not None and can_paste_on_selected(session):
        pull_selected(session, session.copied.keys[0].pose.targets)


def pull_selected(session: Session, targets: Mapping[int, Target]) -> None:
    """Wish the selected handles, as far as they are known, where a pose has them."""
    if session.project is None:
        return
    wishes = {i: targets[i] for i in session.project.selected if i in targets}
    if wishes:
        posing.wish(session, wishes)
