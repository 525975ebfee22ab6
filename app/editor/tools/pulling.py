"""Posing by hand: handles are added where the shape is pressed, and pulled."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Self

from app.document import Target
from app.editor.actions import editing, posing
from app.editor.project import Project
from app.editor.session import EntryMark, Hint, Mark, Session
from app.editor.tools.entry import TypedWay
from app.editor.tools.tool import Spot, Tool
from app.editor.work import Start
from engine.deform import Hand


@dataclass(slots=True, kw_only=True, eq=False)
class Pulling(Tool):
    """The pointer pulls handles."""

    start: complex  # where it was pressed
    handles: frozenset[int] = frozenset()  # those that are pulled, by id
    taken: int | None = None  # the one that was there already under the pointer
    at_target: bool = False  # whether they are pulled from where they are wanted
    entry: TypedWay = field(default_factory=TypedWay)  # what is typed meanwhile
    place: complex | None = None  # where it is; None before it has moved
    moved: bool = False  # whether it has gone farther than a click may, or a way was typed

    @classmethod
    def hints(cls, session: Session, project: Project, spot: Spot) -> tuple[Hint, ...]:
        """Tell that handles are dragged, and that a click adds one."""
        if spot.handle is not None:
            if project.figure.is_locked(spot.handle):
                return (Hint("click", "to select; it is locked"),)
            return (Hint("drag", "to pose"),)
        if spot.on_shape and session.overlays.handles and not spot.on_ring:
            return (Hint("click", "to add a handle"),)
        return ()

    @classmethod
    def press(cls, session: Session, project: Project, spot: Spot) -> Self | None:
        """Take hold of a handle and of all that are selected with it, or of a new one."""
        if spot.ctrl or spot.shift or spot.on_ring:
            return None
        if spot.handle is not None:
            if spot.alt:
                return None
            pulling = cls(
                project=project, start=spot.place, taken=spot.handle, at_target=spot.at_target
            )
            if spot.handle not in project.selected:
                editing.select(session, project.figure.together_with(spot.handle))
            pulling.handles = _movable(project)
            return pulling
        if not spot.on_shape or not session.overlays.handles:
            return None
        pulling = cls(project=project, start=spot.place)
        posing.add_handle(session, spot.place, gesture=pulling)
        pulling.handles = project.selected
        return pulling

    def move(self, session: Session, place: complex) -> None:
        """Pull the handles as far as the pointer goes; each keeps the turn that it wishes."""
        self.place = place
        self.moved = self.moved or self.is_away(session, self.start, place)
        self._pull(session)

    def type(self, session: Session, characters: str) -> None:
        """Pull them as far as is typed, or along an axis."""
        self.entry.type(characters)
        self.moved = self.moved or self.entry.value is not None
        self._pull(session)

    @property
    def way(self) -> complex:
        """How far the pointer has come, or what was typed in place of that."""
        return self.entry.way((self.start if self.place is None else self.place) - self.start)

    def _pull(self, session: Session) -> None:
        pulled = self.handles & {handle.id for handle in self.project.figure.handles}
        if not (self.moved and pulled):
            return
        way = self.way

        def as_far(start: Start, targets: Mapping[int, Target]) -> Mapping[int, Target]:
            wanted = {i: target.position for i, target in start.targets.items()}
            places = wanted if self.at_target else start.places
            known = pulled & targets.keys()
            return {i: replace(targets[i], position=places[i] + way) for i in known}

        posing.pull(session, as_far, gesture=self, hand=Hand(pulled))

    def end(self, session: Session, _: complex) -> None:
        """Let the handles go where they have come to, or keep the wish.

        A click selects the one that it was on alone, or its group.
        """
        if session.insists:
            posing.insist(session)
        else:
            posing.let_go(session)
        if not self.moved and self.taken is not None:
            editing.select(session, self.project.figure.together_with(self.taken))

    @property
    def marks(self) -> tuple[Mark, ...]:
        """What was typed; else nothing: the handles show it."""
        entry = self.entry
        if not (entry.text or entry.axis):
            return ()
        text = entry.words("px")
        return (EntryMark(place=self.start, direction=entry.direction, text=text),)

    @property
    def ways(self) -> tuple[Hint, ...]:
        """What can be done until it ends."""
        return (
            Hint("type", "a number of pixels"),
            Hint("X or Y", "to keep to an axis"),
            Hint("let go", "to keep the wish beyond its reach", "alt"),
        )


def _movable(project: Project) -> frozenset[int]:
    """Return the selected handles but those that are locked."""
    handles = project.figure.handles
    return frozenset(h.id for h in handles if h.id in project.selected and not h.locked)
