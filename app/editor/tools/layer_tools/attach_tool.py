"""Tool that attaches the active layer to a parent, by a drag from its anchor."""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Self

from app.editor.actions import playback
from app.editor.layering.layer_list import is_layer_at, layer_at
from app.editor.layering.parenting import attach_layer, is_same_or_descendant
from app.editor.overlay_shapes import CircleShape, ColourRole, LineShape, OverlayShape
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.anchor_tool import AnchorTool
from app.editor.tools.pose_tool import PoseTool
from app.editor.tools.select_tools import PickLayerTool
from app.editor.tools.tool import PointerHit, Tool, scene_outlines, to_scene
from app.texts import _

FREE_HAND = (PickLayerTool, PoseTool, AnchorTool)


@dataclass(slots=True, kw_only=True, eq=False)
class AttachTool(Tool):
    """The pointer drags the anchor of a layer onto its new parent."""

    spot: PointerHit  # place of the press
    child: int
    names: dict[int, str]  # names of the layers
    place: complex  # place of the pointer
    parent: int | None = None  # the layer under the pointer
    is_circle: bool = False  # whether that layer is a descendant of the child
    moved: bool = False  # whether the pointer has moved farther than in a click

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        if not _takes_anchor(session, project, spot):
            return ()
        text = _("drag to attach it to another layer")
        return (Hint(text) if spot.handle is None else Hint(text, "ctrl"),)

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the anchor; if a handle is the anchor, only with Ctrl."""
        if not _takes_anchor(session, project, spot) or (spot.handle is not None and not spot.ctrl):
            return None
        names = {layer.id: layer.name for layer in project.document.layers}
        child = project.selection.active
        return cls(project=project, spot=spot, child=child, names=names, place=spot.place)

    def move(self, session: Session, place: complex) -> None:
        """Find the layer under the pointer."""
        project = self.project
        self.place = place
        self.moved = self.moved or self.is_away(session, self.spot.place, place)
        if self.moved and project.selection.active == self.child:
            there = to_scene(project, place)
            self.parent = parent = layer_at(project, there, besides=self.child)
            self.is_circle = parent is not None and is_same_or_descendant(
                project, parent, self.child
            )

    def end(self, session: Session, place: complex) -> None:
        """Attach the layer to the layer under the pointer; a mere click passes to the next tool."""
        self.move(session, place)
        project = self.project
        if not self.moved:
            spot = replace(self.spot, on_anchor=False)
            gestures = (tool.press(session, project, spot) for tool in FREE_HAND)
            gesture = next((each for each in gestures if each is not None), None)
            if gesture is not None:
                gesture.end(session, place)
        elif self.parent is not None:
            frame = playback.current_frame(session, project)
            joint = project.document.layer(self.child).attachment_key_at(frame)
            turns = joint is None or joint.inherits_rotation
            # If the place is on both layers, it is the joint; otherwise the anchor is.
            there = to_scene(project, place)
            is_on_both = is_layer_at(project, self.child, there)
            attach_layer(session, self.child, self.parent, turns, there if is_on_both else None)
        else:
            text = _("Let go of the anchor over another layer to attach this layer.")
            session.notices.show(text, topic="joint")

    def shapes(self, _place: complex, em: float) -> Iterable[OverlayShape]:
        """Return the line to the pointer, and the outline of the layer under it."""
        if not self.moved:
            return
        role: ColourRole = "danger" if self.is_circle else "accent"
        own, runtimes = self.project.layer_runtime.shown, self.project.runtimes.layers
        parent = None if self.parent is None else runtimes[self.parent].shown
        if own is not None and parent is not None:
            for loop in scene_outlines(parent):
                points = own.placement.inverse.apply(loop).tolist()
                yield LineShape(points=points, role=role, closed=True)
        yield LineShape(points=[self.spot.place, self.place], role=role)
        yield CircleShape(centre=self.place, radius=0.45 * em, role=role, width=0.16)

    @property
    def active_hints(self) -> tuple[Hint, ...]:
        if self.parent is None:
            return (Hint(_("drag over the layer to attach it to")),)
        text = _("let go to attach {child} to {parent}")
        if self.is_circle:
            text = _("{parent} is attached to {child} and cannot be its parent")
        names = {"child": self.names[self.child], "parent": self.names[self.parent]}
        return (Hint(text.format(**names)),)


def _takes_anchor(session: Session, project: Project, spot: PointerHit) -> bool:
    """Return whether a press grabs the anchor of a layer, in a scene of several layers."""
    is_free = not (spot.shift or spot.alt or spot.on_gizmo) and session.display.overlays.handles
    return spot.on_anchor and is_free and len(project.document.layers) > 1
