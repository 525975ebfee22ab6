"""Drag and drop of rows in the tree of layers: between other rows, or onto a row."""

from imgui_bundle import ImVec2, hello_imgui, imgui

from app.document import TreeRow
from app.editor import Action, Project, do
from app.editor.layering.layer_list import add_layers_to_group, move_layers_beside
from app.editor.layering.layer_selection import rest_on_folded_row
from app.editor.layering.parenting import attach_layers, is_same_or_descendant
from app.editor.layering.switches import add_to_switch
from app.texts import ngettext
from app.ui.style.theme import Look, colour_u32

MOVED = "layer"  # type of the drag-and-drop payload
ONTO = 0.25  # share of a row's height at each edge in which a drop is beside the row
PULL = 0.25  # em of scrolling per frame while a row is dragged at the list's edge


def drag_layer_row(
    look: Look, project: Project, row: TreeRow, low: ImVec2, high: ImVec2
) -> list[Action]:
    """Let the last item, a row, be dragged between two other rows or onto a row.

    A drop onto a layer attaches; a drop onto a group or a switch adds a member. The row of a group
    or a switch drags all its layers. Nothing is selected meanwhile, so that no row moves. A folded
    row opens after the pointer has rested on it.
    """
    actions: list[Action] = []
    if imgui.begin_drag_drop_source():
        number = _number_of(row)
        imgui.set_drag_drop_payload_py_id(MOVED, number)
        dragged = _dragged(project, number)
        text, count = row.name, len(dragged)
        if not set(dragged) <= set(row.layers):
            text = ngettext("{count} layer", "{count} layers", count).format(count=count)
        imgui.text(text)
        imgui.end_drag_drop_source()
    if not imgui.begin_drag_drop_target():
        return actions
    flags = imgui.DragDropFlags_
    payload = imgui.accept_drag_drop_payload_py_id(
        MOVED, flags.accept_before_delivery | flags.accept_no_draw_default_rect
    )
    is_cancelled = payload is not None and imgui.is_key_pressed(imgui.Key.escape)
    if payload is not None and not is_cancelled:
        share = (imgui.get_mouse_pos().y - low.y) / max(high.y - low.y, 1.0)
        onto = _onto(project, row, payload.data_id)
        is_onto = onto is not None and (ONTO < share < 1 - ONTO or row.layer is None)
        _show(look, low, high, is_onto=is_onto, is_above=share < 0.5)
        if is_onto and _is_circle(project, row, payload.data_id):
            imgui.set_mouse_cursor(imgui.MouseCursor_.not_allowed)
        is_dropped = imgui.is_mouse_released(imgui.MouseButton_.left)
        if row.toggle and not row.is_open and not is_dropped:
            actions.append(do(rest_on_folded_row, row.toggle))
            # The pointer rests, and yet time goes on.
            hello_imgui.request_refresh()
        if is_dropped:
            if is_onto and onto is not None:
                actions.append(onto)
            elif row.layer is not None:
                actions += _beside(project, row.layer.id, payload.data_id, is_above=share < 0.5)
    imgui.end_drag_drop_target()
    if is_cancelled:
        # Only after the end of the target, which needs the drag.
        imgui.internal.clear_drag_drop()
    return actions


def _number_of(row: TreeRow) -> int:
    """Return a number that stays the same while rows are opened and scrolled."""
    return hash(row.key) & 0x7FFFFFFF


def _dragged(project: Project, number: int) -> tuple[int, ...]:
    """Return the layers of the dragged row: all selected layers if the row's are among them."""
    row = next((each for each in project.tree if _number_of(each) == number), None)
    if row is None:
        return ()
    dragged, chosen = row.layers, project.selected_layers
    return chosen if set(dragged) <= set(chosen) else dragged


def _onto(project: Project, row: TreeRow, number: int) -> Action | None:
    """Return the action of a drop onto a row; None if the drop has no effect."""
    dragged = _dragged(project, number)
    if not dragged or set(row.layers) <= set(dragged):
        return None
    if row.group is not None:
        return do(add_layers_to_group, row.group.name, *dragged)
    if row.switch_group is not None:
        return do(add_to_switch, row.switch_group.name, *dragged)
    # The action refuses a circle, and reports it.
    return do(attach_layers, row.layers[0], *dragged)


def _is_circle(project: Project, row: TreeRow, number: int) -> bool:
    """Return whether a drop would attach layers to their own descendant."""
    return row.layer is not None and any(
        is_same_or_descendant(project, row.layer.id, each) for each in _dragged(project, number)
    )


def _beside(project: Project, identity: int, number: int, *, is_above: bool) -> list[Action]:
    """Return the action of a drop above or below another layer."""
    moved = _dragged(project, number)
    if not moved or identity in moved:
        return []
    return [do(move_layers_beside, identity, is_above, *moved)]


def _show(look: Look, low: ImVec2, high: ImVec2, *, is_onto: bool, is_above: bool) -> None:
    """Mark the place of a drop: a frame around a row, or a line beside it."""
    draw_list, colour = imgui.get_window_draw_list(), colour_u32(look.palette.accent)
    thick = 0.14 * look.em
    if is_onto:
        draw_list.add_rect(low, high, colour, 0.25 * look.em, thickness=thick)
        return
    y = (low.y if is_above else high.y) - 0.5
    draw_list.add_line(ImVec2(low.x, y), ImVec2(high.x, y), colour, thick)


def scroll_while_dragged(look: Look, height: float) -> None:
    """Scroll the list while a row, `height` em high, is dragged to its upper or lower edge."""
    payload = imgui.get_drag_drop_payload_py_id()
    if payload is None or payload.type != MOVED:
        return
    top, y = imgui.get_window_pos().y, imgui.get_mouse_pos().y
    bottom, edge = top + imgui.get_window_height(), height / 2 * look.em
    by = PULL * look.em * ((y > bottom - edge) - (y < top + edge))
    if by:
        imgui.set_scroll_y(min(max(imgui.get_scroll_y() + by, 0.0), imgui.get_scroll_max_y()))
