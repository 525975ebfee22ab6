"""Pose sliders of the active layer: dragged live, with pictures of their poses."""

from collections.abc import Callable
from dataclasses import replace
from math import expm1
from typing import Any

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.document import (
    BEYOND,
    SLIDER,
    SPRING_PRESETS,
    Channel,
    Document,
    Layer,
    Pose,
    Slider,
    format_slider_value,
    slider_commands,
    value_at,
)
from app.editor import Action, Project, Session, do
from app.editor.actions import editing, playback
from app.editor.actions.timing.channel_keys import set_channel_value
from app.editor.poses import sliders
from app.motion import LayerFrame
from app.texts import _, ngettext
from app.ui.panels.animate.new_slider import NEW_SLIDER, draw_new_slider
from app.ui.panels.handle_settings.spring import PRESET_NAMES
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.style.sliders import Scale, number_field, slider_track
from app.ui.style.theme import SMALL, Look, colour_u32, pixel_density
from app.ui.style.widgets import (
    align_right,
    draw_tooltip,
    heading,
    icon_button,
    name_popup,
    push_text_size,
    shorten_text,
    small_text,
)

TILE, PAD, FIELD = 2.9, 9.0, 3.6  # em: sides of a thumbnail and of a pad, width of a number
DELAYS = (0, 1, 2, 3, 4, 6, 8, 12)
REACHED = 1e-3  # change of ln |f_z| that counts as curbed
# From a layer's id, a pose and a size in pixels to a texture.
Pictures = Callable[[int, Pose, int], int | None]


def draw_sliders(
    session: Session, look: Look, project: Project, pictures: Pictures
) -> list[Action]:
    """Draw the sliders of the active layer, and the button for new ones."""
    layer, frame = project.layer, playback.current_frame(session, project)
    heading(look, _("Sliders"), framed=True)
    align_right(1.15 * imgui.get_frame_height())
    hint = _("New slider from poses")
    reason = _("Make the layer posable first.") if layer.still else None
    if icon_button(look, icons.ICON_FA_PLUS, "new slider", hint, reason=reason):
        imgui.open_popup(NEW_SLIDER)
    actions = draw_new_slider(project)
    for each in layer.sliders:
        imgui.push_id(each.name)
        actions += _draw_slider(look, project, each, frame, pictures)
        imgui.pop_id()
    if layer.sliders:
        actions += _draw_state(look, project.layer_runtime.shown)
    else:
        small_text(look, _("A slider blends poses: a head turn, a smile, a breath."))
    return actions


def _draw_slider(
    look: Look, project: Project, slider: Slider, frame: int, pictures: Pictures
) -> list[Action]:
    document, layer = project.document, project.layer
    channel = Channel(SLIDER, layer.id, slider.name)
    value: complex = value_at(document, channel, frame)
    actions = _draw_head(look, project, slider)
    if slider.driver is not None:
        return actions
    is_wide = (layer.id, slider.name) in project.pose_edits.wide_sliders
    room = BEYOND if is_wide else 0.0
    new = (_draw_pad if slider.is_pad else _draw_track)(look, slider, value, room)
    actions += draw_key_diamond(document, look, channel, frame)
    picked = _draw_pictures(look, layer, slider, value, pictures)
    new = new if picked is None else picked
    if new is not None and new != value:
        actions.append(do(set_channel_value, channel, new))
    return actions


def _draw_head(look: Look, project: Project, slider: Slider) -> list[Action]:
    """Draw the name of a slider, with its menu, and its buttons."""
    document, layer, text = project.document, project.layer, slider.name
    driver = None if slider.driver is None else document.find_layer(slider.driver)
    if driver is not None:
        text = _("{name}, driven by {layer}").format(name=slider.name, layer=driver.name)
    imgui.align_text_to_frame_padding()
    room = imgui.get_content_region_avail().x - 2.5 * imgui.get_frame_height()
    imgui.text_colored(look.palette.dim, shorten_text(text, room))
    draw_tooltip(_("Right-click for more"))
    actions = _draw_menu(document, layer, slider)
    taken = (each.name for each in layer.sliders if each is not slider)
    name = name_popup(look, "name", slider.name, taken, _("Another slider has this name."))
    if name is not None:
        actions.append(_adjust(slider, name=name))
    if slider.driver is None:
        align_right(2.3 * imgui.get_frame_height())
        is_wide = (layer.id, slider.name) in project.pose_edits.wide_sliders
        hint = _("Let the slider go 30 % beyond its poses")
        icon = icons.ICON_FA_ARROWS_LEFT_RIGHT
        if icon_button(look, icon, "beyond poses", hint, active=is_wide):
            actions.append(do(sliders.toggle_wide_slider, slider.name))
        imgui.same_line(0, 0)
        hint = _("Set the pose here: the slider shows the present shape where it stands")
        if icon_button(look, icons.ICON_FA_CAMERA, "set pose", hint):
            actions.append(do(sliders.set_slider_pose, slider.name))
    return actions


def _draw_menu(document: Document, layer: Layer, slider: Slider) -> list[Action]:
    if not imgui.begin_popup_context_item("menu"):
        return []
    actions: list[Action] = []
    asks = imgui.menu_item_simple(_("Rename…"))
    if imgui.menu_item_simple(_("Delete slider")):
        actions.append(do(editing.edit_layer, slider_commands.delete_slider, slider.name))
    if imgui.begin_menu(_("Driven by")):
        choices: list[tuple[int | None, str]] = [(None, _("itself"))]
        choices += [
            (each.id, each.name)
            for each in document.layers
            if each is not layer and slider.name in {own.name for own in each.sliders}
        ]
        for identity, name in choices:
            if imgui.menu_item(f"{name}###{identity}", "", slider.driver == identity)[0]:
                actions.append(_adjust(slider, driver=identity))
        imgui.end_menu()
    if imgui.begin_menu(_("Spring")):
        springs: list[tuple[str, tuple[float, float] | None]] = [(_("None"), None)]
        springs += [(PRESET_NAMES[name], spring) for name, spring in SPRING_PRESETS.items()]
        for name, spring in springs:
            if imgui.menu_item(name, "", slider.spring == spring)[0]:
                actions.append(_adjust(slider, spring=spring))
        imgui.end_menu()
    if imgui.begin_menu(_("Delay")):
        for frames in DELAYS:
            text = ngettext("{frames} frame", "{frames} frames", frames).format(frames=frames)
            if imgui.menu_item(text, "", slider.delay == frames)[0]:
                actions.append(_adjust(slider, delay=frames))
        imgui.end_menu()
    imgui.end_popup()
    if asks:
        imgui.open_popup("name")
    return actions


def _adjust(slider: Slider, **changes: Any) -> Action:
    changed = replace(slider, **changes)
    return do(editing.edit_layer, slider_commands.change_slider, slider.name, changed)


def _range(places: list[float], room: float) -> tuple[float, float]:
    """Return the range of an axis, wider by a part of it on both sides."""
    more = room * (places[-1] - places[0])
    return places[0] - more, places[-1] + more


def _draw_track(look: Look, slider: Slider, value: complex, room: float) -> complex | None:
    left, right = _range(slider.axes[0], room)
    gap = imgui.get_style().item_inner_spacing.x
    width = imgui.get_content_region_avail().x - FIELD * look.em - gap - diamond_room(look)
    corner, height = imgui.get_cursor_screen_pos(), imgui.get_frame_height()
    scale = Scale(left=left, right=right)
    moved = slider_track(look, "track", value.real, scale, width, colour=look.palette.accent)
    draw_tooltip(_("Drag to blend the poses. A change sets a key at this frame if auto-key is on."))
    draw_list = imgui.get_window_draw_list()
    for x in slider.axes[0]:
        at = corner.x + 0.42 * look.em + scale.share(x) * (width - 0.84 * look.em)
        low, high = ImVec2(at, corner.y + 0.82 * height), ImVec2(at, corner.y + height)
        draw_list.add_line(low, high, colour_u32(look.palette.dim), 1.0)
    imgui.same_line(0, gap)
    imgui.set_next_item_width(FIELD * look.em)
    entered = number_field("value", value.real, "%.3g")
    if entered is not None:
        return slider.clamp(complex(entered))
    return None if moved is None else complex(moved.value)


def _draw_pad(look: Look, slider: Slider, value: complex, room: float) -> complex | None:
    (left, right), (bottom, top) = (_range(axis, room) for axis in slider.axes)
    side, corner = PAD * look.em, imgui.get_cursor_screen_pos()
    imgui.invisible_button("pad", ImVec2(side, side))
    draw_tooltip(_("Drag to blend the poses. A change sets a key at this frame if auto-key is on."))
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    far = corner + ImVec2(side, side)
    draw_list.add_rect_filled(corner, far, colour_u32(palette.desk), 0.4 * look.em)

    def place(at: complex) -> ImVec2:
        x, y = (at.real - left) / (right - left), (at.imag - bottom) / (top - bottom)
        return ImVec2(corner.x + x * side, far.y - y * side)

    for each in slider.poses:
        draw_list.add_circle_filled(place(each.at), 0.2 * look.em, colour_u32(palette.dim))
    new = None
    if imgui.is_item_active() and not imgui.is_item_activated():
        mouse = imgui.get_mouse_pos()
        x = min(max((mouse.x - corner.x) / side, 0.0), 1.0)
        y = min(max((far.y - mouse.y) / side, 0.0), 1.0)
        new = complex(left + x * (right - left), bottom + y * (top - bottom))
    knob = place(value if new is None else new)
    draw_list.add_circle_filled(knob, 0.42 * look.em, colour_u32(palette.accent))
    imgui.same_line()
    with push_text_size(SMALL):
        imgui.text_colored(
            palette.dim, format_slider_value(complex(round(value.real, 2), round(value.imag, 2)))
        )
    return new


def _draw_pictures(
    look: Look, layer: Layer, slider: Slider, value: complex, pictures: Pictures
) -> complex | None:
    """Draw the poses of a slider, those of a pad in its corners. Return the value of a click."""
    (xs, ys), em = slider.axes, look.em
    shown = [
        each
        for each in slider.poses
        if not slider.is_pad
        or (each.at.real in (xs[0], xs[-1]) and each.at.imag in (ys[0], ys[-1]))
    ]
    picked = None
    draw_list, side = imgui.get_window_draw_list(), TILE * em
    room = imgui.get_content_region_avail().x
    for index, each in enumerate(shown):
        if index and (index + 1) * (side + 0.3 * em) < room:
            imgui.same_line(0, 0.3 * em)
        low = imgui.get_cursor_screen_pos()
        if imgui.invisible_button(f"pose at {each.at}", ImVec2(side, side)):
            picked = each.at
        high = low + ImVec2(side, side)
        draw_list.add_rect_filled(low, high, colour_u32(look.palette.desk), 0.3 * em)
        texture = None
        if each.pose is not None:
            pose = layer.library_pose(each.pose).pose
            texture = pictures(layer.id, pose, round(side * pixel_density()))
        if texture is not None:
            draw_list.add_image(imgui.ImTextureRef(texture), low, high, ImVec2(0, 1), ImVec2(1, 0))
        elif each.pose is None:
            icon = icons.ICON_FA_PERSON
            place = (low + high - imgui.calc_text_size(icon)) * 0.5
            draw_list.add_text(place, colour_u32(look.palette.dim), icon)
        if each.at == value or imgui.is_item_hovered():
            draw_list.add_rect(low, high, colour_u32(look.palette.accent), 0.3 * em, 1.5)
        name = _("Undeformed drawing") if each.pose is None else each.pose
        draw_tooltip(f"{name}: {format_slider_value(each.at)}")
    return picked


def _draw_state(look: Look, shown: LayerFrame | None) -> list[Action]:
    """Say how strongly the limits change the shown blend."""
    solved = None if shown is None or shown.correction is None else shown.correction.sliders
    if solved is None:
        return []
    solution = solved.solution
    if solution.share < 1.0:
        text = _("The limits allow {share:.0%} of this blend.").format(share=solution.share)
    elif solution.curbed > REACHED or solution.rho < 1.0:
        most = max(expm1(solution.curbed), 1.0 / solution.rho - 1.0)
        text = _("The limits change this blend by up to {most:.0%} in places.").format(most=most)
    else:
        text = _("The limits are not reached.")
    small_text(look, text)
    return []
