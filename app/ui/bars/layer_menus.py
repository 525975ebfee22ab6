"""The menus of layers, groups and switches: of their rows in the list and in the timeline."""

from collections.abc import Sequence

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import (
    Group,
    Layer,
    SwitchGroup,
    SwitchMember,
    TreeRow,
    find_switch_members,
    group_commands,
    switch_group_commands,
)
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.editor.layering import layer_list
from app.editor.layering.deform_groups import (
    bend_layers_as_one,
    part_group,
    why_not_bend_as_one,
)
from app.editor.layering.deletion import delete_layers
from app.editor.layering.footage import reload_footage
from app.editor.layering.layer_list import (
    duplicate_layer,
    group_layers,
    put_layers_in_group,
    toggle_group_hidden,
    toggle_layers_hidden,
    toggle_layers_locked,
    toggle_reference,
)
from app.editor.layering.layer_selection import select_layers, solo_layers
from app.editor.layering.pictures import ask_replacement_picture, make_posable, make_still
from app.editor.layering.reloading import reload_layers
from app.editor.layering.seams import close_seam
from app.editor.layering.switches import create_switch, key_switch
from app.texts import _, ngettext
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.widgets import menu_entry

SOLO = icons.ICON_FA_BINOCULARS


def draw_layer_menu(
    project: Project, row: TreeRow, *, has_rename: bool = True
) -> tuple[list[Action], bool]:
    """Draw the menu of the last item, a row. Return also whether rename was chosen."""
    if not imgui.begin_popup_context_item(f"menu of layer {row.key}"):
        return [], False
    keys = shown_keys(layer_list.rename_active_layer)
    asks = has_rename and menu_entry(_("Rename…"), icons.ICON_FA_PEN, keys)
    if row.layer is not None:
        actions = _of_layer(project, row.layer)
    elif row.switch_group is not None:
        actions = _draw_switch_items(project, row.switch_group)
    else:
        actions = [] if row.group is None else _of_group(project, row, row.group)
    imgui.end_popup()
    return actions, asks


def _of_layer(project: Project, layer: Layer) -> list[Action]:
    identity, chosen = layer.id, project.selected_layers
    is_many = len(chosen) > 1 and identity in chosen
    whom = chosen if is_many else (identity,)
    count = len(whom)
    actions: list[Action] = [] if is_many else _of_one_layer(project, layer)
    imgui.separator()
    text = (
        ngettext("Show", "Show {count} layers", count)
        if layer.hidden
        else ngettext("Hide", "Hide {count} layers", count)
    )
    if menu_entry(text.format(count=count), icons.ICON_FA_EYE):
        actions.append(do(toggle_layers_hidden, *whom))
    text = (
        ngettext("Unlock", "Unlock {count} layers", count)
        if layer.locked
        else ngettext("Lock", "Lock {count} layers", count)
    )
    if menu_entry(text.format(count=count), icons.ICON_FA_LOCK):
        actions.append(do(toggle_layers_locked, *whom))
    alone = project.layer_list.solo == set(whom)
    text = _("End solo") if alone else ngettext("Solo", "Solo {count} layers", count)
    if menu_entry(text.format(count=count), SOLO):
        actions.append(do(solo_layers, *whom))
    if not is_many:
        actions += _kind(project, layer)
    actions += _bending(project, whom)
    imgui.separator()
    others = _("Other layers are selected. Open the menu of one of them.")
    reason = None if is_many or not project.selection.other_layers else others
    if menu_entry(_("Group layers"), icons.ICON_FA_FOLDER_PLUS, reason=reason):
        actions.append(do(select_layers, *whom))
        actions.append(do(group_layers))
    if layer.group and menu_entry(_("Ungroup layer"), icons.ICON_FA_FOLDER_MINUS):
        actions.append(do(put_layers_in_group, layer.group.rpartition("/")[0], *whom))
    members = find_switch_members(project.document, chosen) if is_many else ()
    reason = _switch_disabled_reason(project, members)
    if menu_entry(_("Create switch"), icons.ICON_FA_MASKS_THEATER, reason=reason):
        actions.append(do(create_switch, *members))
    if project.document.switch_group_of(identity) and menu_entry(
        _("Remove from switch"), icons.ICON_FA_XMARK
    ):
        actions.append(
            do(editing.edit_document, switch_group_commands.remove_from_switch_group(identity))
        )
    imgui.separator()
    is_all = len(project.document.layers) == len(whom)
    reason = _("A scene needs at least one layer.") if is_all else None
    text = ngettext("Delete", "Delete {count} layers", count).format(count=count)
    if menu_entry(text, icons.ICON_FA_TRASH, reason=reason):
        actions.append(do(delete_layers, *whom))
    return actions


def _of_one_layer(project: Project, layer: Layer) -> list[Action]:
    identity = layer.id
    entries = [(_("Duplicate"), icons.ICON_FA_CLONE, do(duplicate_layer, identity))]
    if not project.document.is_deform_group(identity):
        replacement = do(ask_replacement_picture, identity)
        entries += [
            (_("Replace picture…"), icons.ICON_FA_FILE_IMAGE, replacement),
            (
                _("Reload layer"),
                icons.ICON_FA_ARROWS_ROTATE,
                do(reload_layers if layer.footage is None else reload_footage, identity),
            ),
        ]
    actions = [action for title, icon, action in entries if menu_entry(title, icon)]
    if layer.has_parent and menu_entry(_("Close seam"), icons.ICON_FA_GRIP_LINES_VERTICAL):
        actions.append(do(close_seam, identity))
    return actions


def _bending(project: Project, whom: Sequence[int]) -> list[Action]:
    """Draw the entry that makes a deform group of layers, or the one that parts it."""
    layer = project.document.layer(whom[0])
    group = project.document.deform_layer(layer).id
    if len(whom) == 1 and project.document.is_deform_group(group):
        if menu_entry(_("Part deform group"), icons.ICON_FA_OBJECT_UNGROUP):
            return [do(part_group, group)]
        return []
    reason = why_not_bend_as_one(project, whom)
    if menu_entry(_("Bend as one"), icons.ICON_FA_OBJECT_GROUP, reason=reason):
        return [do(bend_layers_as_one, *whom)]
    return []


def _switch_disabled_reason(project: Project, members: Sequence[SwitchMember]) -> str | None:
    """Return why layers and groups cannot become a switch; None if they can."""
    if len(members) < 2:
        return _("Select several layers or groups first.")
    is_taken = any(project.document.switch_group_of(each) is not None for each in members)
    return _("One of them is already in a switch.") if is_taken else None


def _kind(project: Project, layer: Layer) -> list[Action]:
    actions: list[Action] = []
    if menu_entry(
        _("Include in exports") if layer.reference else _("Reference only"), icons.ICON_FA_BAN
    ):
        actions.append(do(toggle_reference, layer.id))
    if layer.deform_group is not None or project.document.is_deform_group(layer.id):
        return actions
    reason = (
        None if layer.footage is None else _("Footage cannot be posed. Replace its picture first.")
    )
    if menu_entry(
        _("Make posable") if layer.still else _("Make still picture"),
        icons.ICON_FA_IMAGE,
        reason=reason,
    ):
        turn = make_posable if layer.still else make_still
        actions.append(do(turn, layer.id))
    return actions


def _draw_switch_items(project: Project, switch_group: SwitchGroup) -> list[Action]:
    imgui.separator()
    actions = [
        do(key_switch, member)
        for member in switch_group.members
        if menu_entry(
            _("Show {name}").format(name=project.document.member_name(member)),
            icons.ICON_FA_CIRCLE_DOT,
        )
    ]
    imgui.separator()
    if menu_entry(_("Delete switch"), icons.ICON_FA_XMARK):
        actions.append(
            do(editing.edit_document, switch_group_commands.delete_switch_group(switch_group.name))
        )
    return actions


def _of_group(project: Project, row: TreeRow, group: Group) -> list[Action]:
    actions: list[Action] = []
    imgui.separator()
    if menu_entry(_("Select its layers"), icons.ICON_FA_LIST_CHECK):
        actions.append(do(select_layers, *row.layers))
    if menu_entry(_("Show") if group.hidden else _("Hide"), icons.ICON_FA_EYE):
        actions.append(do(toggle_group_hidden, group.name))
    locked = all(project.document.layer(each).locked for each in row.layers)
    if menu_entry(_("Unlock") if locked else _("Lock"), icons.ICON_FA_LOCK):
        actions.append(do(toggle_layers_locked, *row.layers))
    alone = project.layer_list.solo == set(row.layers)
    if menu_entry(_("End solo") if alone else _("Solo"), SOLO):
        actions.append(do(solo_layers, *row.layers))
    members = find_switch_members(project.document, row.layers)
    reason = _switch_disabled_reason(project, members)
    if menu_entry(_("Create switch"), icons.ICON_FA_MASKS_THEATER, reason=reason):
        actions.append(do(create_switch, *members, name=row.name))
    actions += _bending(project, row.layers)
    if project.document.switch_group_of(group.name) and menu_entry(
        _("Remove from switch"), icons.ICON_FA_XMARK
    ):
        command = switch_group_commands.remove_from_switch_group(group.name)
        actions.append(do(editing.edit_document, command))
    imgui.separator()
    if menu_entry(_("Ungroup"), icons.ICON_FA_FOLDER_MINUS):
        actions.append(do(editing.edit_document, group_commands.ungroup_layers(group.name)))
    return actions
