"""The bar of icon buttons at the left."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Project, Session
from app.ui.shortcuts.widgets import draw_action_button
from app.ui.style.theme import Look

# Names in the table of actions. A gap separates two groups.
GROUPS = (
    ("fit", "move"),
    ("handles", "wireframe", "outline", "heat map", "split view", "onion skin", "motion paths"),
    ("auto-key",),
)


def draw_icon_bar(session: Session, look: Look, _: Project) -> list[Action]:
    actions: list[Action] = []
    for number, names in enumerate(GROUPS):
        if number:
            imgui.dummy(ImVec2(0, 0.4 * look.em))
        for name in names:
            actions += draw_action_button(session, look, name)
    return actions
