"""The tree of layers, front layer on top, with buttons, names and drag and drop."""

from collections.abc import Sequence

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    Document,
    Layer,
    TreeRow,
    group_commands,
    is_visible,
    layer_commands,
    parent_label,
    with_repeats,
)
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback
from app.editor.layering.deletion import delete_layers
from app.editor.layering.layer_list import (
    ask_layer_name,
    duplicate_layer,
    group_layers,
    note_listed_layer,
    rename_layer,
)
from app.editor.layering.layer_selection import (
    select_layers,
    select_layers_up_to,
    set_active_layer,
    toggle_layers_selected,
)
from app.editor.layering.pictures import (
    ask_pictures_to_add,
    ask_replacement_picture,
    set_drop_target,
)
from app.editor.layering.switches import rename_switch
from app.texts import _, ngettext
from app.ui.bars.layer_menus import draw_layer_menu
from app.ui.panels.layers.dragging import drag_layer_row, scroll_while_dragged
from app.ui.panels.layers.row import (
    FOLD,
    GAP,
    INDENT,
    ROW,
    WIDE,
    SmallPictures,
    draw_fold,
    draw_row_picture,
    draw_row_switches,
    draw_row_text,
    draw_row_tooltip,
)
from app.ui.style.drawing import draw_centred_text
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import icon_button, name_popup

DEEPEST_INDENT = 6  # deeper rows have the same indent
BUTTONS, BUTTON = 7, 1.15  # number of buttons, and the width of one in heights of a line
FEWEST, OTHERS = 6.5, 20.0  # smallest list in rows; em left for the settings below


def draw_layer_tree(
    session: Session, look: Look, project: Project, pictures: SmallPictures
) -> list[Action]:
    """Draw the buttons for whole layers, and a row for each group, switch and layer."""
    actions = _bar(look, project)
    rows = project.tree
    pitch = ROW * look.em + imgui.get_style().item_spacing.y
    room = imgui.get_content_region_avail().y - OTHERS * look.em
    shown = min(float(len(rows)), max(FEWEST, room / pitch))
    imgui.begin_child("list", ImVec2(0, shown * pitch))
    clipper = imgui.ListClipper()
    clipper.begin(len(rows), pitch)
    for number, row in enumerate(rows):
        # Scroll to the active layer, and to a layer that is being renamed.
        if row.layer and row.layer.id in {project.selection.listed, project.layer_list.named_layer}:
            clipper.include_item_by_index(number)
    while clipper.step():
        for row in rows[clipper.display_start : clipper.display_end]:
            actions += _row(session, look, project, row, pictures)
    # An item, because a cursor position alone gives the list no height.
    imgui.dummy(ImVec2(0, 0))
    scroll_while_dragged(look, ROW)
    imgui.end_child()
    if project.layer_list.last_listed_layer != project.selection.listed:
        actions.append(do(note_listed_layer))
    return actions


def _bar(look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    active, layers, chosen = (
        project.selection.listed,
        project.document.layers,
        project.selected_layers,
    )
    index, last = layers.index(project.listed_layer), len(layers) - 1
    width = BUTTON * imgui.get_frame_height()
    free = imgui.get_content_region_avail().x - BUTTONS * width
    gap = max(min(imgui.get_style().item_spacing.x, free / (BUTTONS - 1)), 0.0)

    def button(icon: str, name: str, hint: str, action: Action, reason: str | None = None) -> None:
        if icon_button(look, icon, name, hint, reason=reason):
            actions.append(action)
        imgui.same_line(0, gap)

    forward, back = (
        do(editing.edit_document, layer_commands.move_layer(active, index + by)) for by in (1, -1)
    )
    count = len(chosen)
    replace = _("Replace the layer's picture with another file. Handles, keys and parents stay.")
    delete = ngettext("Delete the layer", "Delete the {count} selected layers", count)
    alone = None if last else _("A scene needs at least one layer.")
    highest = None if index < last else _("The layer is already in front of all others.")
    lowest = None if index else _("The layer is already behind all others.")
    group = ngettext(
        "Put the layer in a group", "Put the {count} selected layers in a group", count
    )
    button(icons.ICON_FA_PLUS, "add layer", _("Add a picture as a layer"), do(ask_pictures_to_add))
    duplicate = do(duplicate_layer, active)
    button(icons.ICON_FA_CLONE, "copy layer", _("Duplicate the layer"), duplicate)
    ask = do(ask_replacement_picture, active)
    is_group = project.document.is_deform_group(active)
    members = _("Its picture is made from its members. Replace the picture of one of them.")
    reason = members if is_group else None
    button(icons.ICON_FA_FILE_IMAGE, "replace picture", replace, ask, reason)
    button(icons.ICON_FA_ARROW_UP, "raise", _("Bring the layer forward"), forward, highest)
    button(icons.ICON_FA_ARROW_DOWN, "lower", _("Send the layer back"), back, lowest)
    button(icons.ICON_FA_FOLDER_PLUS, "group layers", group.format(count=count), do(group_layers))
    delete = delete.format(count=count)
    button(icons.ICON_FA_TRASH, "delete layer", delete, do(delete_layers, *chosen), alone)
    imgui.new_line()
    return actions


def _row(
    session: Session, look: Look, project: Project, row: TreeRow, pictures: SmallPictures
) -> list[Action]:
    actions: list[Action] = []
    em, layer = look.em, row.layer
    corner, height = imgui.get_cursor_screen_pos(), ROW * em
    # Below all later items, which take the pointer first.
    flags = imgui.SelectableFlags_.allow_overlap | imgui.SelectableFlags_.allow_double_click
    is_chosen = set(project.selected_layers).issuperset(row.layers)
    if imgui.selectable(f"###row {row.key}", is_chosen, flags, ImVec2(0, height))[0]:
        actions.append(_chosen(row))
    after = imgui.get_cursor_screen_pos()
    low, high = imgui.get_item_rect_min(), imgui.get_item_rect_max()
    is_active = layer is not None and layer.id == project.selection.listed
    if (
        is_active
        and project.layer_list.last_listed_layer != project.selection.listed
        and not imgui.is_item_visible()
    ):
        imgui.set_scroll_here_y(0.5)
    if layer is not None and imgui.is_mouse_hovering_rect(low, high):
        # While another program drags a file here, nothing else is hovered.
        actions.append(do(set_drop_target, layer.id))
    is_named = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    actions += drag_layer_row(look, project, row, low, high)
    draw_row_tooltip(project.document, row)
    chosen, asks = draw_layer_menu(project, row)
    actions += chosen + _naming(look, project, row, low, asks=is_named or asks)
    middle = (low.y + high.y) / 2
    imgui.set_cursor_screen_pos(ImVec2(corner.x, middle - imgui.get_frame_height() / 2))
    frame = playback.current_frame(session, project)
    actions += draw_row_switches(look, project, row, frame)
    detail = "" if layer is None else parent_label(project.document, layer, frame)
    # Indents are those of groups; a sign and a label tell the parent.
    depth = min(row.depth, DEEPEST_INDENT)
    left = imgui.get_item_rect_max().x + (GAP + INDENT * depth) * em
    is_seen = _is_seen(project, row, frame)
    shown = _shown(project.document, row, frame)
    if not row.toggle:
        draw_row_picture(look, project, shown, ImVec2(left, middle), pictures, is_seen=is_seen)
    else:
        actions += draw_fold(look, row, ImVec2(left, middle))
        left += FOLD * em
        if row.switch_group is not None:
            draw_row_picture(look, project, shown, ImVec2(left, middle), pictures, is_seen=is_seen)
        else:
            icon = icons.ICON_FA_FOLDER_OPEN if row.is_open else icons.ICON_FA_FOLDER
            box = ImVec2(left, low.y), ImVec2(left + WIDE * em, high.y)
            draw_centred_text(
                *box, icon, colour_u32(look.palette.text if is_seen else look.palette.dim)
            )
    start = left + (WIDE + GAP) * em
    if layer is None:
        # The visible member of a switch, or the number of layers in a group.
        detail = f"{len(row.layers)}"
        if row.switch_group is not None:
            document = project.document
            seen = with_repeats(document, row.switch_group).member_at(frame)
            detail = document.member_name(seen)
    draw_row_text(look, project, row, detail, start, ImVec2(high.x, middle), is_seen=is_seen)
    imgui.set_cursor_screen_pos(after)
    return actions


def _chosen(row: TreeRow) -> Action:
    """Return the action of a click on a row: Ctrl toggles, Shift selects a range."""
    io = imgui.get_io()
    if io.key_ctrl:
        return do(toggle_layers_selected, *row.layers)
    if io.key_shift:
        return do(select_layers_up_to, row.layers[-1])
    if row.layer is not None:
        return do(set_active_layer, row.layer.id)
    return do(select_layers, *row.layers)


def _shown(document: Document, row: TreeRow, frame: int) -> Layer:
    """Return the layer of a row's thumbnail: of a switch, its visible layer."""
    if row.switch_group is None:
        return document.layer(row.layers[0])
    seen = with_repeats(document, row.switch_group).member_at(frame)
    return (*reversed(document.member_layers(seen)), document.layer(row.layers[0]))[0]


def _is_seen(project: Project, row: TreeRow, frame: int) -> bool:
    """Return whether any layer of a row is visible now."""
    document = project.document
    return any(
        is_visible(document, document.layer(each), frame)
        and (not project.layer_list.solo or each in project.layer_list.solo)
        for each in row.layers
    )


def _naming(look: Look, project: Project, row: TreeRow, low: ImVec2, *, asks: bool) -> list[Action]:
    """Draw the rename field of a row, if requested."""
    actions: list[Action] = []
    document, layer = project.document, row.layer
    if asks or (layer is not None and project.layer_list.named_layer == layer.id):
        imgui.open_popup(f"name {row.key}")
        actions.append(do(ask_layer_name, None))
    imgui.set_next_window_pos(low)
    taken: Sequence[str] = ()
    refusal = _("Another layer has this name.")
    if layer is not None:
        taken = [other.name for other in document.layers if other is not layer]
    elif row.switch_group is not None:
        refusal = _("Another switch has this name.")
        taken = [other.name for other in document.switch_groups if other is not row.switch_group]
    name = name_popup(look, f"name {row.key}", row.name, taken, refusal)
    if name is None:
        return actions
    if layer is not None:
        return [*actions, do(rename_layer, layer.id, name)]
    if row.switch_group is not None:
        return [*actions, do(rename_switch, row.switch_group.name, name)]
    if row.group is not None:
        return [
            *actions,
            do(editing.edit_document, group_commands.rename_group(row.group.name, name)),
        ]
    return actions
