"""Handles and the anchor: added, deleted and set, in the pose that no key holds as well."""

from dataclasses import replace

import numpy as np

from app.document import Command, figure_commands, handle_commands
from app.editor.actions.posing.pulling import drop
from app.editor.actions.posing.steps import retargeted
from app.editor.project import Project
from app.editor.session import Session
from app.motion import Shown


def add_handle(session: Session, place: complex, *, gesture: object | None = None) -> None:
    """Add a handle where the shape is at a place of the screen's plane; nothing moves."""
    project = session.project
    if project is None or project.puppet.shown is None:
        return
    drop(session)
    rest = _at_rest(project.puppet.shown, place)
    identity = project.figure.next_handle
    _change_handles(project, handle_commands.add_handle(project.active, rest), gesture or object())
    project.selected, project.chosen = frozenset({identity}), frozenset()


def remove_handles(
    session: Session, identities: frozenset[int], *, gesture: object | None = None
) -> None:
    """Delete handles; every pose stays as it is."""
    project = session.project
    if project is None:
        return
    drop(session)
    command = handle_commands.remove_handles(project.active, identities)
    _change_handles(project, command, gesture or object())
    project.selected -= identities


def _change_handles(project: Project, command: Command, gesture: object) -> None:
    """Add or delete handles, in the pose that no key holds as well."""
    project.history.do(command, gesture=gesture)
    unkeyed = project.history.unkeyed
    if unkeyed is not None:
        pose = retargeted(project.figure, unkeyed.pose)
        project.history.pose(replace(unkeyed, pose=pose), gesture=gesture)


def anchor_at(session: Session, identity: int, *, gesture: object | None = None) -> None:
    """Make a handle's point the anchor, or let the engine choose again if it is already."""
    project = session.project
    if project is None:
        return
    place = project.figure.handle(identity).position
    project.history.do(
        figure_commands.set_anchor(
            project.active, None if project.figure.anchor == place else place
        ),
        gesture=gesture,
    )


def put_anchor(session: Session, place: complex, *, gesture: object | None = None) -> None:
    """Make the shape's point at a place of the screen's plane the anchor."""
    project = session.project
    if project and project.puppet.shown:
        rest = _at_rest(project.puppet.shown, place)
        project.history.do(figure_commands.set_anchor(project.active, rest), gesture=gesture)


def _at_rest(shown: Shown, place: complex) -> complex:
    """Return where the point that is shown at a place is in the drawing at rest."""
    found = shown.mesh.locate(np.array([place]), shown.positions)
    return complex(found.on(shown.mesh.domain.mesh.vertices)[0])
