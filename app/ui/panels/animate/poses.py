"""The library of poses: thumbnails that can be applied, blended in, or dragged to the timeline."""

from collections.abc import Sequence
from itertools import groupby

from imgui_bundle import ImVec2, imgui

from app.document import LibraryPose, format_pairs, pose_commands
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, viewing
from app.editor.poses import flipping, library, pasting
from app.texts import _
from app.ui.panels.animate.sliders import Pictures
from app.ui.shortcuts.widgets import draw_action_button, draw_action_text_button
from app.ui.style.sliders import Scale, number_field, slider_track
from app.ui.style.theme import SMALL, Look, colour_u32, pixel_density
from app.ui.style.widgets import (
    POSE_PAYLOAD,
    align_right,
    draw_tooltip,
    heading,
    label,
    name_popup,
    push_text_size,
    shorten_text,
    small_text,
    split_line,
    text_button,
)

TILE, LEAST_GAP = 6.6, 0.6  # em: side of a thumbnail, smallest distance
SHARES = Scale(left=0.0, right=1.0)


def draw_poses(session: Session, look: Look, project: Project, pictures: Pictures) -> list[Action]:
    """Draw the library's poses as thumbnails."""
    heading(look, _("Poses"), framed=True)
    align_right(1.15 * imgui.get_frame_height())
    actions = draw_action_button(session, look, library.save_pose_to_library)
    offers = library.list_library_poses(project)
    if offers:
        actions += _libraries(look, project, offers, pictures)
        small_text(
            look,
            _(
                "Click a pose to use it at this frame, drag it onto the timeline, or drag the bar "
                "below it to blend it in."
            ),
        )
    else:
        small_text(look, _("Save a pose to use it again, at any frame, whole or blended in."))
    return actions


def _libraries(
    look: Look, project: Project, offers: Sequence[library.PoseOffer], pictures: Pictures
) -> list[Action]:
    """Draw the layer's own poses, then the poses of each other layer below its name."""
    actions: list[Action] = []
    numbered = enumerate(offers)
    for owner, group in groupby(numbered, key=lambda each: each[1].owner.id):
        if owner != project.selection.active:
            name = project.document.layer(owner).name
            name = shorten_text(name, imgui.get_content_region_avail().x - 4 * look.em)
            title = _("Of {name}").format(name=name)
            if not imgui.tree_node_ex(f"{title}###of {owner}", imgui.TreeNodeFlags_.default_open):
                continue
        imgui.push_id(owner)
        actions += _tiles(look, project, list(group), pictures)
        imgui.pop_id()
        if owner != project.selection.active:
            imgui.tree_pop()
    return actions


def _tiles(
    look: Look,
    project: Project,
    offers: Sequence[tuple[int, library.PoseOffer]],
    pictures: Pictures,
) -> list[Action]:
    actions: list[Action] = []
    room, em = imgui.get_content_region_avail().x, look.em
    side = TILE * em
    columns = max(1, int((room + LEAST_GAP * em) // (side + LEAST_GAP * em)))
    gap = (room - columns * side) / max(columns - 1, 1)
    left = imgui.get_cursor_pos_x()
    for place, (index, (owner, kept)) in enumerate(offers):
        if place % columns:
            imgui.same_line(left + (place % columns) * (side + gap))
        imgui.begin_group()
        imgui.push_id(kept.name)
        texture = pictures(owner.id, kept.pose, round(TILE * em * pixel_density()))
        actions += _tile(look, project, library.PoseOffer(owner, kept), index, texture)
        actions += _blend(look, project, library.PoseOffer(owner, kept), side)
        if owner.id == project.selection.active:
            taken = (other.name for other in owner.library if other is not kept)
            name = name_popup(look, "name", kept.name, taken, _("Another pose has this name."))
            if name is not None:
                actions.append(do(library.rename_library_pose, kept.name, name))
        imgui.pop_id()
        imgui.end_group()
    return actions


def _tile(
    look: Look, project: Project, offer: library.PoseOffer, index: int, texture: int | None
) -> list[Action]:
    owner, kept = offer
    palette, draw_list, em = look.palette, imgui.get_window_draw_list(), look.em
    actions: list[Action] = []
    low = imgui.get_cursor_screen_pos()
    size = ImVec2(TILE * em, (TILE + 1.1) * em)
    if imgui.invisible_button(f"pose {kept.name}", size):
        actions.append(do(library.apply_library_pose, kept.name, owner.id))
    hot = imgui.is_item_hovered()
    high = low + ImVec2(TILE * em, TILE * em)
    draw_list.add_rect_filled(low, high, colour_u32(palette.desk), 0.4 * em)
    if texture is not None:
        _show(texture, low, high, 0.4 * em)
    is_picked = (owner.id, kept.name) == project.pose_edits.picked_pose
    if hot or is_picked:
        draw_list.add_rect(
            low, high, colour_u32(palette.accent, 1.0 if hot else 0.6), 0.4 * em, 1.5
        )
    with push_text_size(SMALL):
        text = shorten_text(kept.name, TILE * em)
        x = (low.x + high.x - imgui.calc_text_size(text).x) / 2
        colour = palette.text if hot or is_picked else palette.dim
        draw_list.add_text(ImVec2(x, high.y + 0.15 * em), colour_u32(colour), text)
    if imgui.begin_drag_drop_source():
        imgui.set_drag_drop_payload_py_id(POSE_PAYLOAD, index)
        corner = imgui.get_cursor_screen_pos()
        imgui.dummy(ImVec2(TILE * em / 2, TILE * em / 2))
        if texture is not None:
            _show(texture, corner, imgui.get_item_rect_max(), 0.2 * em)
        imgui.end_drag_drop_source()
    text = _("{name}: click to use it at this frame, right-click for more")
    draw_tooltip(text.format(name=kept.name))
    return actions + _menu(kept, owner.id, is_own=owner.id == project.selection.active)


def _show(texture: int, low: ImVec2, high: ImVec2, rounding: float) -> None:
    imgui.get_window_draw_list().add_image_rounded(
        imgui.ImTextureRef(texture),
        low,
        high,
        ImVec2(0, 1),
        ImVec2(1, 0),
        imgui.IM_COL32(255, 255, 255, 255),
        rounding,
    )


def _blend(look: Look, project: Project, offer: library.PoseOffer, width: float) -> list[Action]:
    begun, name, owner = project.pose_edits.blend_preview, offer.kept.name, offer.owner.id
    is_this = begun is not None and (begun.name, begun.owner) == (name, owner)
    share = begun.share if begun is not None and is_this else 0.0
    # Close to the name above.
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 0.5 * look.em)
    moved = slider_track(look, "blend", share, SHARES, width, colour=look.palette.accent)
    draw_tooltip(
        _("{share:.0%} blended in").format(share=share)
        if share
        else _("Drag to blend it into the current pose")
    )
    if moved is None:
        return []
    actions = [do(library.blend_library_pose, name, moved.value, owner)]
    return [*actions, do(library.end_pose_blend)] if moved.is_final else actions


def _menu(kept: LibraryPose, owner: int, *, is_own: bool) -> list[Action]:
    actions: list[Action] = []
    asks = False
    if imgui.begin_popup_context_item("menu"):
        if imgui.menu_item_simple(_("Use at this frame"), _("Click")):
            actions.append(do(library.apply_library_pose, kept.name, owner))
        asks = is_own and imgui.menu_item_simple(_("Rename…"))
        if is_own and imgui.menu_item_simple(_("Delete")):
            actions.append(do(editing.edit_layer, pose_commands.delete_pose, kept.name))
        imgui.end_popup()
    if asks:
        imgui.open_popup("name")
    return actions


def draw_flip(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the buttons that flip poses, with their axis and the names of pairs."""
    layer, actions = project.layer, list[Action]()
    widths = split_line(2)
    for spec in (pasting.PASTE_FLIPPED, pasting.PASTE_SWAPPED):
        actions += draw_action_text_button(session, spec, next(widths))
    label(look, _("Axis"))
    if imgui.checkbox("##axis", session.display.overlays.mirror)[0]:
        actions.append(do(viewing.toggle_overlay, "mirror"))
    draw_tooltip(_("Show the axis in the viewport, to drag it by its grip"))
    imgui.same_line()
    button = 6 * look.em
    gap = imgui.get_style().item_inner_spacing.x
    imgui.set_next_item_width(imgui.get_content_region_avail().x - button - gap)
    placed = number_field("axis x", layer.axis, "%.1f")
    draw_tooltip(_("In pixels from the left edge"))
    if placed is not None:
        actions.append(do(flipping.set_mirror_axis, placed))
    imgui.same_line(0, gap)
    hint = _("Put the axis in the middle of the pairs of handles, or of the shape")
    reason = _("The axis is already in the middle.") if layer.mirror is None else None
    if text_button(_("Middle"), button, hint, reason=reason):
        actions.append(do(flipping.set_mirror_axis, None))
    label(look, _("Pairs"))
    text = imgui.input_text("##pairs", format_pairs(project.document.pairs))[1]
    if imgui.is_item_deactivated_after_edit():
        actions.append(do(pasting.set_mirror_names, text))
    draw_tooltip(
        _("Two words for the two sides, or two whole names, with a slash between: L/R, near/far")
    )
    small_text(
        look,
        _(
            "Layers and handles form pairs by name, such as “paw.L” and “paw.R”, or by place. "
            "“Flipped” mirrors the pose, “swapped” does not."
        ),
    )
    return actions
