"""Auto-pin: a handle with equal targets in two keys stays there between them."""

from imgui_bundle import imgui

from app.document import Handle, handle_commands, shape_commands
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.ui.style.theme import Look
from app.ui.style.widgets import FILL, draw_tooltip, heading, small_text, text_button


def draw_auto_pin(look: Look, project: Project, handle: Handle) -> list[Action]:
    """Draw whether a handle is free between keys. Offer auto-pin if the layer does not use it."""
    layer, actions = project.layer, list[Action]()
    heading(look, "Between keys")
    changed, free = imgui.checkbox("Free between keys", handle.is_unpinned)
    draw_tooltip("Let it move between two keys that have it at one place; else it stays there")
    if changed:
        command = handle_commands.unpin_handles(project.active, frozenset({handle.id}), free=free)
        actions.append(do(editing.edit_document, command))
    if not layer.has_auto_pins:
        small_text(look, "In this drawing no handle stays between keys.")
        hint = "Let handles stay in between where two keys have them at one place"
        if text_button("Let handles stay", FILL, hint):
            command = shape_commands.set_auto_pins(project.active, enabled=True)
            actions.append(do(editing.edit_document, command))
    return actions
