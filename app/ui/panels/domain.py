"""The outline, the cage and the mesh: how they are made, and a look at them."""

from imgui_bundle import ImVec2, imgui

from app.actions import rebuilding, viewing
from app.actions.action import Action, do
from app.document.settings import Meshing
from app.session import Project, Session
from app.ui.theme import Look
from app.ui.widgets import heading, label, main_button, segments, small, tip

DETAILS = (("coarse", "Coarse"), ("normal", "Normal"), ("fine", "Fine"))


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the settings of the domain."""
    project = session.project
    if project is None:
        return []
    domain = project.document.domain
    small(
        look,
        f"{len(domain.outline)} points of outline and cage, "
        f"{len(domain.mesh.triangles):,} triangles.",
    )
    actions: list[Action] = []
    overlays = session.overlays
    if imgui.checkbox("Show outline and cage", overlays.outline)[0]:
        actions.append(do(viewing.toggle, "outline"))
    if imgui.checkbox("Show the triangles", overlays.wireframe)[0]:
        actions.append(do(viewing.toggle, "wireframe"))
    heading(look, "Make it again")
    draft = project.meshing or project.document.meshing
    chosen = _settings(look, project, draft)
    if chosen != draft:
        actions.append(do(viewing.draft_meshing, chosen))
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    if rebuilding.REBUILDING in session.jobs.kinds:
        if imgui.button("Cancel", ImVec2(-1, 0)):
            actions.append(do(rebuilding.cancel))
    elif main_button(look, "Rebuild", -1, enabled=chosen != project.document.meshing):
        actions.append(do(rebuilding.rebuild, chosen))
    small(look, "Handles stay; every key is solved again. Undo brings all of it back.")
    return actions


def _settings(look: Look, project: Project, draft: Meshing) -> Meshing:
    detail, triangles, tolerance = draft.detail, draft.triangles, draft.tolerance
    label(look, "Outline")
    picked = segments(look, "detail", DETAILS, detail)
    tip("How closely the outline follows the drawing")
    label(look, "Triangles")
    changed, count = imgui.slider_int(
        "##triangles", triangles, 2_000, 1_000_000, "%d", imgui.SliderFlags_.logarithmic
    )
    if changed:
        triangles = min(max(round(count, -3), 2_000), 1_000_000)
    if project.is_opaque:
        label(look, "Tolerance")
        changed, tolerance = imgui.slider_int("##tolerance", tolerance, 0, 120)
        tip("How far the background may vary in colour, in levels")
    match picked:
        case "coarse" | "normal" | "fine":
            detail = picked
    return Meshing(detail=detail, triangles=triangles, tolerance=tolerance)
