"""The slim bar of switches at the left."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Session
from app.ui.shortcuts import BINDINGS, bound_button
from app.ui.style import Look


def draw_icons(session: Session, look: Look) -> list[Action]:
    """Draw the bar, as the table of shortcuts has it."""
    actions: list[Action] = []
    if session.project is None:
        return actions
    shown = [name for name, binding in BINDINGS.items() if binding.in_bar]
    menu = BINDINGS[shown[0]].menu
    for name in shown:
        binding = BINDINGS[name]
        if binding.parted or binding.menu != menu:
            imgui.dummy(ImVec2(0, 0.4 * look.em))
        menu = binding.menu
        actions += bound_button(session, look, name)
    return actions
