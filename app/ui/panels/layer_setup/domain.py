"""The outline, the cage and the mesh: settings and display."""

from dataclasses import replace
from functools import lru_cache

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Meshing
from app.editor import Action, Overlays, Project, Session, do
from app.editor.actions import viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.viewing import OverlayName
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    draw_tooltip,
    heading,
    label,
    main_button,
    option_buttons,
    progress_bar,
    small_text,
)
from engine.domain.meshing.mesh import Mesh

DETAILS = (("coarse", "Coarse"), ("normal", "Normal"), ("fine", "Fine"))
TRIANGLES = Scale(left=2_000, right=1_000_000, logarithmic=True)
SHOWN: tuple[tuple[OverlayName, str, str], ...] = (
    ("outline", "Outline", "The edge of the shape, which moves with the drawing"),
    ("cage", "Cage", "The polygon around the drawing at rest that moves every point inside"),
    ("wireframe", "Mesh", "The triangles that the drawing is cut into"),
)


def draw_domain_panel(session: Session, look: Look, project: Project) -> list[Action]:
    heading(look, "Show")
    actions = _toggles(session.overlays)
    heading(look, "Facts")
    _facts(look, project)
    heading(look, "Rebuild")
    layer = project.layer
    draft = project.meshing or layer.meshing
    chosen = _settings(look, draft)
    if chosen != draft:
        actions.append(do(viewing.preview_meshing, chosen))
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    renewal = project.key_resolver
    if renewal is not None and renewal.meshing is not None:
        if progress_bar(renewal.progress, renewal.status_text):
            actions.append(do(resolving.cancel_solving_keys))
    else:
        is_new = chosen != layer.meshing and renewal is None
        text = f"{icons.ICON_FA_ARROWS_ROTATE}  Rebuild###rebuild"
        if main_button(look, text, FILL, enabled=is_new):
            actions.append(do(resolving.rebuild_mesh))
        if is_new and imgui.button("Revert###forget", ImVec2(FILL, 0)):
            actions.append(do(viewing.preview_meshing, layer.meshing))
    small_text(look, "Handles stay, and every key is posed again. Undo brings all of it back.")
    return actions


def _toggles(overlays: Overlays) -> list[Action]:
    actions: list[Action] = []
    column = imgui.get_content_region_avail().x / len(SHOWN)
    left = imgui.get_cursor_pos_x()
    for index, (overlay, text, hint) in enumerate(SHOWN):
        if index:
            imgui.same_line(left + index * column)
        if imgui.checkbox(text, getattr(overlays, overlay))[0]:
            actions.append(do(viewing.toggle_overlay, overlay))
        draw_tooltip(hint)
    return actions


def _facts(look: Look, project: Project) -> None:
    domain = project.layer.domain
    close = ImVec2(imgui.get_style().item_spacing.x, 0.0)
    imgui.push_style_var(imgui.StyleVar_.item_spacing, close)
    width, height = project.document.canvas
    _fact(look, "Picture", f"{width} × {height} pixels")
    _fact(look, "Outline", f"{sum(map(len, domain.loops)):,} points")
    _fact(look, "Cage", f"{sum(map(len, domain.cages)):,} points")
    if domain.holes:
        _fact(look, "Holes", f"{len(domain.holes):,}")
    _fact(look, "Triangles", f"{len(domain.mesh.triangles):,}")
    _fact(look, "Vertices", f"{len(domain.mesh.vertices):,}")
    _fact(look, "Least angle", f"{_smallest_angle(domain.mesh):.1f}°")
    imgui.pop_style_var()


def _fact(look: Look, name: str, text: str) -> None:
    label(look, name)
    imgui.text_unformatted(text)


@lru_cache(maxsize=2)
def _smallest_angle(mesh: Mesh) -> float:
    return float(mesh.smallest_angles().min())


def _settings(look: Look, draft: Meshing) -> Meshing:
    label(look, "Outline")
    match option_buttons(look, "detail", DETAILS, draft.detail):
        case "coarse" | "normal" | "fine" as detail:
            draft = replace(draft, detail=detail)
    draw_tooltip("How closely the outline follows the drawing")
    label(look, "Triangles")
    hint = "How many triangles to aim at: more bend smoothly, fewer draw faster"
    entered = slider(look, "triangles", draft.triangles, TRIANGLES, text="%.0f", hint=hint)
    if entered is not None:
        digits = 0 if entered.is_final and entered.value < 10_000 else -3
        draft = replace(draft, triangles=int(round(entered.value, digits)))
    return draft
