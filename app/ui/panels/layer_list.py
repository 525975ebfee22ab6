"""The list of layers, the one in front on top: chosen, named, hidden, locked, dragged in order."""

from collections.abc import Callable

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Figure, is_visible
from app.editor import Action, Project, Session, do, layering
from app.editor.actions import playback
from app.render import Thumbnail
from app.ui.shortcuts import BINDINGS
from app.ui.style import (
    SMALL,
    Look,
    begin_tip,
    icon_button,
    ink,
    name_popup,
    shortened,
    show_picture,
    sized,
    write_in,
)
from engine.arrays import Bytes

MOVED = "layer"  # what is dragged from row to row
ROW, WIDE, GAP = 2.1, 2.5, 0.35  # em: height of a row, width of its picture, room around that
FEWEST, OTHERS = 4.5, 20.0  # rows at least, and em that are left to the settings below
HIDDEN = 0.35  # opacity of the pictures of layers that are not seen now
PULL = 0.25  # em by which the list scrolls in each frame while a row is dragged at its edge
PAPER = imgui.IM_COL32(128, 130, 136, 255)  # on which both dark and light drawings are seen
SIGN = imgui.IM_COL32(12, 13, 16, 255)  # on the paper
SmallPictures = Callable[[int, Bytes], Thumbnail | None]


def draw_list(
    session: Session, look: Look, project: Project, pictures: SmallPictures
) -> list[Action]:
    """Draw the buttons for whole layers, and a row for each layer."""
    actions = _bar(look, project)
    figures = project.document.figures
    pitch = ROW * look.em + imgui.get_style().item_spacing.y
    room = imgui.get_content_region_avail().y - OTHERS * look.em
    shown = min(float(len(figures)), max(FEWEST, room / pitch))
    imgui.begin_child("list", ImVec2(0, shown * pitch))
    frame = playback.current_frame(session, project)
    for figure in reversed(figures):
        is_seen = is_visible(project.document, figure, frame)
        actions += _row(session, look, figure, pictures, is_seen=is_seen)
    # An item: placing the cursor alone gives the list no height.
    imgui.dummy(ImVec2(0, 0))
    _scroll_while_dragged(look)
    imgui.end_child()
    if project.listed != project.active:
        actions.append(do(layering.list_active))
    return actions


def _bar(look: Look, project: Project) -> list[Action]:
    """Draw the buttons for whole layers."""
    actions: list[Action] = []
    active, figures = project.active, project.document.figures
    index, last = figures.index(project.figure), len(figures) - 1

    def button(icon: str, name: str, hint: str, action: Action, *, enabled: bool = True) -> None:
        if icon_button(look, icon, name, hint, enabled=enabled):
            actions.append(action)
        imgui.same_line()

    forward, back = (do(layering.move, active, index + by) for by in (1, -1))
    replace = "Replace the layer's picture by another file: handles, keys and joints stay"
    delete = "Delete the layer" if last else "A scene has at least one layer"
    button(icons.ICON_FA_PLUS, "add layer", "Add a picture as a layer", do(layering.ask))
    button(icons.ICON_FA_CLONE, "copy layer", "Duplicate the layer", do(layering.duplicate, active))
    button(icons.ICON_FA_FILE_IMAGE, "replace picture", replace, do(layering.ask_replace, active))
    button(
        icons.ICON_FA_ARROW_UP, "raise", "Bring the layer forward", forward, enabled=index < last
    )
    button(icons.ICON_FA_ARROW_DOWN, "lower", "Send the layer back", back, enabled=index > 0)
    button(
        icons.ICON_FA_TRASH, "delete layer", delete, do(layering.remove, active), enabled=last > 0
    )
    imgui.new_line()
    return actions


def _row(
    session: Session, look: Look, figure: Figure, pictures: SmallPictures, *, is_seen: bool
) -> list[Action]:
    project = session.project
    if project is None:
        return []
    actions: list[Action] = []
    identity, em = figure.id, look.em
    corner, height = imgui.get_cursor_screen_pos(), ROW * em
    # Below all that follows, which takes the pointer first.
    flags = imgui.SelectableFlags_.allow_overlap | imgui.SelectableFlags_.allow_double_click
    is_active = identity == project.active
    if imgui.selectable(f"###row {identity}", is_active, flags, ImVec2(0, height))[0]:
        actions.append(do(layering.choose, identity))
    after = imgui.get_cursor_screen_pos()
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    if is_active and project.listed != identity and not imgui.is_item_visible():
        imgui.set_scroll_here_y(0.5)
    if imgui.is_mouse_hovering_rect(low, high):
        # While another program drags a file here, nothing else is hovered.
        actions.append(do(layering.point_at, identity))
    is_named = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    actions += _drag(look, project, figure, low, high)
    _tell(figure)
    chosen, asks = _menu(project, figure)
    actions += chosen
    if is_named or asks or session.named_layer == identity:
        imgui.open_popup(f"name {identity}")
        actions.append(do(layering.ask_name, None))
    imgui.set_next_window_pos(low)
    taken = (other.name for other in project.document.figures if other is not figure)
    name = name_popup(look, f"name {identity}", figure.name, taken, "layer")
    if name is not None:
        actions.append(do(layering.rename, identity, name))
    middle = (low.y + high.y) / 2
    imgui.set_cursor_screen_pos(ImVec2(corner.x, middle - imgui.get_frame_height() / 2))
    actions += _switches(look, figure)
    left = imgui.get_item_rect_max().x + GAP * em
    _picture(look, project, figure, ImVec2(left, middle), pictures, is_seen=is_seen)
    _text(look, figure, left + (WIDE + GAP) * em, ImVec2(high.x, middle), is_seen=is_seen)
    imgui.set_cursor_screen_pos(after)
    return actions


def _tell(figure: Figure) -> None:
    """Explain a row, the last item, in a tooltip; its name may be longer than there is room for."""
    if imgui.get_drag_drop_payload_py_id() is None and begin_tip():
        imgui.text_unformatted(figure.name)
        imgui.text_disabled(
            "Drag it to change the order, double-click to rename it, right click for more"
        )
        imgui.end_tooltip()


def _switches(look: Look, figure: Figure) -> list[Action]:
    """Draw the eye and the lock of a row."""
    actions = []
    eye = icons.ICON_FA_EYE_SLASH if figure.hidden else icons.ICON_FA_EYE
    hint = "Show the layer" if figure.hidden else "Hide the layer, also in exports"
    if icon_button(look, eye, f"eye {figure.id}", hint, active=figure.hidden):
        actions.append(do(layering.show, figure.id))
    imgui.same_line(0, 0)
    key = icons.ICON_FA_LOCK if figure.locked else icons.ICON_FA_LOCK_OPEN
    hint = "Let clicks reach the layer" if figure.locked else "Let clicks pass through the layer"
    if icon_button(look, key, f"lock {figure.id}", hint, active=figure.locked):
        actions.append(do(layering.lock, figure.id))
    return actions


def _picture(
    look: Look,
    project: Project,
    figure: Figure,
    left: ImVec2,
    pictures: SmallPictures,
    *,
    is_seen: bool,
) -> None:
    """Draw the small picture of a layer right of a point, or a sign where there is none yet."""
    em = look.em
    pad = 0.12 * em
    half = ROW / 2 * em - pad
    low = ImVec2(left.x, left.y - half)
    high = ImVec2(left.x + WIDE * em, left.y + half)
    draw_list = imgui.get_window_draw_list()
    draw_list.add_rect_filled(low, high, PAPER, 0.25 * em)
    pixels = project.puppets[figure.id].small.value
    picture = None if pixels is None else pictures(figure.id, pixels)
    if picture is None:
        icon = icons.ICON_FA_IMAGE if figure.still else icons.ICON_FA_PERSON
        write_in(low, high, icon, SIGN)
        return
    corner, room = low + ImVec2(pad, pad), high - low - ImVec2(2 * pad, 2 * pad)
    opacity = 1.0 if is_seen else HIDDEN
    show_picture(picture.texture, picture.size, corner, room, opacity=opacity)


def _text(look: Look, figure: Figure, left: float, end: ImVec2, *, is_seen: bool) -> None:
    """Write a layer's name up to a point, and before that what it is besides."""
    palette, em = look.palette, look.em
    draw_list, middle = imgui.get_window_draw_list(), end.y
    signs = [f"{100 * figure.opacity:.0f}%"] if figure.opacity < 1 else []
    signs += [icons.ICON_FA_LINK] if figure.hangs else []
    signs += [icons.ICON_FA_IMAGE] if figure.still else []
    signs += [icons.ICON_FA_BAN] if figure.reference else []
    right = end.x - GAP * em
    with sized(SMALL):
        for sign in reversed(signs):
            size = imgui.calc_text_size(sign)
            right -= size.x
            draw_list.add_text(ImVec2(right, middle - size.y / 2), ink(palette.dim), sign)
            right -= GAP * em
    colour = ink(palette.text if is_seen else palette.dim)
    top = middle - imgui.get_text_line_height() / 2
    draw_list.add_text(ImVec2(left, top), colour, shortened(figure.name, right - left))


def _drag(look: Look, project: Project, figure: Figure, low: ImVec2, high: ImVec2) -> list[Action]:
    """Let a row, the last item, be dragged between two others."""
    actions: list[Action] = []
    if imgui.begin_drag_drop_source():
        imgui.set_drag_drop_payload_py_id(MOVED, figure.id)
        imgui.text(figure.name)
        imgui.end_drag_drop_source()
    if not imgui.begin_drag_drop_target():
        return actions
    flags = imgui.DragDropFlags_
    payload = imgui.accept_drag_drop_payload_py_id(
        MOVED, flags.accept_before_delivery | flags.accept_no_draw_default_rect
    )
    if payload is not None and imgui.is_key_pressed(imgui.Key.escape):
        imgui.internal.clear_drag_drop()
    elif payload is not None:
        is_above = imgui.get_mouse_pos().y < (low.y + high.y) / 2
        y = (low.y if is_above else high.y) - 0.5
        imgui.get_window_draw_list().add_line(
            ImVec2(low.x, y), ImVec2(high.x, y), ink(look.palette.accent), 0.14 * look.em
        )
        others = [each.id for each in project.document.figures if each.id != payload.data_id]
        if figure.id in others and imgui.is_mouse_released(imgui.MouseButton_.left):
            index = others.index(figure.id) + is_above
            actions.append(do(layering.move, payload.data_id, index))
    imgui.end_drag_drop_target()
    return actions


def _scroll_while_dragged(look: Look) -> None:
    """Scroll the list where a row is dragged to its upper or lower edge."""
    payload = imgui.get_drag_drop_payload_py_id()
    if payload is None or payload.type != MOVED:
        return
    top, y = imgui.get_window_pos().y, imgui.get_mouse_pos().y
    bottom, edge = top + imgui.get_window_height(), ROW / 2 * look.em
    by = PULL * look.em * ((y > bottom - edge) - (y < top + edge))
    if by:
        imgui.set_scroll_y(min(max(imgui.get_scroll_y() + by, 0.0), imgui.get_scroll_max_y()))


def _menu(project: Project, figure: Figure) -> tuple[list[Action], bool]:
    """Draw the menu of a row, the last item; return also whether a name is asked for."""
    actions: list[Action] = []
    identity, asks = figure.id, False
    if not imgui.begin_popup_context_item(f"menu of layer {identity}"):
        return actions, asks
    item = imgui.internal.menu_item_ex  # as menu_item_simple, with icons in a column
    asks = item("Rename…", icons.ICON_FA_PEN, BINDINGS["rename layer"].keys_in_words)
    if item("Duplicate", icons.ICON_FA_CLONE):
        actions.append(do(layering.duplicate, identity))
    if item("Replace picture…", icons.ICON_FA_FILE_IMAGE):
        actions.append(do(layering.ask_replace, identity))
    imgui.separator()
    if item("Show" if figure.hidden else "Hide", icons.ICON_FA_EYE):
        actions.append(do(layering.show, identity))
    if item("Unlock" if figure.locked else "Lock", icons.ICON_FA_LOCK):
        actions.append(do(layering.lock, identity))
    if item("Take into exports" if figure.reference else "Reference only", icons.ICON_FA_BAN):
        actions.append(do(layering.refer, identity))
    if item("Let it be posed" if figure.still else "Make it a still picture", icons.ICON_FA_IMAGE):
        turn = layering.stand_up if figure.still else layering.stand_still
        actions.append(do(turn, identity))
    imgui.separator()
    if item("Delete", icons.ICON_FA_TRASH, enabled=len(project.document.figures) > 1):
        actions.append(do(layering.remove, identity))
    imgui.end_popup()
    return actions, asks
