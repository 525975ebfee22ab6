"""Actions on limbs: the side to which a joint bends."""

from cmath import phase
from collections.abc import Mapping
from dataclasses import replace

from app.document import Layer, Target, find_limbs
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.pose_drag import drag_handles
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.drag_session import DragStart
from app.rigging import bend_side
from app.texts import _


@named_action(
    _("Bend other way"),
    icon="LEFT_RIGHT",
    hint=_("Bend the limb at the selected elbow or knee to its other side in this pose"),
    why_disabled=unless(
        lambda _, project: _selected_joints(project),
        _("Select a joint between two bones first, such as an elbow."),
    ),
)
@with_project
def flip_selected_joints(session: Session, project: Project) -> None:
    """Bend the selected joints of limbs to their other sides."""
    joints = _selected_joints(project)
    rest = {handle.id: handle.position for handle in project.layer.handles}

    def flipped(start: DragStart, targets: Mapping[int, Target]) -> Mapping[int, Target]:
        sides = {}
        for joint, around in joints.items():
            present = bend_side(*(start.places[i] for i in around))
            side = present or targets[joint].side or bend_side(*(rest[i] for i in around)) or 1
            sides[joint] = replace(targets[joint], side=-side)
        return sides

    if joints:
        drag_handles(session, flipped)


def turn_last_bones(
    layer: Layer, start: DragStart, moved: Mapping[int, Target]
) -> Mapping[int, Target]:
    """Return moved targets with ends of limbs on circles around the joints before them."""
    limbs, turned = find_limbs(layer), dict(moved)
    for limb in limbs.limbs if limbs is not None else ():
        *before, joint, end = limb.chain.handles
        if end not in moved or not before or not {joint, before[-1]}.isdisjoint(moved):
            continue
        centre, way = start.places[joint], moved[end].position - start.places[joint]
        place = centre + way / (abs(way) or 1.0) * limb.lengths[-1]
        angle = moved[end].rotation
        if angle is not None:
            # The hand turns with its bone.
            angle += phase((place - centre) / ((start.places[end] - centre) or 1.0))
        turned[end] = replace(moved[end], position=place, rotation=angle)
        if len(before) == 1:
            side = bend_side(start.places[before[0]], centre, place) or None
            turned[joint] = replace(start.targets[joint], side=side or start.targets[joint].side)
    return turned


def _selected_joints(project: Project) -> dict[int, tuple[int, int, int]]:
    """Return the selected joints, each with the handles around it in its chain."""
    limbs, found = find_limbs(project.layer), dict[int, tuple[int, int, int]]()
    for limb in limbs.limbs if limbs is not None else ():
        handles = limb.chain.handles
        for around in zip(handles, handles[1:], handles[2:], strict=False):
            if around[1] in project.selection.handles:
                found[around[1]] = around
    return found
