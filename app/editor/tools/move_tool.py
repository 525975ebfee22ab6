"""Tool that moves a whole layer with its descendants."""

from dataclasses import dataclass
from typing import Self

from app.document import Layer
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.pose_drag import move_pose
from app.editor.layering.layer_selection import set_active_layer
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.tools.pose_tool import PoseTool
from app.editor.tools.tool import PointerHit, to_scene
from app.texts import _


@dataclass(slots=True, kw_only=True, eq=False)
class MoveTool(PoseTool):
    """The pointer moves a layer; `last` is the active layer before the press."""

    cursor = "move"
    last: int
    is_free: bool  # whether the layer can be moved

    @classmethod
    def mode(cls, session: Session, _project: Project) -> str:
        return _("Moving and turning whole layers") if session.tools.mode == "move" else ""

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if session.tools.mode == "move":
            root = _root_parent(session, project, spot.layer)
            if spot.on_gizmo or root.still or root.locked or spot.layer not in {None, root.id}:
                return ()
            return (Hint(_("drag to move {layer}").format(layer=root.name)),)
        return (Hint(_("drag to move the whole layer"), "ctrl+shift"),) if _is_beside(spot) else ()

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the layer under the pointer or, with keys beside the shape, the active layer."""
        is_by_keys = spot.ctrl and spot.shift and _is_beside(spot)
        if not is_by_keys and (spot.ctrl or session.tools.mode != "move"):
            return None
        start, last = to_scene(project, spot.place), project.selection.active
        is_free = _set_root_parent_active(
            session, project, spot.layer if session.tools.mode == "move" else None
        )
        return cls(project=project, start=start, last=last, is_free=is_free)

    def _pull(self, session: Session) -> None:
        if self.moved and self.is_free:
            move_pose(session, self.offset, gesture=self)

    def cancel(self, session: Session) -> None:
        """Undo the move, and make the earlier layer active."""
        set_active_layer(session, self.last)
        PoseTool.cancel(self, session)

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        return (Hint(_("type a number of pixels")), Hint(_("X or Y to lock to an axis")))


@named_action(
    _("Move whole drawing"),
    "V",
    icon="UP_DOWN_LEFT_RIGHT",
    hint=_("Move the whole layer in this frame, by drag or arrow keys"),
    active=lambda session: session.tools.mode == "move",
)
def toggle_move_tool(session: Session) -> None:
    """Select the move tool, or the pose tool if the move tool is selected."""
    if session.tools.active_tool is None:
        session.tools.toggle("move")


@named_action(
    _("Back to posing"),
    "Escape",
    why_disabled=unless(
        lambda session, _: not session.tools.is_posing,
        _("You are posing. No other tool is active."),
    ),
)
def return_to_posing(session: Session) -> None:
    """Select the pose tool; close a motion draft."""
    session.tools.select("pose")


@with_project
def nudge_layer(session: Session, project: Project, step: complex) -> None:
    """Move the active layer's topmost parent by `step` in pixels; its descendants follow."""
    if _set_root_parent_active(session, project, None):
        move_pose(session, step)


def _is_beside(spot: PointerHit) -> bool:
    return spot.handle is None and not (spot.on_shape or spot.on_gizmo)


def _root_parent(session: Session, project: Project, layer: int | None) -> Layer:
    """Return the topmost parent of a layer, by default of the active layer; or the layer itself."""
    frame = playback.current_frame(session, project)
    return project.document.parent_chain(
        project.selection.active if layer is None else layer, frame
    )[-1]


def _set_root_parent_active(session: Session, project: Project, layer: int | None) -> bool:
    """Make a layer's topmost parent active; if it cannot move, show why and return False."""
    root = _root_parent(session, project, layer)
    if root.still or root.locked:
        text = _("{layer} is locked and stays where it is. Unlock it in the Layers tab first.")
        if root.still:
            text = _("{layer} is a still picture and stays where it is. Make it posable first.")
        session.notices.show(text.format(layer=root.name))
        return False
    set_active_layer(session, root.id)
    return True
