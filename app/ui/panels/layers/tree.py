"""The tree of layers, front layer on top, with buttons, names and drag and drop."""

from collections.abc import Callable, Sequence

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Document, Layer, TreeRow, is_visible, parent_label, with_repeats
from app.editor import Action, Project, Session, do
from app.editor.actions import playback
from app.editor.layering.layer_list import (
    ask_layer_name,
    duplicate_layer,
    group_layers,
    move_layer,
    note_listed_layer,
    rename_group,
    rename_layer,
    toggle_group_hidden,
    toggle_layers_hidden,
    toggle_layers_locked,
)
from app.editor.layering.layer_selection import (
    select_layers,
    select_layers_up_to,
    set_active_layer,
    toggle_layers_selected,
    toggle_tree_row,
)
from app.editor.layering.parenting import delete_layers
from app.editor.layering.pictures import (
    ask_pictures_to_add,
    ask_replacement_picture,
    set_drop_target,
)
from app.editor.layering.switches import key_switch, rename_switch
from app.render import Thumbnail
from app.texts import _, ngettext
from app.ui.panels.layers.dragging import drag_layer_row, scroll_while_dragged
from app.ui.panels.layers.menus import draw_layer_menu
from app.ui.style.drawing import draw_centred_text
from app.ui.style.theme import SMALL, Look, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    icon_button,
    is_hovered_or_held,
    name_popup,
    push_text_size,
    shorten_text,
    show_picture,
)
from engine.arrays import Bytes

ROW, WIDE, GAP = 2.1, 2.5, 0.35  # em: height of a row, width of its thumbnail, space
INDENT, FOLD = 0.9, 1.2  # em: indent for each level, width of the triangle
DEEPEST_INDENT = 6  # deeper rows have the same indent
FEWEST, OTHERS = 6.5, 20.0  # smallest list in rows; em left for the settings below
RING = 0.4  # em: radius of the circle of a switch's hidden layer
HIDDEN = 0.35  # opacity of thumbnails of layers that are hidden now
PAPER = imgui.IM_COL32(128, 130, 136, 255)  # visible behind both dark and light drawings
SIGN = imgui.IM_COL32(12, 13, 16, 255)  # on the paper
SmallPictures = Callable[[int, Bytes], Thumbnail | None]


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
        if row.layer and row.layer.id in {project.active, session.named_layer}:
            clipper.include_item_by_index(number)
    while clipper.step():
        for row in rows[clipper.display_start : clipper.display_end]:
            actions += _row(session, look, project, row, pictures)
    # An item, because a cursor position alone gives the list no height.
    imgui.dummy(ImVec2(0, 0))
    scroll_while_dragged(look, ROW)
    imgui.end_child()
    if project.last_listed_layer != project.active:
        actions.append(do(note_listed_layer))
    return actions


def _bar(look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    active, layers, chosen = project.active, project.document.layers, project.selected_layers
    index, last = layers.index(project.layer), len(layers) - 1

    def button(icon: str, name: str, hint: str, action: Action, *, enabled: bool = True) -> None:
        if icon_button(look, icon, name, hint, enabled=enabled):
            actions.append(action)
        imgui.same_line()

    forward, back = (do(move_layer, active, index + by) for by in (1, -1))
    count = len(chosen)
    replace = _("Replace the layer's picture by another file: handles, keys and parents stay")
    delete = (
        ngettext("Delete the layer", "Delete the {count} selected layers", count)
        if last
        else _("A scene has at least one layer")
    ).format(count=count)
    group = ngettext(
        "Put the layer in a group", "Put the {count} selected layers in a group", count
    )
    button(
        icons.ICON_FA_PLUS,
        "add layer",
        _("Add a picture as a layer"),
        do(ask_pictures_to_add),
    )
    button(
        icons.ICON_FA_CLONE,
        "copy layer",
        _("Duplicate the layer"),
        do(duplicate_layer, active),
    )
    button(
        icons.ICON_FA_FILE_IMAGE,
        "replace picture",
        replace,
        do(ask_replacement_picture, active),
    )
    button(
        icons.ICON_FA_ARROW_UP, "raise", _("Bring the layer forward"), forward, enabled=index < last
    )
    button(icons.ICON_FA_ARROW_DOWN, "lower", _("Send the layer back"), back, enabled=index > 0)
    button(icons.ICON_FA_FOLDER_PLUS, "group layers", group.format(count=count), do(group_layers))
    button(
        icons.ICON_FA_TRASH,
        "delete layer",
        delete,
        do(delete_layers, *chosen),
        enabled=last > 0,
    )
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
    is_active = layer is not None and layer.id == project.active
    if is_active and project.last_listed_layer != project.active and not imgui.is_item_visible():
        imgui.set_scroll_here_y(0.5)
    if layer is not None and imgui.is_mouse_hovering_rect(low, high):
        # While another program drags a file here, nothing else is hovered.
        actions.append(do(set_drop_target, layer.id))
    is_named = imgui.is_item_hovered() and imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
    actions += drag_layer_row(look, project, row, low, high)
    _draw_tooltip(project.document, row)
    chosen, asks = draw_layer_menu(project, row)
    actions += chosen + _naming(session, look, project, row, low, asks=is_named or asks)
    middle = (low.y + high.y) / 2
    imgui.set_cursor_screen_pos(ImVec2(corner.x, middle - imgui.get_frame_height() / 2))
    frame = playback.current_frame(session, project)
    actions += _switches(look, project, row, frame)
    level, detail = (0, "") if layer is None else parent_label(project.document, layer, frame)
    depth = min(row.depth + level, DEEPEST_INDENT)
    left = imgui.get_item_rect_max().x + (GAP + INDENT * depth) * em
    is_seen = _is_seen(project, row, frame)
    shown = _shown(project.document, row, frame)
    if not row.toggle:
        _picture(look, project, shown, ImVec2(left, middle), pictures, is_seen=is_seen)
    else:
        actions += _fold(look, row, ImVec2(left, middle))
        left += FOLD * em
        if row.switch_group is not None:
            _picture(look, project, shown, ImVec2(left, middle), pictures, is_seen=is_seen)
        else:
            icon = icons.ICON_FA_FOLDER_OPEN if row.is_open else icons.ICON_FA_FOLDER
            box = ImVec2(left, low.y), ImVec2(left + WIDE * em, high.y)
            draw_centred_text(
                *box, icon, colour_u32(look.palette.text if is_seen else look.palette.dim)
            )
    start = left + (WIDE + GAP) * em
    if layer is None:
        # The visible layer of a switch, or the number of layers in a group.
        detail = shown.name if row.switch_group is not None else f"{len(row.layers)}"
    _text(look, project, row, detail, start, ImVec2(high.x, middle), is_seen=is_seen)
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
    return document.layer(with_repeats(document, row.switch_group).layer_at(frame))


def _is_seen(project: Project, row: TreeRow, frame: int) -> bool:
    """Return whether any layer of a row is visible now."""
    document = project.document
    return any(
        is_visible(document, document.layer(each), frame)
        and (not project.solo or each in project.solo)
        for each in row.layers
    )


def _naming(
    session: Session, look: Look, project: Project, row: TreeRow, low: ImVec2, *, asks: bool
) -> list[Action]:
    """Draw the rename field of a row, if requested."""
    actions: list[Action] = []
    document, layer = project.document, row.layer
    if asks or (layer is not None and session.named_layer == layer.id):
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
        return [*actions, do(rename_group, row.group.name, name)]
    return actions


def _draw_tooltip(document: Document, row: TreeRow) -> None:
    """Show the tooltip of the last item, a row, with its full name."""
    if imgui.get_drag_drop_payload_py_id() is not None or not begin_tooltip():
        return
    imgui.text_unformatted(row.name)
    if row.layer is not None:
        for joint in row.layer.attachments:
            name = _("nothing") if joint.parent is None else document.layer(joint.parent).name
            text = (
                _("Attached to {name} from frame {frame} on")
                if len(row.layer.attachments) > 1
                else _("Attached to {name}")
            )
            imgui.text_unformatted(text.format(name=name, frame=joint.frame))
        imgui.text_disabled(
            _(
                "Drag it to change the order, or onto another row to attach it there. Double-click "
                "to rename it. Right-click for more."
            )
        )
    elif row.switch_group is not None:
        imgui.text_disabled(
            _(
                "Exactly one of these layers is visible. Open the switch and click on a circle to "
                "show that layer from here on."
            )
        )
    else:
        imgui.text_disabled(
            _(
                "Click to select all layers in it. Drag it to move or attach them together. "
                "Right-click for more."
            )
        )
    imgui.end_tooltip()


def _fold(look: Look, row: TreeRow, left: ImVec2) -> list[Action]:
    em = look.em
    low = ImVec2(left.x, left.y - ROW / 2 * em)
    imgui.set_cursor_screen_pos(low)
    imgui.set_next_item_allow_overlap()
    clicked = imgui.invisible_button(f"fold {row.key}", ImVec2(FOLD * em, ROW * em))
    icon = icons.ICON_FA_CARET_DOWN if row.is_open else icons.ICON_FA_CARET_RIGHT
    colour = colour_u32(look.palette.text if is_hovered_or_held() else look.palette.dim)
    draw_centred_text(low, low + ImVec2(FOLD * em, ROW * em), icon, colour)
    return [do(toggle_tree_row, row.toggle)] if clicked else []


def _switches(look: Look, project: Project, row: TreeRow, frame: int) -> list[Action]:
    """Draw the eye and the lock of a row. Layers of a switch have a circle instead of the eye."""
    actions = []
    document = project.document
    layers = [document.layer(each) for each in row.layers]
    switch_group = None if row.layer is None else document.switch_group_of(row.layer.id)
    if switch_group is not None:
        is_on = with_repeats(document, switch_group).layer_at(frame) == row.layers[0]
        icon = icons.ICON_FA_CIRCLE_DOT if is_on else ""
        text = _("Show from frame {frame} on, in place of the other layers of {name}")
        hint = text.format(frame=frame, name=switch_group.name)
        if icon_button(look, icon, f"turn {row.key}", hint, active=is_on):
            actions.append(do(key_switch, row.layers[0]))
        if not is_on:
            _ring(look)
    elif row.switch_group is not None:
        imgui.dummy(ImVec2(1.15 * imgui.get_frame_height(), imgui.get_frame_height()))
    else:
        group = row.group
        hidden = layers[0].hidden if group is None else group.hidden
        eye = icons.ICON_FA_EYE_SLASH if hidden else icons.ICON_FA_EYE
        if group is None:
            hint = _("Show the layer") if hidden else _("Hide the layer, also in exports")
        else:
            hint = _("Show the group") if hidden else _("Hide the group, also in exports")
        if icon_button(look, eye, f"eye {row.key}", hint, active=hidden):
            actions.append(
                do(toggle_layers_hidden, *_of_chosen(project, row))
                if group is None
                else do(toggle_group_hidden, group.name)
            )
    imgui.same_line(0, 0)
    locked = all(layer.locked for layer in layers)
    key = icons.ICON_FA_LOCK if locked else icons.ICON_FA_LOCK_OPEN
    hint = (
        _("Unlock: clicks reach the layer") if locked else _("Lock: clicks pass through the layer")
    )
    if icon_button(look, key, f"lock {row.key}", hint, active=locked):
        actions.append(do(toggle_layers_locked, *_of_chosen(project, row)))
    return actions


def _ring(look: Look) -> None:
    """Draw an empty circle on the last item, because the icon font has only a full one."""
    middle = (imgui.get_item_rect_min() + imgui.get_item_rect_max()) / 2
    radius, thick = RING * look.em, 0.1 * look.em
    imgui.get_window_draw_list().add_circle(
        middle, radius, colour_u32(look.palette.text), thickness=thick
    )


def _of_chosen(project: Project, row: TreeRow) -> tuple[int, ...]:
    """Return the layers that a row's button changes: the row's, or all selected ones."""
    chosen = project.selected_layers
    return chosen if set(row.layers).issubset(chosen) and len(chosen) > 1 else row.layers


def _picture(
    look: Look,
    project: Project,
    layer: Layer,
    left: ImVec2,
    pictures: SmallPictures,
    *,
    is_seen: bool,
) -> None:
    """Draw a layer's thumbnail right of a point, or an icon before the thumbnail is ready."""
    em = look.em
    pad = 0.12 * em
    half = ROW / 2 * em - pad
    low = ImVec2(left.x, left.y - half)
    high = ImVec2(left.x + WIDE * em, left.y + half)
    draw_list = imgui.get_window_draw_list()
    draw_list.add_rect_filled(low, high, PAPER, 0.25 * em)
    pixels = project.layer_runtimes[layer.id].small.value
    picture = None if pixels is None else pictures(layer.id, pixels)
    if picture is None:
        icon = icons.ICON_FA_IMAGE if layer.still else icons.ICON_FA_PERSON
        draw_centred_text(low, high, icon, SIGN)
        return
    corner, room = low + ImVec2(pad, pad), high - low - ImVec2(2 * pad, 2 * pad)
    opacity = 1.0 if is_seen else HIDDEN
    show_picture(picture.texture, picture.size, corner, room, opacity=opacity)


def _signs(project: Project, row: TreeRow) -> list[str]:
    if row.layer is None:
        opacity = 1.0 if row.group is None else row.group.opacity
        return [f"{100 * opacity:.0f}%"] if opacity < 1 else []
    layer = row.layer
    signs = [f"{100 * layer.opacity:.0f}%"] if layer.opacity < 1 else []
    signs += [icons.ICON_FA_LINK] if layer.has_parent else []
    signs += [icons.ICON_FA_IMAGE] if layer.still else []
    signs += [icons.ICON_FA_BAN] if layer.reference else []
    return signs + ([icons.ICON_FA_BINOCULARS] if layer.id in project.solo else [])


def _text(
    look: Look,
    project: Project,
    row: TreeRow,
    detail: str,
    left: float,
    end: ImVec2,
    *,
    is_seen: bool,
) -> None:
    """Write a row's name, the detail behind it, and its signs left of `end`."""
    palette, em = look.palette, look.em
    draw_list, middle = imgui.get_window_draw_list(), end.y
    right = end.x - GAP * em
    with push_text_size(SMALL):
        for sign in reversed(_signs(project, row)):
            size = imgui.calc_text_size(sign)
            right -= size.x
            draw_list.add_text(ImVec2(right, middle - size.y / 2), colour_u32(palette.dim), sign)
            right -= GAP * em
    top = middle - imgui.get_text_line_height() / 2
    name = shorten_text(row.name, right - left)
    draw_list.add_text(
        ImVec2(left, top), colour_u32(palette.text if is_seen else palette.dim), name
    )
    left += imgui.calc_text_size(name).x + 2 * GAP * em
    with push_text_size(SMALL):
        size = imgui.calc_text_size(detail)
        if detail and right - left > 2 * em:
            detail = shorten_text(detail, right - left)
            draw_list.add_text(ImVec2(left, middle - size.y / 2), colour_u32(palette.dim), detail)
