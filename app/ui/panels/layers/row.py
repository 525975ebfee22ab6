"""The parts of a row in the tree of layers: thumbnail, texts, switches, tooltip."""

from collections.abc import Callable

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import Document, Layer, TreeRow, with_repeats
from app.editor import Action, Project, do
from app.editor.layering.layer_list import (
    toggle_group_hidden,
    toggle_layers_hidden,
    toggle_layers_locked,
)
from app.editor.layering.layer_selection import toggle_tree_row
from app.editor.layering.switches import key_switch
from app.errors import display_name, join_names
from app.render import Thumbnail
from app.texts import _
from app.ui.style.drawing import draw_centred_text, show_picture
from app.ui.style.theme import SMALL, Look, colour_u32
from app.ui.style.widgets import (
    begin_tooltip,
    icon_button,
    is_hovered_or_held,
    push_text_size,
    shorten_text,
)
from engine.arrays import Bytes

SmallPictures = Callable[[int, Bytes], Thumbnail | None]
ROW, WIDE, GAP = 2.1, 2.5, 0.35  # em: height of a row, width of its thumbnail, space
INDENT, FOLD = 0.9, 1.2  # em: indent for each level, width of the triangle
RING = 0.4  # em: radius of the circle of a switch's hidden layer
HIDDEN = 0.35  # opacity of thumbnails of layers that are hidden now
PAPER = imgui.IM_COL32(128, 130, 136, 255)  # visible behind both dark and light drawings
SIGN = imgui.IM_COL32(12, 13, 16, 255)  # on the paper


def draw_row_tooltip(document: Document, row: TreeRow) -> None:
    """Show the tooltip of the last item, a row, with its full name."""
    if imgui.get_drag_drop_payload_py_id() is not None or not begin_tooltip():
        return
    imgui.text_unformatted(row.name)
    if row.layer is not None:
        members = document.deform_members(row.layer.id)
        if members:
            text = _("Bends as one: {layers}")
            names = join_names([each.name for each in reversed(members)])
            imgui.text_unformatted(display_name(text.format(layers=names)))
        there, drawing = document.file_layer_of(row.layer), document.drawing_of(row.layer)
        if there is not None and there.is_missing and drawing is not None:
            text = _("No longer in {name}").format(name=drawing.name)
            imgui.text_unformatted(display_name(text))
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
                "Drag to change the order, or onto another layer to attach it. Double-click to "
                "rename. Right-click for more."
            )
        )
    elif row.switch_group is not None:
        imgui.text_disabled(
            _(
                "Exactly one of these layers is visible. Open the switch and click a circle to "
                "show its layer from this frame on."
            )
        )
    else:
        imgui.text_disabled(
            _(
                "Click to select all its layers. Drag to move or attach them together. "
                "Right-click for more."
            )
        )
    imgui.end_tooltip()


def draw_fold(look: Look, row: TreeRow, left: ImVec2) -> list[Action]:
    em = look.em
    low = ImVec2(left.x, left.y - ROW / 2 * em)
    imgui.set_cursor_screen_pos(low)
    imgui.set_next_item_allow_overlap()
    clicked = imgui.invisible_button(f"fold {row.key}", ImVec2(FOLD * em, ROW * em))
    icon = icons.ICON_FA_CARET_DOWN if row.is_open else icons.ICON_FA_CARET_RIGHT
    colour = colour_u32(look.palette.text if is_hovered_or_held() else look.palette.dim)
    draw_centred_text(low, low + ImVec2(FOLD * em, ROW * em), icon, colour)
    return [do(toggle_tree_row, row.toggle)] if clicked else []


def draw_row_switches(look: Look, project: Project, row: TreeRow, frame: int) -> list[Action]:
    """Draw the eye and the lock of a row. Layers of a switch have a circle instead of the eye."""
    actions = []
    document = project.document
    layers = [document.layer(each) for each in row.layers]
    member = row.member
    switch_group = None if member is None else document.switch_group_of(member)
    if switch_group is not None and member is not None:
        is_on = with_repeats(document, switch_group).member_at(frame) == member
        icon = icons.ICON_FA_CIRCLE_DOT if is_on else ""
        text = _("Show from frame {frame} on, instead of the others in {name}")
        hint = text.format(frame=frame, name=switch_group.name)
        if icon_button(look, icon, f"turn {row.key}", hint, active=is_on):
            actions.append(do(key_switch, member))
        if not is_on:
            _ring(look)
    elif row.switch_group is not None:
        imgui.dummy(ImVec2(1.15 * imgui.get_frame_height(), imgui.get_frame_height()))
    else:
        group = row.group
        hidden = layers[0].hidden if group is None else group.hidden
        eye = icons.ICON_FA_EYE_SLASH if hidden else icons.ICON_FA_EYE
        if group is None:
            hint = _("Show the layer") if hidden else _("Hide the layer, in exports too")
        else:
            hint = _("Show the group") if hidden else _("Hide the group, in exports too")
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


def draw_row_picture(
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
    pixels = project.runtimes.layers[layer.id].small.value
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
    if layer.deform_group is not None or project.document.is_deform_group(layer.id):
        signs += [icons.ICON_FA_OBJECT_GROUP]
    elif layer.still:
        signs += [icons.ICON_FA_IMAGE]
    signs += [icons.ICON_FA_BAN] if layer.reference else []
    return signs + ([icons.ICON_FA_BINOCULARS] if layer.id in project.layer_list.solo else [])


def draw_row_text(
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
