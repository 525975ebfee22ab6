"""The menus of rows in the tree of layers."""

from collections.abc import Sequence

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import Group, Layer, SwitchGroup, TreeRow, subgroups_with_layers
from app.editor import Action, Project, do
from app.editor.layering.layer_list import (
    duplicate_layer,
    group_layers,
    put_layers_in_group,
    toggle_group_hidden,
    toggle_layers_hidden,
    toggle_layers_locked,
    toggle_reference,
    ungroup_layers,
)
from app.editor.layering.layer_selection import select_layers, solo_layers
from app.editor.layering.parenting import delete_layers
from app.editor.layering.pictures import ask_replacement_picture, make_posable, make_still
from app.editor.layering.switches import (
    create_switch,
    delete_switch,
    key_switch,
    remove_from_switch,
)
from app.ui.shortcuts.table import BINDINGS
from app.ui.style.widgets import draw_tooltip

SOLO = icons.ICON_FA_BINOCULARS
item = imgui.internal.menu_item_ex  # like menu_item_simple, with a column for icons


def draw_layer_menu(project: Project, row: TreeRow) -> tuple[list[Action], bool]:
    """Draw the menu of the last item, a row. Return also whether rename was chosen."""
    if not imgui.begin_popup_context_item(f"menu of layer {row.key}"):
        return [], False
    asks = item("Rename…", icons.ICON_FA_PEN, BINDINGS["rename layer"].shown_keys)
    if row.layer is not None:
        actions = _of_layer(project, row.layer)
    elif row.switch_group is not None:
        actions = _draw_switch_items(project, row.switch_group)
    else:
        actions = [] if row.group is None else _of_group(project, row, row.group)
    imgui.end_popup()
    return actions, asks


def explain_unswitchable_groups(groups: Sequence[str]) -> str:
    """Explain why groups in a group cannot be switched, and name the remedy."""
    named = ", ".join(groups)
    return (
        f"Only single layers take turns, and {named} {'has' if len(groups) == 1 else 'have'} "
        "several. Choose the layers that do: a layer that is clipped to one of them is seen with it"
    )


def _of_layer(project: Project, layer: Layer) -> list[Action]:
    actions: list[Action] = []
    identity, chosen = layer.id, project.selected_layers
    is_many = len(chosen) > 1 and identity in chosen
    whom = chosen if is_many else (identity,)
    many = f" {len(chosen)} layers" if is_many else ""
    if not is_many:
        if item("Duplicate", icons.ICON_FA_CLONE):
            actions.append(do(duplicate_layer, identity))
        if item("Replace picture…", icons.ICON_FA_FILE_IMAGE):
            actions.append(do(ask_replacement_picture, identity))
    imgui.separator()
    if item(("Show" if layer.hidden else "Hide") + many, icons.ICON_FA_EYE):
        actions.append(do(toggle_layers_hidden, *whom))
    if item(("Unlock" if layer.locked else "Lock") + many, icons.ICON_FA_LOCK):
        actions.append(do(toggle_layers_locked, *whom))
    alone = project.solo == set(whom)
    if item("End solo" if alone else f"Look at{many or ' it'} alone", SOLO):
        actions.append(do(solo_layers, *whom))
    if not is_many:
        actions += _kind(layer)
    imgui.separator()
    if item(
        "Group layers",
        icons.ICON_FA_FOLDER_PLUS,
        enabled=is_many or not project.other_selected_layers,
    ):
        actions.append(do(select_layers, *whom))
        actions.append(do(group_layers))
    if layer.group and item("Ungroup layer", icons.ICON_FA_FOLDER_MINUS):
        actions.append(do(put_layers_in_group, layer.group.rpartition("/")[0], *whom))
    free = is_many and all(project.document.switch_group_of(each) is None for each in chosen)
    if item("Create switch", icons.ICON_FA_MASKS_THEATER, enabled=free):
        actions.append(do(create_switch, *chosen))
    if project.document.switch_group_of(identity) and item(
        "Remove from switch", icons.ICON_FA_XMARK
    ):
        actions.append(do(remove_from_switch, identity))
    imgui.separator()
    left = len(project.document.layers) > len(whom)
    if item(f"Delete{many}", icons.ICON_FA_TRASH, enabled=left):
        actions.append(do(delete_layers, *whom))
    return actions


def _kind(layer: Layer) -> list[Action]:
    actions: list[Action] = []
    if item("Take into exports" if layer.reference else "Reference only", icons.ICON_FA_BAN):
        actions.append(do(toggle_reference, layer.id))
    if item("Make posable" if layer.still else "Make still picture", icons.ICON_FA_IMAGE):
        turn = make_posable if layer.still else make_still
        actions.append(do(turn, layer.id))
    return actions


def _draw_switch_items(project: Project, choice: SwitchGroup) -> list[Action]:
    imgui.separator()
    actions = [
        do(key_switch, identity)
        for identity in choice.layers
        if item(f"Show {project.document.layer(identity).name}", icons.ICON_FA_CIRCLE_DOT)
    ]
    imgui.separator()
    if item("Delete switch", icons.ICON_FA_XMARK):
        actions.append(do(delete_switch, choice.name))
    return actions


def _of_group(project: Project, row: TreeRow, group: Group) -> list[Action]:
    actions: list[Action] = []
    imgui.separator()
    if item("Choose all layers in it", icons.ICON_FA_LIST_CHECK):
        actions.append(do(select_layers, *row.layers))
    if item("Show" if group.hidden else "Hide", icons.ICON_FA_EYE):
        actions.append(do(toggle_group_hidden, group.name))
    locked = all(project.document.layer(each).locked for each in row.layers)
    if item("Unlock" if locked else "Lock", icons.ICON_FA_LOCK):
        actions.append(do(toggle_layers_locked, *row.layers))
    alone = project.solo == set(row.layers)
    if item("End solo" if alone else "Solo", SOLO):
        actions.append(do(solo_layers, *row.layers))
    whole = subgroups_with_layers(project.document, group.name)
    free = len(row.layers) > 1 and all(
        project.document.switch_group_of(each) is None for each in row.layers
    )
    if item("Create switch", icons.ICON_FA_MASKS_THEATER, enabled=free and not whole):
        actions.append(do(create_switch, *row.layers, name=row.name))
    if whole:
        draw_tooltip(explain_unswitchable_groups(whole))
    imgui.separator()
    if item("Ungroup", icons.ICON_FA_FOLDER_MINUS):
        actions.append(do(ungroup_layers, group.name))
    return actions
