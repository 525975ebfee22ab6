"""Tool that turns and scales several selected handles by a box around them."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import partial

from app.document import Target
from app.editor.actions.posing.pose_drag import drag_handles, release_drag_forced
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.tools.tool import handle_places, movable_handles
from app.editor.tools.transform_tools.box import BoxChange, TransformBox
from app.editor.tools.transform_tools.box_tool import BoxTool, finish_box, screen_axis
from app.editor.work.drag_session import DragStart
from engine.deform import BoundedPull

MARGIN = 1.5  # em: from the outer handles to the box


@dataclass(slots=True, kw_only=True, eq=False)
class HandleBoxTool(BoxTool):
    """The pointer turns and scales the selected handles that are not locked."""

    is_in_scene = False
    handles: frozenset[int] = field(init=False)

    def __post_init__(self) -> None:
        super(HandleBoxTool, self).__post_init__()
        self.handles = movable_handles(self.project)

    @classmethod
    def find_box(cls, session: Session, project: Project, em: float) -> TransformBox | None:
        is_idle = (
            session.tools.is_posing
            and session.tools.mode != "record"
            and session.display.overlays.handles
            and project.timeline.playhead.since is None
        )
        return find_handle_box(session, project, em) if is_idle else None

    def apply(self, session: Session) -> None:
        """Move the handles' targets with the box."""
        change = self.box.change(self.scale, self.turning.angle)
        handles = self.handles & {each.id for each in self.project.layer.handles}
        if handles:
            moved = partial(_targets_from_start, handles, change)
            drag_handles(session, moved, gesture=self, hand=BoundedPull(handles))

    def end(self, session: Session, place: complex) -> None:
        """Release the handles; forced targets stay beyond the handles' reach."""
        if session.tools.is_forcing_targets:
            release_drag_forced(session)
        super(HandleBoxTool, self).end(session, place)


def find_handle_box(session: Session, project: Project, em: float) -> TransformBox | None:
    """Return the box around the selected handles that are not locked, if there are several."""
    shown, chosen = project.layer_runtime.shown, movable_handles(project)
    places = [place for i, place in handle_places(project).items() if i in chosen]
    if shown is None or len(places) < 2:
        return None
    axis = screen_axis(session, project, shown)
    return finish_box(session, project, TransformBox.around(places, axis, MARGIN * em), em)


@with_project
def change_handles_by_key(session: Session, project: Project, turn: float, factor: float) -> None:
    """Turn the selected handles by an angle in radians, and scale them, around the pivot.

    Around a single handle, the shape turns.
    """
    box, handles = find_handle_box(session, project, 0.0), movable_handles(project)
    if box is not None:
        change = box.change(factor * (1 + 1j), turn)
        drag_handles(session, partial(_targets_further, handles, change))
    elif turn:
        drag_handles(session, partial(_turned_targets, handles, turn))


def _turned_targets(
    handles: frozenset[int], turn: float, start: DragStart, targets: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return the targets of handles with the shape turned there."""
    angles = {i: targets[i].rotation for i in handles & targets.keys()}
    return {
        i: replace(targets[i], rotation=(start.angles[i] if angle is None else angle) + turn)
        for i, angle in angles.items()
    }


def _targets_from_start(
    handles: frozenset[int], change: BoxChange, start: DragStart, targets: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return the targets of handles after a change of their places at the start of a drag."""
    at_start = {i: replace(targets[i], position=start.places[i]) for i in handles & targets.keys()}
    return _targets_further(handles, change, start, at_start)


def _targets_further(
    handles: frozenset[int], change: BoxChange, _: DragStart, targets: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return changed targets of handles; their angles turn, too."""
    return {
        i: replace(
            targets[i],
            position=change.apply(targets[i].position),
            rotation=None if (angle := targets[i].rotation) is None else angle + change.turn,
        )
        for i in handles & targets.keys()
    }
