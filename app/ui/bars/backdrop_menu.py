"""The menu of what lies behind the drawing."""

from imgui_bundle import imgui

from app.editor import Action, Session, do
from app.editor.actions import viewing
from app.storage import CHECKER

BACKDROPS = {"Checker": CHECKER, "White": "#ffffff", "Grey": "#808080", "Black": "#000000"}


def draw(session: Session) -> list[Action]:
    """Draw the menu in the one that is open."""
    if not imgui.begin_menu("Backdrop"):
        return []
    current = session.preferences.backdrop
    actions = [
        do(viewing.set_backdrop, backdrop)
        for name, backdrop in BACKDROPS.items()
        if imgui.menu_item(name, "", backdrop == current)[0]
    ]
    code = "000000" if current == CHECKER else current[1:]
    colour = [channel / 255 for channel in bytes.fromhex(code)]
    is_changed, colour = imgui.color_edit3("##own colour", colour)
    if is_changed:
        channels = bytes(round(255 * min(max(channel, 0.0), 1.0)) for channel in colour)
        actions.append(do(viewing.set_backdrop, f"#{channels.hex()}"))
    imgui.end_menu()
    return actions
