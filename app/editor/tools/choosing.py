"""Choosing the layer to pose by a click on it."""

from dataclasses import dataclass
from typing import Self

from app.editor import layering
from app.editor.project import Project
from app.editor.session import Hint, Session
from app.editor.tools.tool import Spot, Tool


@dataclass(slots=True, kw_only=True, eq=False)
class Choosing(Tool):
    """The pointer has chosen a layer (not the last one); it does no more until it is let go."""

    last: int

    @classmethod
    def hints(cls, _: Session, project: Project, spot: Spot) -> tuple[Hint, ...]:
        """Tell which layer a click chooses."""
        figure = _other(project, spot)
        if figure is None:
            return ()
        return (Hint("click", f"to pose {project.document.figure(figure).name}"),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: Spot) -> Self | None:
        """Choose the layer that is seen there, if it is another one."""
        figure = _other(project, spot)
        if figure is None:
            return None
        choosing = cls(project=project, last=project.active)
        layering.choose(session, figure)
        return choosing

    def cancel(self, session: Session) -> None:
        """Go back to the layer that was posed."""
        layering.choose(session, self.last)


def _other(project: Project, spot: Spot) -> int | None:
    """Return the layer that a press at a spot is for, if it is not the one that is posed."""
    if spot.handle is not None or spot.on_ring or spot.ctrl or spot.shift:
        return None
    return None if spot.figure in {None, project.active} else spot.figure
