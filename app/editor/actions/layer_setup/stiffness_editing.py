"""Tools that make parts of a layer stiff or soft: brush, bones, and suggestions by handle names."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from app.document import Bone, brushed_stiffness, direct_bone, stiffness_commands
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import ActionSpec, named_action, unless
from app.editor.actions.layer_setup import cut_out_editing
from app.editor.actions.posing.pose_drag import solve_pose_again
from app.editor.parts.tools import StiffnessTool
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import LissomError
from app.texts import _, message_of
from engine.errors import EngineError
from engine.geometry import distance_to_boundary

# The brushes, and whether they make parts stiffer or softer; None erases.
BRUSHES: Mapping[str | None, bool | None] = {"stiff": True, "soft": False, "normal": None}
WEAKEST, STRONGEST, SOFTEST = 1.5, 100.0, 30.0  # of the brush and of bones
FIRST_BRUSH = 0.1  # of the picture's longer side, so that it reaches the edge of a limb
AROUND = 2.0  # radius of a suggestion, in distances of its handle from the outline
# Stiffness factors of the parts around handles, by words in the handles' names.
SUGGESTED = (
    ({"head", "face", "skull", "hand", "fist", "shoe", "boot", "foot", "hoof", "paw"}, 10.0),
    ({"tail", "trunk", "tentacle", "hair", "scarf", "ribbon", "cape"}, 0.2),
)


@with_project
def toggle_stiffness_tool(session: Session, project: Project, tool: StiffnessTool | None) -> None:
    """Select a stiffness tool; None, or the selected tool again, selects the pose tool."""
    if session.tools.active_tool is None:
        playback.stop_playback(session)
        session.tools.toggle(tool or "pose")
        if project.layer_setup.brush is None:
            cut_out_editing.set_brush_radius(session, FIRST_BRUSH * max(project.layer.picture.size))


MAKE_STIFF = ActionSpec(
    do(toggle_stiffness_tool, "stiff"),
    _("Make parts stiff"),
    "G",
    icon="CUBE",
    hint=_("Brush over parts that bend and stretch less"),
    active=lambda session: session.tools.stiffness_tool in BRUSHES,
)
DRAW_BONES = ActionSpec(
    do(toggle_stiffness_tool, "bone"),
    _("Draw bones"),
    "Shift+B",
    icon="BONE",
    hint=_("Drag from root to end, such as hip to knee: the limb keeps its length"),
    active=lambda session: session.tools.mode == "bone",
)


def set_stiffness_strength(session: Session, strength: float) -> None:
    """Set the factor of stiffness or softness that the brush paints."""
    session.tools.set_brush_strength(min(max(strength, WEAKEST), STRONGEST))


def set_brush_softness(session: Session, softness: float) -> None:
    """Set the part of the brush's radius over which its effect fades."""
    session.tools.set_brush_softness(min(max(softness, 0.0), 1.0))


@with_project
def paint_stiffness(session: Session, project: Project, places: Sequence[complex]) -> None:
    """Paint or erase stiffness along a stroke; `places` are in the shown pose."""
    shown, tool = project.layer_runtime.shown, session.tools.stiffness_tool
    if shown is None or tool is None:
        return
    at = np.array(places, dtype=np.complex128)
    rest = (
        shown.mesh.locate(at, shown.positions)
        .positions_on(shown.mesh.domain.mesh.vertices)
        .tolist()
    )
    radius = cut_out_editing.brush_radius(project)
    amount = {
        "stiff": session.tools.strength,
        "soft": 1 / min(session.tools.strength, SOFTEST),
    }.get(tool, 1.0)
    _weights, is_reached = brushed_stiffness(
        project.layer, rest, radius=radius, amount=amount, softness=session.tools.softness
    )
    if not is_reached:
        session.notices.show(
            _("The brush reaches no outline there. Make it larger, or brush nearer to the edge."),
            topic="material",
        )
        return
    command = stiffness_commands.paint_stiffness(
        project.selection.active,
        rest,
        radius=radius,
        amount=amount,
        softness=session.tools.softness,
    )
    editing.edit_document(session, command)


@with_project
def mirror_stiffness(session: Session, project: Project) -> None:
    """Copy the stiffness of one side of the mirror axis to the other."""
    editing.edit_layer(session, stiffness_commands.mirror_stiffness, project.document.pairs)


@with_project
def add_bone(session: Session, project: Project, ends: tuple[int, int]) -> None:
    """Put a bone between two handles, or show why there can be none."""
    reason = bone_disabled_reason(project, ends)
    if reason is not None:
        session.notices.show(reason, tone="error", topic="material")
        return
    project.history.do(stiffness_commands.add_bone(project.selection.active, ends))


@named_action(
    _("Add bone"),
    why_disabled=unless(
        lambda _, project: len(project.selection.handles) == 2, _("Select two handles first.")
    ),
)
@with_project
def add_bone_between_selected(session: Session, project: Project) -> None:
    if len(project.selection.handles) == 2:
        first, second = sorted(project.selection.handles)
        add_bone(session, direct_bone(project.layer, (first, second)))


def bone_disabled_reason(project: Project, ends: tuple[int, int]) -> str | None:
    """Return why no bone can be put between two handles; None if one can."""
    layer = project.layer
    try:
        stiffness_commands.with_bone(layer, Bone(ends=ends))
    except LissomError as error:
        return message_of(error)
    except EngineError as error:
        names = " – ".join(layer.handle(end).name for end in ends)
        return _("{bone}: {error}").format(bone=names, error=message_of(error))
    return None


@with_project
def suggest_stiffness(session: Session, project: Project) -> None:
    """Make heads, hands and feet stiff and tails and trunks soft, by their handles' names."""
    layer, gesture, done = project.layer, object(), list[str]()
    for handle in layer.handles:
        words = set(re.findall("[a-z]+", handle.name.lower()))
        amount = next((by for names, by in SUGGESTED if words & names), None)
        if amount is None:
            continue
        outline, *holes = layer.domain.loops
        (depth,) = distance_to_boundary(outline, np.array([handle.position]), holes).tolist()
        command = stiffness_commands.paint_stiffness(
            project.selection.active,
            [handle.position],
            radius=AROUND * depth,
            amount=amount,
            softness=0.5,
        )
        project.history.do(command, gesture=gesture)
        done.append(handle.name)
    if done:
        text = _("Stiffness set by name: {handles}.").format(handles=", ".join(done))
        session.notices.show(text, topic="material")
    else:
        session.notices.show(
            _(
                "No handle is named after a part of the body. Name the handles first, such as "
                "head, hand, foot or tail."
            ),
            topic="material",
        )


def solve_shown_pose_again(session: Session) -> None:
    """Solve the shown pose for its targets again, with the present stiffness."""
    solve_pose_again(session, {}, gesture=object())
