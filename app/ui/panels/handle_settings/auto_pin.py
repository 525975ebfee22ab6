"""Auto-pin: a handle with equal targets in two keys stays there between them."""

from imgui_bundle import imgui

from app.document import Handle, handle_commands, shape_commands
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.texts import _
from app.ui.style.theme import Look
from app.ui.style.widgets import FILL, draw_tooltip, heading, small_text, text_button


def draw_auto_pin(look: Look, project: Project, handle: Handle) -> list[Action]:
    """Draw whether a handle is free between keys. Offer auto-pin if the layer does not use it."""
    layer, actions = project.layer, list[Action]()
    heading(look, _("Between keys"))
    changed, free = imgui.checkbox(_("Free between keys"), handle.is_unpinned)
    draw_tooltip(
        _("Let the handle move between two keys with equal targets. Otherwise it stays in place.")
    )
    if changed:
        command = handle_commands.unpin_handles(
            project.selection.active, frozenset({handle.id}), free=free
        )
        actions.append(do(editing.edit_document, command))
    if not layer.has_auto_pins:
        small_text(look, _("Auto-pin is off in this layer: handles with equal targets can move."))
        hint = _("Keep handles in place between two keys with equal targets")
        if text_button(_("Turn on auto-pin"), FILL, hint):
            command = shape_commands.set_auto_pins(project.selection.active, enabled=True)
            actions.append(do(editing.edit_document, command))
    return actions
