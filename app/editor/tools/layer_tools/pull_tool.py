"""Tool of the mode Move that pulls the pressed layer at its joint."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Self

from app.document import Transform
from app.editor.actions import playback
from app.editor.layering.layer_posing import (
    find_pull,
    set_ik_target,
    set_transforms,
    tell_if_planted,
)
from app.editor.layering.layer_selection import set_active_layer
from app.editor.parts.tools import Hint
from app.editor.project import Project
from app.editor.session import Session
from app.editor.tools.tool import PointerHit, Tool, to_scene
from app.motion import LayerPull
from app.texts import _


@dataclass(slots=True, kw_only=True, eq=False)
class PullTool(Tool):
    """The pointer pulls an attached layer by a point; its parents bend as bones.

    While Ctrl is held, the layer turns alone. With Shift at the press, it moves off its joint.
    """

    cursor = "hand"
    snaps = True
    pull: LayerPull
    start: complex  # place of the press in the scene
    shifts: bool  # whether the layer moves off its joint
    last: int  # the active layer before the press
    moved: bool = False

    @classmethod
    def hints(cls, session: Session, project: Project, spot: PointerHit) -> tuple[Hint, ...]:
        layer = _pressed_layer(session, project, spot)
        if layer is None:
            return ()
        frame = playback.current_frame(session, project)
        name = project.document.layer(layer).name
        if len(project.document.parent_chain(layer, frame)) < 2:
            return ()
        return (
            Hint(_("drag to pull {layer}; its parents bend").format(layer=name)),
            Hint(_("drag to turn it alone"), "ctrl"),
            Hint(_("drag to move it off its joint"), "shift"),
        )

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab the attached layer under the pointer, and make it active."""
        layer = _pressed_layer(session, project, spot)
        if layer is None or spot.ctrl or spot.alt:
            return None
        pull = find_pull(session, project, layer)
        frame = playback.current_frame(session, project)
        if pull is None or len(project.document.parent_chain(layer, frame)) < 2:
            return None
        start, last = to_scene(project, spot.place), project.selection.active
        set_active_layer(session, layer)
        return cls(project=project, pull=pull, start=start, shifts=spot.shift, last=last)

    def move(self, session: Session, place: complex) -> None:
        """Pull the layer to the pointer."""
        here = to_scene(self.project, place)
        self.moved = self.moved or self.is_away(session, self.start, here)
        if not self.moved or (not self.shifts and tell_if_planted(session, self.pull)):
            return
        target, alone = self.pull.target, session.tools.is_snapping
        if self.shifts:
            self._set(session, self.pull.moved(here - self.start), _("Move layer"))
        elif target is not None and target.mix > 0 and not alone:
            own = self.pull.present_target()
            wanted = replace(own, place=own.place + here - self.start, mix=target.mix)
            set_ik_target(session, self.pull.layer, wanted, gesture=self)
        else:
            pulled = self.pull.pulled(self.start, here, alone=alone)
            self._set(session, pulled, _("Turn layer"))

    def _set(self, session: Session, found: Mapping[int, Transform], label: str) -> None:
        set_transforms(session, found, label=label, gesture=self)

    def end(self, _session: Session, _place: complex) -> None:
        """Release the layer."""
        self.project.history.release(self)

    def cancel(self, session: Session) -> None:
        """Undo the drag, and make the earlier layer active."""
        set_active_layer(session, self.last)
        super(PullTool, self).cancel(session)


def _pressed_layer(session: Session, project: Project, spot: PointerHit) -> int | None:
    """Return the layer under the pointer in the mode Move, unless it is locked."""
    if session.tools.mode != "move" or spot.layer is None or spot.on_gizmo:
        return None
    return None if project.document.layer(spot.layer).locked else spot.layer
