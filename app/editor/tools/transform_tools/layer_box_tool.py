"""Tool of the mode Move that turns and scales the active layer by a box around it."""

from dataclasses import dataclass, field, replace
from typing import Self

import numpy as np

from app.editor.layering.layer_posing import (
    find_pull,
    set_ik_target,
    set_transforms,
    tell_if_planted,
)
from app.editor.layering.parenting import is_same_or_descendant
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.tools.tool import PointerHit, scene_outlines
from app.editor.tools.transform_tools.box import BoxChange, TransformBox
from app.editor.tools.transform_tools.box_tool import BoxTool, finish_box, screen_axis
from app.motion import LayerPull
from app.texts import _

MARGIN = 0.7  # em: from the outline to the box


@dataclass(slots=True, kw_only=True, eq=False)
class LayerBoxTool(BoxTool):
    """The pointer turns and scales the active layer with its descendants."""

    is_in_scene = True
    pull: LayerPull | None = field(init=False, default=None)

    @classmethod
    def find_box(cls, session: Session, project: Project, em: float) -> TransformBox | None:
        is_idle = session.tools.mode == "move" and project.timeline.playhead.since is None
        return find_layer_box(session, project, em) if is_idle else None

    @classmethod
    def press(cls, session: Session, project: Project, spot: PointerHit) -> Self | None:
        """Grab a grip of the active layer's box."""
        tool = super(LayerBoxTool, cls).press(session, project, spot)
        if tool is not None:
            tool.pull = find_pull(session, project, project.selection.active)
        return tool

    def apply(self, session: Session) -> None:
        """Set the layer's transform, or its IK target."""
        if self.pull is not None:
            change = self.box.change(self.scale, self.turning.angle)
            change_layer(session, self.pull, change, gesture=self)


def find_layer_box(session: Session, project: Project, em: float) -> TransformBox | None:
    """Return the box around the active layer and its descendants; its pivot is the joint."""
    shown, own = project.layer_runtime.shown, project.layer
    pull = None if own.locked else find_pull(session, project, own.id)
    if shown is None or pull is None:
        return None
    frames = [
        runtime.shown
        for identity, runtime in project.runtimes.layers.items()
        if runtime.shown is not None and is_same_or_descendant(project, identity, own.id)
    ]
    outlines = np.concatenate([scene_outlines(each)[0] for each in frames])
    places = shown.placement.inverse.apply(outlines).tolist()
    box = TransformBox.around(places, screen_axis(session, project, shown), MARGIN * em)
    joint = shown.placement.apply_inverse(pull.joint)
    box = replace(box, pivot=joint, home=joint, has_sides=False)
    return finish_box(session, project, box, em)


def change_layer(
    session: Session, pull: LayerPull, change: BoxChange, *, gesture: object = None
) -> None:
    """Turn and scale a layer around a pivot, with a key of its transform or its IK target."""
    target = pull.target
    if change.turn and tell_if_planted(session, pull):
        return
    if target is not None and target.mix > 0 and change.turn:
        own = pull.present_target()
        place, turn = change.apply(own.place), own.turn + change.turn
        wanted = replace(own, place=place, turn=turn, mix=target.mix)
        set_ik_target(session, pull.layer, wanted, gesture=gesture)
    else:
        found = pull.transformed(change.turn, change.scale.real, change.pivot)
        label = _("Turn layer") if change.turn else _("Scale layer")
        set_transforms(session, found, label=label, gesture=gesture)


@with_project
def change_layer_by_key(session: Session, project: Project, turn: float, factor: float) -> None:
    """Turn the active layer by an angle in radians, and scale it, around the pivot."""
    box = find_layer_box(session, project, 0.0)
    pull = None if box is None else find_pull(session, project, project.selection.active)
    shown = project.layer_runtime.shown
    if box is not None and pull is not None and shown is not None:
        change = box.moved_by(shown.placement).change(factor * (1 + 1j), turn)
        change_layer(session, pull, change)
