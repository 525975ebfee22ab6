"""The outline, the cage and the mesh: settings and display."""

from dataclasses import replace
from functools import lru_cache

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Meshing
from app.editor import Action, Overlays, Project, Session, do
from app.editor.actions import viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.viewing import OverlayName
from app.texts import _, ngettext
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

DETAILS = (("coarse", _("Coarse")), ("normal", _("Normal")), ("fine", _("Fine")))
TRIANGLES = Scale(left=2_000, right=1_000_000, logarithmic=True)
SHOWN: tuple[tuple[OverlayName, str, str], ...] = (
    ("outline", _("Outline"), _("The edge of the shape, which moves with the drawing")),
    ("cage", _("Cage"), _("The polygon around the drawing that moves every point inside")),
    ("wireframe", _("Mesh"), _("The triangles that the drawing is cut into")),
)


def draw_mesh(session: Session, look: Look, project: Project) -> list[Action]:
    heading(look, _("Show"))
    actions = _toggles(session.display.overlays)
    heading(look, _("Info"))
    _facts(look, project)
    heading(look, _("Rebuild"))
    layer = project.layer
    draft = project.layer_setup.meshing or layer.meshing
    chosen = _settings(look, draft)
    if chosen != draft:
        actions.append(do(viewing.preview_meshing, chosen))
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    resolver = project.key_resolver
    if resolver is not None and resolver.meshing is not None:
        if progress_bar(resolver.progress, resolver.status_text):
            actions.append(do(resolving.cancel_solving_keys))
    else:
        is_new = chosen != layer.meshing and resolver is None
        text = f"{icons.ICON_FA_ARROWS_ROTATE}  {_('Rebuild')}###rebuild"
        reason = None if is_new else _("Change a setting above first.")
        if main_button(look, text, FILL, reason=reason):
            actions.append(do(resolving.rebuild_mesh))
        if is_new and imgui.button(_("Revert") + "###forget", ImVec2(FILL, 0)):
            actions.append(do(viewing.preview_meshing, layer.meshing))
    small_text(look, _("Handles stay, and every key is re-posed. Undo restores both."))
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
    text = _("{width} × {height} pixels")
    _fact(look, _("Picture"), text.format(width=width, height=height))
    for name, loops in ((_("Outline"), domain.loops), (_("Cage"), domain.cages)):
        count = sum(map(len, loops))
        text = ngettext("{count:,} point", "{count:,} points", count)
        _fact(look, name, text.format(count=count))
    if domain.holes:
        _fact(look, _("Holes"), f"{len(domain.holes):,}")
    _fact(look, _("Triangles"), f"{len(domain.mesh.triangles):,}")
    _fact(look, _("Vertices"), f"{len(domain.mesh.vertices):,}")
    _fact(look, _("Smallest angle"), f"{_smallest_angle(domain.mesh):.1f}°")
    imgui.pop_style_var()


def _fact(look: Look, name: str, text: str) -> None:
    label(look, name)
    imgui.text_unformatted(text)


@lru_cache(maxsize=2)
def _smallest_angle(mesh: Mesh) -> float:
    return float(mesh.smallest_angles().min())


def _settings(look: Look, draft: Meshing) -> Meshing:
    label(look, _("Outline"))
    match option_buttons(look, "detail", DETAILS, draft.detail):
        case "coarse" | "normal" | "fine" as detail:
            draft = replace(draft, detail=detail)
    draw_tooltip(_("How closely the outline follows the drawing"))
    label(look, _("Triangles"))
    hint = _("Approximate number of triangles: more bend smoothly, fewer draw faster")
    entered = slider(look, "triangles", draft.triangles, TRIANGLES, text="%.0f", hint=hint)
    if entered is not None:
        digits = 0 if entered.is_final and entered.value < 10_000 else -3
        draft = replace(draft, triangles=int(round(entered.value, digits)))
    return draft
