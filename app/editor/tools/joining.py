"""Hanging the layer that is posed on another one, by a drag from its anchor."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from app.editor import layering
from app.editor.project import Project
from app.editor.session import Hint, JointMark, Mark, Session
from app.editor.tools.anchoring import Anchoring
from app.editor.tools.choosing import Choosing
from app.editor.tools.pulling import Pulling
from app.editor.tools.tool import Spot, is_away

FREE_HAND = (Choosing, Pulling, Anchoring)


@dataclass(slots=True, kw_only=True, eq=False)
class Joining:
    """The pointer holds the anchor of a layer over the one that it is to hang on.

    Parameters
    ----------
    spot : Spot
        Where it was pressed.
    child : int
    names : mapping of int to str
        Of the layers.
    place : complex
        Where it is.
    parent : int, optional
        The layer there.
    is_circle : bool
        Whether that one hangs on the child.
    moved : bool
        Whether it has gone farther than a click may.
    """

    spot: Spot
    child: int
    names: dict[int, str]
    place: complex
    parent: int | None = None
    is_circle: bool = False
    moved: bool = False

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:
        """Tell that the anchor is dragged."""
        if _scene(session, spot) is None:
            return ()
        what = "to hang it on another layer"
        return (Hint("drag", what) if spot.handle is None else Hint("drag", what, "ctrl"),)

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Take hold of the anchor; where a handle is the anchor, with Ctrl."""
        project = _scene(session, spot)
        if project is None or (spot.handle is not None and not spot.ctrl):
            return None
        names = {figure.id: figure.name for figure in project.document.figures}
        return cls(spot=spot, child=project.active, names=names, place=spot.place)

    def move(self, session: Session, place: complex) -> None:
        """Look which layer is under the pointer."""
        project = session.project
        self.place = place
        self.moved = self.moved or is_away(session, self.spot.place, place)
        if project is None or not self.moved or project.active != self.child:
            return
        on_scene = _on_scene(project, place)
        self.parent = layering.figure_at(project, on_scene, besides=self.child)
        self.is_circle = self.parent is not None and layering.hangs_on(
            project, self.parent, self.child
        )

    def type(self, session: Session, characters: str) -> None:
        """Take nothing."""

    def end(self, session: Session, place: complex) -> None:
        """Hang the layer on the one under the pointer; what was only clicked is for another."""
        self.move(session, place)
        project = session.project
        if not self.moved:
            spot = replace(self.spot, on_anchor=False)
            gestures = (tool.press(session, spot) for tool in FREE_HAND)
            gesture = next((each for each in gestures if each is not None), None)
            if gesture is not None:
                gesture.end(session, place)
        elif project is not None and self.parent is not None:
            joint = project.document.figure(self.child).attachment
            turns = joint is None or joint.turns
            # On both of them the joint is just there; else by the anchor.
            there = _on_scene(project, place)
            is_on_both = layering.is_at(project, self.child, there)
            layering.hang(session, self.child, self.parent, turns, there if is_on_both else None)
        else:
            session.tell("Let the anchor go over another layer to hang it there.", topic="joint")

    def cancel(self, session: Session) -> None:
        """Leave it as it was: nothing is done before the end."""

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The way to the pointer, and the layer under it."""
        if not self.moved:
            return ()
        return (
            JointMark(
                start=self.spot.place,
                end=self.place,
                parent=self.parent,
                is_refused=self.is_circle,
            ),
        )

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Tell what letting go does here."""
        if self.parent is None:
            return (Hint("go", "over the layer to hang it on"),)
        if self.is_circle:
            what = f"hangs on {self.names[self.child]} itself, so that it cannot carry it"
            return (Hint(self.names[self.parent], what),)
        what = f"to hang {self.names[self.child]} on {self.names[self.parent]}"
        return (Hint("let go", what),)


def _scene(session: Session, spot: Spot) -> Project | None:
    """Return the project, if it has several layers and the pointer is on the anchor of one."""
    project = session.project
    is_held = spot.shift or spot.alt or spot.on_ring
    if project is None or not spot.on_anchor or is_held or not session.overlays.handles:
        return None
    return project if len(project.document.figures) > 1 else None


def _on_scene(project: Project, place: complex) -> complex:
    """Return where a place of the layer by itself is in the scene."""
    shown = project.puppet.shown
    return place if shown is None else complex(shown.placement.on(np.array([place]))[0])
