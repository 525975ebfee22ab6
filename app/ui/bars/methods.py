"""Menu entries of the interpolation methods."""

from imgui_bundle import imgui

from app.document import shape_commands
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.texts import _
from app.ui.methods import VARIANTS
from app.ui.style.widgets import draw_tooltip


def draw_method_menu(project: Project) -> list[Action]:
    """Draw the entries in the open menu or list."""
    actions: list[Action] = []
    for variant, text in VARIANTS.items():
        if imgui.menu_item(text.title, "", variant == project.layer.variant)[0]:
            actions.append(do(editing.edit_layer, shape_commands.set_variant, variant))
        draw_tooltip(text.what)
    imgui.separator()
    stays = project.layer.has_auto_pins
    if imgui.menu_item(_("Auto-pin handles"), "", stays)[0]:
        command = shape_commands.set_auto_pins(project.selection.active, enabled=not stays)
        actions.append(do(editing.edit_document, command))
    draw_tooltip(_("Keep handles in place between two keys with equal targets"))
    return actions
