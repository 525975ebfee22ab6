"""The panel of handles: names, weights and targets, and the anchor."""

import math
from collections.abc import Sequence
from dataclasses import replace

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    WEIGHT_PRESETS,
    Handle,
    Target,
    TargetErrors,
    handle_commands,
    measure_target_errors,
)
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, viewing
from app.editor.actions.layer_setup import handle_editing
from app.editor.actions.posing import handles, pose_drag
from app.editor.actions.posing.handles import remove_handles
from app.editor.actions.posing.pose_drag import free_rotation, set_targets
from app.editor.actions.timing import tracks
from app.texts import _, ngettext
from app.ui.panels.handle_settings.anchor import draw_anchor
from app.ui.panels.handle_settings.auto_pin import draw_auto_pin
from app.ui.panels.handle_settings.depth import draw_depth_settings
from app.ui.panels.handle_settings.spring import draw_spring
from app.ui.panels.handle_settings.track import draw_track
from app.ui.shortcuts.widgets import (
    draw_action_button,
    draw_action_main_button,
    draw_action_text_button,
)
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    align_right,
    draw_tooltip,
    heading,
    icon_button,
    label,
    option_buttons,
    shorten_text,
    small_text,
    split_line,
)
from app.ui.viewport.marks import find_auto_pinned

MOST_ROWS = 5.5
WEIGHTS = Scale(left=0.01, right=100.0, logarithmic=True)


def draw_handle_panel(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the list of handles, and the details of the selected handle."""
    if project.layer_runtime.shown is None:
        return []
    layer = project.layer
    if not layer.handles:
        heading(look, _("Handles"))
        small_text(
            look, _("There are no handles yet. Click on the drawing to add one, then drag it, or:")
        )
        return draw_action_main_button(session, look, handles.suggest_handles)
    actions = _heading_with_delete(session, look, project)
    actions += _list(look, project)
    chosen = [handle for handle in layer.handles if handle.id in project.selection.handles]
    if len(chosen) == 1:
        actions += _details(session, look, project, chosen[0])
    elif chosen:
        count = len(chosen)
        heading(look, ngettext("{count} handle", "{count} handles", count).format(count=count))
        small_text(look, _("Drag one of them to move them all. The box turns and scales them."))
        actions += _firmness(session, look, chosen)
        track = layer.track_of(chosen[0].id)
        if track is not None and set(track.handles) >= {handle.id for handle in chosen}:
            actions += draw_track(session, look, project, layer.handle(track.handles[0]))
    else:
        small_text(look, _("Select a handle to see its settings."))
    if len(chosen) != 1 and session.display.tint == "depth":
        actions.append(do(viewing.set_tint, None))
    heading(look, _("Anchor"))
    return actions + draw_anchor(look, project, chosen)


def _heading_with_delete(session: Session, look: Look, project: Project) -> list[Action]:
    heading(look, _("Handles"), framed=True)
    align_right(2 * 1.15 * imgui.get_frame_height() + imgui.get_style().item_inner_spacing.x)
    actions = draw_action_button(session, look, handles.suggest_handles)
    imgui.same_line(0, imgui.get_style().item_inner_spacing.x)
    if icon_button(
        look,
        icons.ICON_FA_TRASH,
        "delete handles",
        _("Delete the selected handles; the pose stays"),
        keys=_("Del"),
        reason=None if project.selection.handles else _("Select a handle first."),
    ):
        actions.append(do(remove_handles, project.selection.handles))
    return actions


def _list(look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    layer = project.layer
    lags = _find_target_errors(project).errors
    style = imgui.get_style()
    rows = min(len(layer.handles), MOST_ROWS) * imgui.get_text_line_height_with_spacing()
    height = rows - style.item_spacing.y + 2 * style.window_padding.y
    imgui.begin_child("handles", ImVec2(0, height), imgui.ChildFlags_.borders)
    clipper = imgui.ListClipper()
    clipper.begin(len(layer.handles), imgui.get_text_line_height_with_spacing())
    while clipper.step():
        for handle in layer.handles[clipper.display_start : clipper.display_end]:
            actions += _row(look, project, handle, lags.get(handle.id))
    imgui.end_child()
    return actions


def _row(look: Look, project: Project, handle: Handle, lag: float | None) -> list[Action]:
    """Draw a row of the list: the handle's name, and its target error in pixels."""
    actions: list[Action] = []
    palette = look.palette
    is_anchor = handle.position == project.layer.anchor
    if imgui.selectable(
        f"###handle {handle.id}",
        handle.id in project.selection.handles,
        imgui.SelectableFlags_.allow_overlap,
    )[0]:
        chosen = frozenset({handle.id})
        keeps = imgui.get_io().key_shift or imgui.get_io().key_ctrl
        actions.append(
            do(editing.select_handles, project.selection.handles ^ chosen if keeps else chosen)
        )
    imgui.same_line(0.8 * look.em)
    usual = icons.ICON_FA_LOCK if handle.locked else icons.ICON_FA_CIRCLE_DOT
    icon = icons.ICON_FA_ANCHOR if is_anchor else usual
    imgui.text_colored(palette.anchor if is_anchor else palette.dim, icon)
    imgui.same_line(2.6 * look.em)
    text = handle.group if lag is None else _("{lag:.0f} px").format(lag=lag)
    beside = imgui.calc_text_size(text).x + 0.6 * look.em
    room = imgui.get_content_region_avail().x - beside
    imgui.text_unformatted(shorten_text(handle.name, room))
    if text:
        align_right(beside - 0.3 * look.em)
        imgui.text_colored(palette.dim if lag is None else palette.warning, text)
    return actions


def _find_target_errors(project: Project) -> TargetErrors:
    """Return the target errors of the shown pose; none for an in-between."""
    shown = project.layer_runtime.shown
    if shown is None or shown.pose is None:
        return TargetErrors(errors={}, at_limits=False)
    return measure_target_errors(shown.clip.layer, shown.pose)


def _details(session: Session, look: Look, project: Project, handle: Handle) -> list[Action]:
    actions: list[Action] = []
    heading(look, shorten_text(handle.name, 0.9 * imgui.get_content_region_avail().x))
    label(look, _("Name"))
    name = imgui.input_text("##name", handle.name)[1]
    if imgui.is_item_deactivated_after_edit() and name.strip() and name != handle.name:
        actions.append(
            do(editing.edit_layer, handle_commands.rename_handle, handle.id, name.strip())
        )
    actions += _firmness(session, look, [handle])
    hint = _("Where the handle is on the drawing at rest, in pixels from the upper left corner")
    label(look, _("At rest"))
    placed = _point(project, "at rest", handle.position, hint)
    if placed is not None:
        actions.append(do(editing.edit_layer, handle_commands.move_handle, handle.id, placed))
    actions += _draw_target(look, project, handle)
    actions += draw_auto_pin(look, project, handle)
    actions += draw_track(session, look, project, handle)
    actions += draw_spring(look, project, handle)
    return actions + draw_depth_settings(session, look, project, handle)


def _firmness(session: Session, look: Look, chosen: Sequence[Handle]) -> list[Action]:
    """Draw the weight of the selected handles, and the buttons that apply to all of them."""
    actions: list[Action] = []
    identities = frozenset(handle.id for handle in chosen)
    weights = {handle.weight for handle in chosen}
    label(look, _("Hold"))
    weight = weights.pop() if len(weights) == 1 else math.nan
    word = next((word for word, value in WEIGHT_PRESETS.items() if value == weight), "")
    taken = option_buttons(look, "hold", [(word, _(word)) for word in WEIGHT_PRESETS], word)
    draw_tooltip(_("How firmly the handle holds its target when other handles pull"))
    if taken is not None:
        weigh = handle_commands.set_handle_weight
        actions.append(do(editing.edit_layer, weigh, identities, WEIGHT_PRESETS[taken]))
    label(look, "")
    hint = _("How strongly the handle pulls, relative to the others: 1 is normal")
    weighed = slider(look, "weight", chosen[0].weight, WEIGHTS, hint=hint)
    if weighed is not None:
        weigh, value = handle_commands.set_handle_weight, float(f"{weighed.value:.3g}")
        actions.append(do(editing.edit_layer, weigh, identities, value))
    third = handle_editing.group_handles if len(chosen) > 1 else handles.mirror_handles
    if any(handle.group for handle in chosen):
        third = handle_editing.ungroup_handles
    pairs = (
        (pose_drag.pin_selected_handles, handle_editing.toggle_handles_locked),
        (third, handle_editing.select_mirrored),
    )
    for pair in pairs:
        for spec, width in zip(pair, split_line(2), strict=True):
            actions += draw_action_text_button(session, spec, width)
    return actions + draw_action_text_button(session, tracks.key_selected_handles, FILL)


def _draw_target(look: Look, project: Project, handle: Handle) -> list[Action]:
    """Draw the handle's target in the pose. Between keys the rows stay, without a target."""
    actions: list[Action] = []
    shown = project.layer_runtime.shown
    identities = [each.id for each in shown.clip.layer.handles] if shown else []
    if shown is None or handle.id not in identities:
        return actions
    target = shown.pose.targets.get(handle.id) if shown.pose else None
    is_wanted = target is not None
    if target is None:
        target = Target(position=complex(shown.handle_positions[identities.index(handle.id)]))
    hint = _("Target of the handle in this pose, in pixels from the upper left corner")
    label(look, _("Target"))
    place = _point(project, "target", target.position, hint)
    if place is not None:
        actions.append(do(set_targets, {handle.id: replace(target, position=place)}))
    actions += _draw_rotation(look, project, handle, target)
    missed = _find_target_errors(project)
    lag = missed.errors.get(handle.id)
    if lag is not None:
        is_coming = project.visible_drag is not None and not project.visible_drag.is_at_rest
        text = (
            _("{lag:.0f} px short of its target, on its way")
            if is_coming
            else _("{lag:.0f} px short of its target, held back by the limits")
            if missed.at_limits
            else _(
                "{lag:.0f} px short of its target, held back by the other handles and the shape's "
                "stiffness"
            )
        )
        small_text(look, text.format(lag=lag), look.palette.warning)
    elif is_wanted:
        small_text(look, "")
    elif handle.id in find_auto_pinned(shown):
        small_text(look, _("Auto-pinned: the handle stays in place until the next key."))
    else:
        small_text(look, _("Between keys the handle moves with the shape."))
    return actions


def _draw_rotation(look: Look, project: Project, handle: Handle, target: Target) -> list[Action]:
    """Draw whether the pose fixes the rotation at a handle, and the angle."""
    label(look, _("Turn"))
    is_turned = target.rotation is not None
    changed, turns = imgui.checkbox("##turns", is_turned)
    draw_tooltip(_("Turn the shape at this handle by an angle, or let it turn freely"))
    if changed and not turns:
        return [do(free_rotation, handle.id)]
    if changed and project.layer_runtime.shown is not None:
        index = [other.id for other in project.layer.handles].index(handle.id)
        now = project.layer_runtime.shown.handle_rotations[index]
        return [do(set_targets, {handle.id: replace(target, rotation=now)})]
    imgui.same_line()
    if target.rotation is None:
        imgui.text_colored(look.palette.dim, _("freely"))
        return []
    imgui.set_next_item_width(FILL)
    entered = number_field("angle", math.degrees(target.rotation), "%.1f°")
    draw_tooltip(_("Counter-clockwise, in degrees; drag the ring around the handle to turn it"))
    if entered is None:
        return []
    return [do(set_targets, {handle.id: replace(target, rotation=math.radians(entered))})]


def _point(project: Project, name: str, place: complex, hint: str) -> complex | None:
    """Draw two fields for a place in screen convention, y down. Return the entered place."""
    height = project.document.canvas[1]
    entered = []
    widths = split_line(2, imgui.get_style().item_inner_spacing.x)
    for axis, at, width in zip("xy", (place.real, height - place.imag), widths, strict=True):
        imgui.set_next_item_width(width)
        entered.append(number_field(f"{name} {axis}", at, "%.1f"))
        draw_tooltip(hint)
    x, y = entered
    if x is None and y is None:
        return None
    return complex(place.real if x is None else x, place.imag if y is None else height - y)
