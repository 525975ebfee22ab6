"""What a panel is to the window."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from app.actions.action import Action
from app.session import Session
from app.ui.theme import Look


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Panel:
    """A dockable part of the window.

    Parameters
    ----------
    title : str
    icon : str
        In its tab; none where tabs are many.
    place : str
        Where it is docked at first.
    draw : callable
        Reads the session and returns what the person asked for.
    """

    title: str
    icon: str
    place: Literal["MainDockSpace", "side", "bottom"]
    draw: Callable[[Session, Look], list[Action]]

    @property
    def label(self) -> str:
        """The tab's text; its id is the title."""
        return f"{self.icon}  {self.title}###{self.title}" if self.icon else self.title
