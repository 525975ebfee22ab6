"""Joints of a motion by hand: each is dragged to where it belongs, or left out by a click."""

from dataclasses import dataclass
from typing import Self

from app.editor.actions import placing
from app.editor.project import Project
from app.editor.session import Hint, Session
from app.editor.tools.tool import Spot, Tool
from app.editor.work import MotionDraft

REACH = 14.0  # pixels of the screen: a joint so near to the pointer is meant


@dataclass(slots=True, kw_only=True, eq=False)
class Jointing(Tool):
    """The pointer drags a joint; with Alt held a click leaves it out."""

    name: str
    start: complex
    draft: MotionDraft  # as it was before
    is_drag: bool = False

    @classmethod
    def hints(cls, session: Session, project: Project, spot: Spot) -> tuple[Hint, ...]:
        """Tell what is done with a joint."""
        name = pointed(session, project, spot.place)
        if name is None:
            return (Hint("drag", "each joint to where it belongs"),)
        return (Hint("drag", f"{name} to where it belongs"), Hint("click", "leaves it out", "alt"))

    @classmethod
    def press(cls, session: Session, project: Project, spot: Spot) -> Self | None:
        """Take hold of a joint, or leave it out."""
        name, draft = pointed(session, project, spot.place), project.draft
        if draft is None:
            return None
        if name is None:
            placing.choose(session, None)
            return None
        if spot.alt:
            placing.leave_out(session, name)
            return None
        placing.choose(session, name)
        return cls(project=project, name=name, start=spot.place, draft=draft)

    def move(self, session: Session, place: complex) -> None:
        """Let the joint follow the pointer, on the drawing."""
        self.is_drag = self.is_drag or self.is_away(session, self.start, place)
        if self.is_drag and self.project.draft is not None:
            self.project.draft = self.draft
            placing.put_shown(session, self.name, place)

    def end(self, session: Session, place: complex) -> None:
        """Leave it where the pointer is."""
        self.move(session, place)

    def cancel(self, _: Session) -> None:
        """Put the joint back."""
        if self.project.draft is not None:
            self.project.draft = self.draft

    @property
    def ways(self) -> tuple[Hint, ...]:
        """What can be done until it ends."""
        return (Hint("let go", "where it belongs"),)


def pointed(session: Session, project: Project, place: complex) -> str | None:
    """Return the joint that is nearest to a place, if it is near enough."""
    reach = REACH / project.view(session.screen).scale
    away = {name: abs(at - place) for name, at in placing.shown_joints(project).items()}
    nearest = min(away, key=away.__getitem__, default=None)
    return nearest if nearest is not None and away[nearest] <= reach else None
