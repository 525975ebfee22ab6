"""Making parts of a layer stiff or soft: a brush, bones, and what handles' names suggest."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from app.document import bone_region, brushed_stiffness, material_commands
from app.document.rig import Bone
from app.editor.actions import editing, playback, posing
from app.editor.actions.body import cutting
from app.editor.project import Project
from app.editor.session import MaterialTool, Session, with_project
from app.errors import LissomError
from engine.errors import EngineError
from engine.geometry import distance_to_boundary

# The brushes, and whether they make parts stiffer or softer; None takes that back.
BRUSHES: Mapping[str | None, bool | None] = {"stiff": True, "soft": False, "normal": None}
WEAKEST, STRONGEST, SOFTEST = 1.5, 100.0, 30.0  # of the brush and of bones
FIRST_BRUSH = 0.1  # of the picture's longer side: it is to reach the edge of a limb
AROUND = 2.0  # times as far around a handle as it is away from the outline
# By which factor the words in handles' names make the parts around them stiff.
SUGGESTED = (
    ({"head", "face", "skull", "hand", "fist", "shoe", "boot", "foot", "hoof", "paw"}, 10.0),
    ({"tail", "trunk", "tentacle", "hair", "scarf", "ribbon", "cape"}, 0.2),
)


@with_project
def take_up(session: Session, project: Project, tool: MaterialTool | None) -> None:
    """Take a tool in hand that changes the material; None, or the same again, goes back to pose."""
    if session.pointer is None:
        playback.halt(session)
        session.material = None if tool == session.material else tool
        session.cutting, session.moves, project.draft = None, False, None
        if project.brush is None:
            cutting.set_brush(session, FIRST_BRUSH * max(project.layer.picture.size))


def set_strength(session: Session, strength: float) -> None:
    """Set how many times as stiff the brush makes what it covers, or as soft."""
    session.strength = min(max(strength, WEAKEST), STRONGEST)


def set_softness(session: Session, softness: float) -> None:
    """Set over which part of the brush's radius its effect becomes less."""
    session.softness = min(max(softness, 0.0), 1.0)


@with_project
def paint(session: Session, project: Project, places: Sequence[complex]) -> None:
    """Make what a stroke covers stiff or soft, or take that back; `places` are shown ones."""
    shown, tool = project.puppet.shown, session.material
    if shown is None or tool is None:
        return
    at = np.array(places, dtype=np.complex128)
    rest = (
        shown.mesh.locate(at, shown.positions)
        .positions_on(shown.mesh.domain.mesh.vertices)
        .tolist()
    )
    radius = cutting.brush_radius(project)
    amount = {"stiff": session.strength, "soft": 1 / min(session.strength, SOFTEST)}.get(tool, 1.0)
    _, is_reached = brushed_stiffness(
        project.layer, rest, radius=radius, amount=amount, softness=session.softness
    )
    if not is_reached:
        session.tell(
            "The brush reaches no outline there. Make it larger, or brush nearer to the edge.",
            topic="material",
        )
        return
    command = material_commands.paint_stiffness(
        project.active, rest, radius=radius, amount=amount, softness=session.softness
    )
    editing.edit(session, command)


def clear(session: Session) -> None:
    """Take back all that is painted."""
    editing.edit_layer(session, material_commands.clear_stiffness)


@with_project
def mirror(session: Session, project: Project) -> None:
    """Give both sides of the mirror axis what one of them has."""
    editing.edit_layer(session, material_commands.mirror_stiffness, project.document.pairs)


@with_project
def add_bone(session: Session, project: Project, ends: tuple[int, int]) -> None:
    """Put a bone between two handles, or tell why there can be none."""
    try:
        project.history.do(material_commands.add_bone(project.active, ends))
    except (EngineError, LissomError) as error:
        session.tell(str(error), tone="error", topic="material")


@with_project
def bone_between(session: Session, project: Project) -> None:
    """Put a bone between the two handles that are selected."""
    if len(project.selected) == 2:
        first, second = sorted(project.selected)
        add_bone(session, (first, second))


def remove_bone(session: Session, ends: tuple[int, int]) -> None:
    """Take the bone between two handles away."""
    editing.edit_layer(session, material_commands.remove_bone, ends)


def set_bone(session: Session, ends: tuple[int, int], amount: float) -> None:
    """Set how stiff a bone is."""
    editing.edit_layer(session, material_commands.set_bone_stiffness, ends, amount)


def show_bones(session: Session, *, shown: bool) -> None:
    """Show the bones, or hide them: they act either way."""
    editing.edit_layer(session, material_commands.set_bones_visible, shown=shown)


def refusal_of_bone(project: Project, ends: tuple[int, int]) -> str:
    """Return why there can be no bone between two handles; empty where there can be one."""
    layer = project.layer
    try:
        bone_region(layer, Bone(ends=ends), layer.domain.outline)
    except (EngineError, LissomError) as error:
        return str(error)
    return ""


@with_project
def suggest(session: Session, project: Project) -> None:
    """Make heads, hands and feet stiff and tails and trunks soft, by the names of their handles."""
    layer, gesture, done = project.layer, object(), list[str]()
    for handle in layer.handles:
        words = set(re.findall("[a-z]+", handle.name.lower()))
        amount = next((by for names, by in SUGGESTED if words & names), None)
        if amount is None:
            continue
        outline, *holes = layer.domain.loops
        (depth,) = distance_to_boundary(outline, np.array([handle.position]), holes).tolist()
        command = material_commands.paint_stiffness(
            project.active, [handle.position], radius=AROUND * depth, amount=amount, softness=0.5
        )
        project.history.do(command, gesture=gesture)
        done.append(handle.name)
    if done:
        session.tell(f"By their names: {', '.join(done)}.", topic="material")
    else:
        session.tell(
            "No handle is called after a head, hand, foot, tail or the like: name them first.",
            topic="material",
        )


def pose_again(session: Session) -> None:
    """Let the pose that is shown follow its wishes once more, with the material as it is now."""
    posing.pull_again(session, {}, gesture=object())
