"""The settings of the active layer: blending, visibility, and parent."""

from collections.abc import Mapping, Sequence

from imgui_bundle import ImVec2, imgui

from app.document import (
    BLEND_SECTIONS,
    GROUP_BLEND_SECTIONS,
    VISIBILITY,
    BlendMode,
    Channel,
    Document,
    Group,
    Layer,
    SwitchGroup,
    SwitchMember,
    group_commands,
    is_visible,
    layer_commands,
    switch_group_commands,
    with_repeats,
)
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.editor.layering.deform_groups import part_group
from app.editor.layering.layer_list import (
    rename_layer,
    toggle_clipping,
    toggle_group_hidden,
    toggle_reference,
    toggle_visibility_key,
)
from app.editor.layering.layer_selection import set_active_layer
from app.editor.layering.parenting import (
    attach_layer,
    delete_parent_key,
    detach_layer,
    is_same_or_descendant,
    reparent_layer,
    set_inherits_rotation,
)
from app.editor.layering.pictures import make_posable, make_still
from app.editor.layering.switches import key_switch
from app.errors import display_name, join_names
from app.texts import _
from app.ui.panels.key_diamond import diamond_room, draw_key_diamond
from app.ui.panels.layers.channels import (
    draw_ik_target,
    draw_order_channel,
    draw_transform_channel,
    draw_value_channels,
)
from app.ui.panels.layers.footage import draw_footage
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    LABEL_WIDTH,
    draw_tooltip,
    label,
    menu_entry,
    shorten_text,
    small_text,
    text_button,
)

PERCENT = Scale(left=0, right=100)
NOTHING = _("nothing")


def draw_layer_settings(project: Project, look: Look, layer: Layer, frame: int) -> list[Action]:
    actions = []
    identity = layer.id
    label(look, _("Name"))
    entered, name = imgui.input_text(
        "##layer name", layer.name, imgui.InputTextFlags_.enter_returns_true
    )
    if entered or (imgui.is_item_deactivated_after_edit() and name != layer.name):
        actions.append(do(rename_layer, identity, name))
    is_deform_group = project.document.is_deform_group(identity)
    if is_deform_group:
        text = _("Bends {layers} as one. Each of them has its own opacity, blend and order.")
        names = join_names([each.name for each in project.document.deform_members(identity)])
        small_text(look, display_name(text.format(layers=names)))
        if text_button(_("Part deform group"), FILL, _("Its layers get their own meshes back")):
            actions.append(do(part_group, identity))
    else:
        actions += _draw_painting(project, look, layer, frame)
        actions += draw_footage(project, look, layer, frame)
    for group in project.document.groups_around(layer.group):
        actions += _group(look, group)
    changed = imgui.checkbox(_("Reference only"), layer.reference)[0]
    draw_tooltip(_("Visible while you work, left out of exports"))
    if changed:
        actions.append(do(toggle_reference, identity))
    actions += _draw_visibility(project.document, look, layer, frame)
    if layer.deform_group is not None:
        text = _("{group} bends and moves this layer.")
        bent = project.document.deform_layer(layer)
        small_text(look, display_name(text.format(group=bent.name)))
        if text_button(_("Select {name}").format(name=bent.name), FILL, ""):
            actions.append(do(set_active_layer, bent.id))
        return actions + draw_order_channel(project.document, look, layer, frame)
    actions += _draw_parent(project, look, layer, frame)
    actions += draw_transform_channel(project.document, look, layer, frame)
    actions += draw_ik_target(project.document, look, layer, frame)
    if is_deform_group:
        return actions
    actions += draw_order_channel(project.document, look, layer, frame)
    if layer.still and layer.footage is None:
        small_text(look, _("A still picture, shown as it was drawn."))
        if imgui.button(_("Make posable"), ImVec2(FILL, 0)):
            actions.append(do(make_posable, identity))
    elif not layer.still and imgui.button(_("Make still picture"), ImVec2(FILL, 0)):
        actions.append(do(make_still, identity))
    return actions


def _draw_painting(project: Project, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw opacity, effects, blend and clipping."""
    actions = draw_value_channels(project.document, look, layer, frame)
    label(look, _("Blend"))
    actions += [
        do(editing.edit_document, layer_commands.set_blend(layer.id, blend))
        for blend in _choose_blend(layer.blend, BLEND_SECTIONS)
    ]
    changed = imgui.checkbox(_("Clipped"), layer.clipped)[0]
    draw_tooltip(_("Visible only over the layer below it in its group"))
    return [*actions, do(toggle_clipping, layer.id)] if changed else actions


def _choose_blend(present: BlendMode, sections: Sequence[Mapping[str, str]]) -> list[BlendMode]:
    """Draw the list of blend modes, and return the chosen one."""
    chosen = []
    labels = {blend: _(text) for section in sections for blend, text in section.items()}
    if imgui.begin_combo("##blend", labels[present], imgui.ComboFlags_.height_largest):
        for number, section in enumerate(sections):
            if number:
                imgui.separator()
            chosen += [
                blend for blend in section if imgui.selectable(labels[blend], blend == present)[0]
            ]
        imgui.end_combo()
    draw_tooltip(_("How its colours mix with the layers behind: multiply darkens, screen lightens"))
    return chosen


def _group(look: Look, group: Group) -> list[Action]:
    actions = []
    imgui.push_id(group.name)
    name = group.name.rpartition("/")[2]
    label(look, shorten_text(_("In {name}").format(name=name), (LABEL_WIDTH - 0.5) * look.em))
    hint = _("Opacity of the whole group {name}").format(name=group.name)
    faded = slider(look, "opacity", 100 * group.opacity, PERCENT, text="%.0f %%", hint=hint)
    if faded is not None:
        opacity = min(max(faded.value / 100, 0.0), 1.0)
        fade = group_commands.set_group_opacity(group.name, opacity)
        actions.append(do(editing.edit_document, fade))
    text = _("Blend of {name}").format(name=name)
    label(look, shorten_text(text, (LABEL_WIDTH - 0.5) * look.em))
    actions += [
        do(editing.edit_document, group_commands.set_group_blend(group.name, blend))
        for blend in _choose_blend(group.blend, GROUP_BLEND_SECTIONS)
    ]
    if imgui.checkbox(
        shorten_text(_("Hide all of {name}").format(name=name), 14 * look.em), group.hidden
    )[0]:
        actions.append(do(toggle_group_hidden, group.name))
    imgui.pop_id()
    return actions


def _draw_visibility(document: Document, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw the buttons that show or hide a layer from the present frame on."""
    actions: list[Action] = []
    for switch_group, member in document.switches_around(layer):
        actions += _draw_switch_keys(document, look, switch_group, member, frame)
    if document.switch_group_of(layer.id) is not None:
        return actions
    is_seen = is_visible(document, layer, frame)
    text = _("Hide from frame {frame} on") if is_seen else _("Show from frame {frame} on")
    is_put_away = layer.hidden or document.is_in_hidden(layer)
    hint = (
        _("The layer is hidden in all frames. A key here shows it from this frame on.")
        if is_put_away
        else _("For props that come and go. Use a switch for layers that replace each other.")
    )
    if text_button(text.format(frame=frame), -diamond_room(look), hint):
        actions.append(do(toggle_visibility_key, layer.id))
    actions += draw_key_diamond(document, look, Channel(VISIBILITY, layer.id), frame)
    return actions


def _draw_switch_keys(
    document: Document, look: Look, switch_group: SwitchGroup, member: SwitchMember, frame: int
) -> list[Action]:
    """Draw which layer of a switch is visible from the present frame on."""
    actions = []
    label(look, shorten_text(switch_group.name, (LABEL_WIDTH - 0.5) * look.em))
    seen = with_repeats(document, switch_group).member_at(frame)
    if imgui.begin_combo(f"##turn {switch_group.name}", document.member_name(seen)):
        actions += [
            do(key_switch, each)
            for each in switch_group.members
            if imgui.selectable(f"{document.member_name(each)}###turn {each}", each == seen)[0]
        ]
        imgui.end_combo()
    draw_tooltip(_("What is visible from frame {frame} on").format(frame=frame))
    if text_button(
        _("Remove from switch") + f"###remove from {switch_group.name}",
        FILL,
        _("The layer keeps its visibility, with keys of its own"),
    ):
        actions.append(
            do(editing.edit_document, switch_group_commands.remove_from_switch_group(member))
        )
    return actions


def _draw_parent(project: Project, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw a layer's parent at the present frame, and its attachments over time."""
    document = project.document

    def can_be_parent(other: Layer) -> bool:
        is_member = other.deform_group is not None
        return not (is_member or is_same_or_descendant(project, other.id, layer.id))

    if not layer.attachments and not any(map(can_be_parent, document.layers)):
        return []
    actions = []
    joint = document.attachment_at(layer, frame)
    parent = None if joint is None or joint.parent is None else document.layer(joint.parent)
    label(look, _("Attached to"))
    if imgui.begin_combo("##attached to", NOTHING if parent is None else parent.name):
        if imgui.selectable(NOTHING, parent is None)[0] and parent is not None:
            actions.append(do(detach_layer, layer.id))
        actions += [
            do(attach_layer, layer.id, other.id)
            for other in filter(can_be_parent, document.layers)
            if imgui.selectable(f"{other.name}###parent {other.id}", other is parent)[0]
        ]
        imgui.end_combo()
    draw_tooltip(_("The layer follows the point of its parent under its anchor"))
    if joint is not None and parent is not None:
        changed, turns = imgui.checkbox(_("Inherit rotation"), joint.inherits_rotation)
        if changed:
            actions.append(do(set_inherits_rotation, layer.id, turns))
    if frame > document.frames.first:
        actions += _draw_reparent(project, look, layer, frame)
    return actions


def _draw_reparent(project: Project, look: Look, layer: Layer, frame: int) -> list[Action]:
    """Draw the menu that changes a layer's parent from the present frame on."""
    actions: list[Action] = []
    document, joint = project.document, layer.attachment_key_at(frame)
    now = None if joint is None else joint.parent
    text = _("Reparent from frame {frame}…").format(frame=frame)
    if text_button(text, FILL, _("The layer does not jump at that frame")):
        imgui.open_popup("reparent")
    if imgui.begin_popup("reparent"):
        reason = _("The layer is attached to no other layer.") if now is None else None
        if menu_entry(_("Detach"), reason=reason):
            actions.append(do(reparent_layer, layer.id, None))
        for other in reversed([each for each in document.layers if each is not layer]):
            is_circle = any(each is layer for each in document.parent_chain(other.id, frame))
            name = f"{_('To {name}').format(name=other.name)}###to {other.id}"
            reason = None
            if is_circle:
                reason = _("At frame {frame} it is itself attached to {name}.")
            elif other.id == now:
                reason = _("It is already the parent at frame {frame}.")
            if menu_entry(name, reason=reason and reason.format(frame=frame, name=layer.name)):
                actions.append(do(reparent_layer, layer.id, other.id))
        imgui.end_popup()
    keyed = layer.joint_frame(frame)
    if joint is not None and joint.frame == keyed and len(layer.attachments) > 1:
        hint = _("The layer then keeps its previous parent")
        if text_button(_("Delete parent key") + "###joint", FILL, hint):
            actions.append(do(delete_parent_key, layer.id, keyed))
    if len(layer.attachments) > 1:
        parents = (
            _("{name} from {frame}").format(
                name=NOTHING if each.parent is None else document.layer(each.parent).name,
                frame=each.frame,
            )
            for each in layer.attachments
        )
        small_text(look, _("It is attached to {parents}.").format(parents=", ".join(parents)))
    return actions
