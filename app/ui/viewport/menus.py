"""The menus of the drawing: of a handle, and of whatever else is under the pointer."""

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import HOLDS, Handle, handle_commands
from app.editor import Action, Session, do
from app.editor.actions import editing, posing
from app.ui.shortcuts import ALT, CTRL, bound_item, with_key
from app.ui.viewport.screen import Screen

# By their names in the table of shortcuts; a line parts two groups.
CANVAS = (
    ("insert key", "copy", "paste", "paste flipped"),
    ("suggest handles", "select all", "move"),
    ("fit", "fit motion", "actual size"),
    ("handles", "outline", "onion skin"),
)
DEPTHS = {"In front": 1.0, "In its usual order": 0.0, "Behind": -1.0}


def canvas_menu(session: Session, *, is_pointed: bool) -> list[Action]:
    """Draw the menu of the canvas, if it is open; a right click opens it where it is pointed."""
    is_free = is_pointed and session.pointer is None and session.cutting is None
    if is_free and imgui.is_mouse_clicked(imgui.MouseButton_.right):
        imgui.open_popup("menu of the canvas")
    actions: list[Action] = []
    if not imgui.begin_popup("menu of the canvas"):
        return actions
    for number, names in enumerate(CANVAS):
        if number:
            imgui.separator()
        for name in names:
            actions += bound_item(session, name)
    imgui.end_popup()
    return actions


def handle_menu(session: Session, screen: Screen, identity: int) -> list[Action]:
    """Draw the menu of a handle, if it is open: what it does is done with all that are selected."""
    actions: list[Action] = []
    if not imgui.begin_popup(f"menu of handle {identity}"):
        return actions
    figure, handle = screen.project.figure, screen.project.figure.handle(identity)
    chosen = screen.project.selected | {identity}
    target = screen.shown.pose.targets.get(identity) if screen.shown.pose else None
    item = imgui.internal.menu_item_ex  # as menu_item_simple, with icons in a column
    if item("Delete", icons.ICON_FA_TRASH, with_key(ALT, "click")):
        actions.append(do(posing.remove_handles, chosen))
    actions += bound_item(session, "pin here") + bound_item(session, "lock")
    actions += _hold(handle, chosen) + _depth(session, screen, handle)
    imgui.separator()
    label = "Automatic anchor" if handle.position == figure.anchor else "Make it the anchor"
    if item(label, icons.ICON_FA_ANCHOR, with_key(CTRL, "click")):
        actions.append(do(posing.anchor_at, identity))
    is_turned = target is not None and target.rotation is not None
    if item("Let it turn freely", icons.ICON_FA_ROTATE, enabled=is_turned):
        actions.append(do(posing.free_turn, identity))
    imgui.end_popup()
    return actions


def _hold(handle: Handle, chosen: frozenset[int]) -> list[Action]:
    """Draw how firmly it holds."""
    if not imgui.begin_menu("Hold"):
        return []
    weigh = handle_commands.weigh_handles
    actions = [
        do(editing.edit_figure, weigh, chosen, weight)
        for word, weight in HOLDS.items()
        if imgui.menu_item(word, "", handle.weight == weight)[0]
    ]
    imgui.end_menu()
    return actions


def _depth(session: Session, screen: Screen, handle: Handle) -> list[Action]:
    """Draw whether it is painted in front where the drawing lies over itself."""
    if not imgui.begin_menu("Depth"):
        return []
    front = editing.depth_now(session, screen.project, handle)
    actions = [
        do(editing.set_depth, handle.id, depth)
        for word, depth in DEPTHS.items()
        if imgui.menu_item(word, "", front == depth)[0]
    ]
    imgui.end_menu()
    return actions
