"""Moving the whole layer as it is, and all that hangs on it."""

from dataclasses import dataclass
from typing import Self

from app.document import Layer
from app.editor import layering
from app.editor.actions import playback, posing, preset_setup
from app.editor.project import Project
from app.editor.session import Hint, Session, with_project
from app.editor.tools.pose_tool import PoseTool
from app.editor.tools.tool import PointerHit, to_scene


@dataclass(slots=True, kw_only=True, eq=False)
class Moving(PoseTool):
    """The pointer moves a layer; the last one was posed before it."""

    last: int
    is_free: bool  # whether the layer can be moved

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        """Tell what moves."""
        if session.moves:
            return (
                Hint("drag", f"to move all of {_root_parent(session, project, spot.layer).name}"),
            )
        return (Hint("drag", "to move all of it", "ctrl+shift"),) if _is_beside(spot) else ()

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Take hold of what is pressed with the tool in hand, or from beside it by keys."""
        is_by_keys = spot.ctrl and spot.shift and _is_beside(spot)
        if not is_by_keys and (spot.ctrl or not session.moves):
            return None
        start, last = to_scene(project, spot.place), project.active
        is_free = _set_root_parent_active(session, project, spot.layer if session.moves else None)
        return cls(project=project, start=start, last=last, is_free=is_free)

    def _pull(self, session: Session) -> None:
        if self.moved and self.is_free:
            posing.move_pose(session, self.offset, gesture=self)

    def cancel(self, session: Session) -> None:
        """Take it back, and pose what was posed before."""
        layering.set_active_layer(session, self.last)
        PoseTool.cancel(self, session)

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        """What can be done until it ends."""
        return (Hint("type", "a number of pixels"), Hint("X or Y", "to keep to an axis"))


@with_project
def toggle_move_tool(session: Session, project: Project) -> None:
    """Let drags and arrows move the whole layer, or pose it again."""
    if session.active_tool is None:
        in_hand = session.cutting, session.material, project.motion_setup
        is_other = any(each is not None for each in in_hand)
        session.moves = is_other or not session.moves
        session.cutting = session.material = project.motion_setup = None


@with_project
def return_to_posing(session: Session, project: Project) -> None:
    """Put away whatever is in hand instead of posing, a motion that is drafted among it."""
    session.cutting = session.material = None
    session.moves = False
    if project.motion_setup is not None:
        preset_setup.close_motion_setup(session)


@with_project
def nudge_layer(session: Session, project: Project, step: complex) -> None:
    """Move the layer that is posed, with all that it hangs on, by a few pixels."""
    if _set_root_parent_active(session, project, None):
        posing.move_pose(session, step)
        posing.release_drag(session)


def _is_beside(spot: PointerHit) -> bool:
    return spot.handle is None and not (spot.on_shape or spot.on_ring)


def _root_parent(session: Session, project: Project, layer: int | None) -> Layer:
    """Return what a layer, by default the one that is posed, hangs on in the end; or itself."""
    frame = playback.current_frame(session, project)
    return project.document.parent_chain(project.active if layer is None else layer, frame)[-1]


def _set_root_parent_active(session: Session, project: Project, layer: int | None) -> bool:
    """Choose what moves with all that hangs on it; tell why, and return False, if it stays."""
    carrier = _root_parent(session, project, layer)
    if carrier.still or carrier.locked:
        what = "a still picture" if carrier.still else "locked"
        session.show_notice(
            f"{carrier.name} is {what}: it stays where it is, with all that hangs on it."
        )
        return False
    layering.set_active_layer(session, carrier.id)
    return True
