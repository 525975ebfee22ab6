"""Tools that select handles by a click or a box, and layers by a click."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from app.editor.actions import editing
from app.editor.layering.layer_list import is_layer_at
from app.editor.layering.layer_selection import set_active_layer
from app.editor.overlay_shapes import AreaShape, LineShape, OverlayShape
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.tool import PointerHit, Tool, to_scene
from app.motion import BoundingBox
from app.texts import _


@dataclass(slots=True, kw_only=True, eq=False)
class SelectTool(Tool):
    """The pointer spans a selection box, or has selected a handle by a click."""

    start: complex  # place of the press
    place: complex  # place of the pointer
    adds: bool  # whether earlier selected handles stay selected
    has_box: bool

    @classmethod
    def hints(cls, _session: Session, _project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        is_free = spot.handle is None and not spot.on_shape and not spot.on_gizmo
        return (Hint(_("drag to select")),) if is_free else ()

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Begin a box; with Shift on a handle, add it to the selection or remove it."""
        has_box, at = spot.handle is None, spot.place
        if spot.on_gizmo or not (has_box or spot.shift):
            return None
        selecting = cls(project=project, start=at, place=at, adds=spot.shift, has_box=has_box)
        if spot.handle is not None:
            fellows = project.layer.grouped_handles(spot.handle)
            is_selected = spot.handle in project.selection.handles
            chosen = (
                project.selection.handles - fellows
                if is_selected
                else project.selection.handles | fellows
            )
            editing.select_handles(session, chosen)
        return selecting

    def move(self, _: Session, place: complex) -> None:
        self.place = place

    def end(self, session: Session, place: complex) -> None:
        project, shown = self.project, self.project.layer_runtime.shown
        if shown is None or not self.has_box:
            return
        x, y = sorted((self.start.real, place.real)), sorted((self.start.imag, place.imag))
        box = BoundingBox(complex(x[0], y[0]), complex(x[1], y[1]))
        places = zip(shown.clip.layer.handles, shown.handle_positions, strict=True)
        inside = {
            handle.id
            for handle, at in places
            if box.contains(BoundingBox(complex(at), complex(at)), slack=0.0)
        }
        editing.select_handles(
            session, project.selection.handles | inside if self.adds else frozenset(inside)
        )

    def shapes(self, _place: complex, _em: float) -> Iterable[OverlayShape]:
        if not self.has_box:
            return ()
        low, high = self.start, self.place
        corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag)]
        return (
            AreaShape(points=corners, opacity=0.12),
            LineShape(points=corners, opacity=0.8, closed=True, width=0.07),
        )


@dataclass(slots=True, kw_only=True, eq=False)
class PickLayerTool(Tool):
    """A press makes another layer active; until the release it can be cancelled.

    Where the active layer is, covered or not, it takes a double click. Its first click may have
    added a handle, which is taken back.
    """

    last: int

    @classmethod
    def hints(cls, _session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        layer, double = pressed_other_layer(project, spot), replace(spot, is_double=True)
        covering = pressed_other_layer(project, double) if layer is None else layer
        if covering is None:
            return ()
        name = project.document.layer(covering).name
        text = _("double-click to pose {layer}") if layer is None else _("click to pose {layer}")
        return (Hint(text.format(layer=name)),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Make the visible layer at the place active, if it is another one."""
        layer, added = pressed_other_layer(project, spot), _added_by_click(project, spot)
        if added and spot.is_double and spot.layer not in {None, project.selection.active}:
            layer = spot.layer
            project.history.undo()
        if layer is None:
            return None
        choosing = cls(project=project, last=project.selection.active)
        set_active_layer(session, layer)
        return choosing

    def cancel(self, session: Session) -> None:
        """Make the earlier layer active again."""
        set_active_layer(session, self.last)


def pressed_other_layer(project: Project, spot: PointerHit) -> int | None:
    """Return the layer that a press selects, if it is not the active layer.

    Where the active layer is visible or covered, only a double click or Alt selects another one.
    """
    if spot.handle is not None or spot.on_gizmo or spot.ctrl or spot.shift:
        return None
    active = project.selection.active
    if spot.layer in {None, active}:
        return None
    goes_there = spot.alt or spot.is_double or not spot.on_shape
    if not goes_there and is_layer_at(project, active, to_scene(project, spot.place)):
        return None
    return spot.layer


def _added_by_click(project: Project, spot: PointerHit) -> bool:
    """Return whether the last step has added the handle at a place."""
    is_new = project.pose_edits.with_new_handles is project.document
    return is_new and spot.handle is not None and project.selection.handles == {spot.handle}
