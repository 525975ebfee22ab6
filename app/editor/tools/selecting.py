"""Selecting handles, one by one or by a box."""

from dataclasses import dataclass
from typing import Self

from app.editor.actions import editing
from app.editor.session import BoxMark, Hint, Mark, Session
from app.editor.tools.tool import Selection, Spot, take_back
from app.motion import Box


@dataclass(slots=True, kw_only=True, eq=False)
class Selecting:
    """The pointer spans a box to select what is in it, or has selected a handle by a click.

    Parameters
    ----------
    start, place : complex
        Where it was pressed, and where it is.
    before : Selection
    adds : bool
        Whether what was selected stays so.
    has_box : bool
    """

    start: complex
    place: complex
    before: Selection
    adds: bool
    has_box: bool

    @classmethod
    def hints(cls, session: Session, spot: Spot) -> tuple[Hint, ...]:  # noqa: ARG003 - as a tool's
        """Tell that dragging beside the shape selects."""
        is_free = spot.handle is None and not spot.on_shape and not spot.on_ring
        return (Hint("drag", "to select"),) if is_free else ()

    @classmethod
    def press(cls, session: Session, spot: Spot) -> Self | None:
        """Begin a box; with Shift, on a handle, select it beside the others or not any more."""
        project = session.project
        if project is None or spot.on_ring:
            return None
        has_box = spot.handle is None
        if not (has_box or spot.shift):
            return None
        before = Selection.of(project)
        if spot.handle is not None:
            fellows = project.figure.together_with(spot.handle)
            is_selected = spot.handle in project.selected
            chosen = project.selected - fellows if is_selected else project.selected | fellows
            editing.select(session, chosen)
        return cls(
            start=spot.place, place=spot.place, before=before, adds=spot.shift, has_box=has_box
        )

    def move(self, session: Session, place: complex) -> None:  # noqa: ARG002 - as a tool's
        """Span the box up to the pointer."""
        self.place = place

    def type(self, session: Session, characters: str) -> None:
        """Take nothing."""

    def end(self, session: Session, place: complex) -> None:
        """Select what is in the box."""
        project = session.project
        shown = project.puppet.shown if project else None
        if project is None or shown is None or not self.has_box:
            return
        x, y = sorted((self.start.real, place.real)), sorted((self.start.imag, place.imag))
        box = Box(complex(x[0], y[0]), complex(x[1], y[1]))
        places = zip(shown.clip.figure.handles, shown.handle_places, strict=True)
        inside = {
            handle.id
            for handle, at in places
            if box.contains(Box(complex(at), complex(at)), slack=0.0)
        }
        editing.select(session, project.selected | inside if self.adds else frozenset(inside))

    def cancel(self, session: Session) -> None:
        """Select what was selected before."""
        take_back(session, self, self.before)

    @property
    def marks(self) -> tuple[Mark, ...]:
        """The box."""
        return (BoxMark(corner=self.start, opposite=self.place),) if self.has_box else ()

    @property
    def ways(self) -> tuple[Hint, ...]:
        """Return what can be done until it ends."""
        return ()
