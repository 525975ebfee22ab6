"""The layers of the scene: their draw order, and their parents."""

from imgui_bundle import imgui

from app.document import suggest_switch_groups
from app.editor import Action, Project, Session, do
from app.editor.actions import dialog_actions, playback
from app.editor.actions.layer_setup import cut_out_editing, resolving
from app.editor.layering.deform_groups import (
    bend_layers_as_one,
    bending_suggestions,
    dismiss_bending_suggestion,
)
from app.editor.layering.switches import create_switch, dismiss_switch_suggestion
from app.errors import display_name, few_notices, join_names
from app.texts import _, message_of
from app.ui.panels.layers.row import SmallPictures
from app.ui.panels.layers.settings import draw_layer_settings
from app.ui.panels.layers.tree import draw_layer_tree
from app.ui.shortcuts.widgets import draw_action_text_button
from app.ui.style.theme import Look
from app.ui.style.widgets import FILL, heading, progress_bar, shorten_text, small_text

_FOLD = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.span_avail_width


def draw_layers_panel(
    session: Session, look: Look, project: Project, pictures: SmallPictures
) -> list[Action]:
    """Draw the list of layers with thumbnails, and the settings of the active layer."""
    actions = _summary(look, project)
    actions += _offers(look, project) + _bending_offers(look, project)
    actions += draw_layer_tree(session, look, project, pictures)
    if len(project.document.layers) == 1:
        small_text(
            look, _("Drop another picture here, or open an .ora or .psd file, for more layers.")
        )
    resolver = project.key_resolver
    if (
        resolver is not None
        and resolver.replaces_picture
        and progress_bar(resolver.progress, resolver.status_text)
    ):
        actions.append(do(resolving.cancel_solving_keys))
    heading(look, shorten_text(project.listed_layer.name, imgui.get_content_region_avail().x))
    frame = playback.current_frame(session, project)
    actions += draw_layer_settings(project, look, project.listed_layer, frame)
    return actions + draw_action_text_button(session, cut_out_editing.toggle_cut_brush, FILL)


def _summary(look: Look, project: Project) -> list[Action]:
    """Draw the import log: losses first, minor notices folded."""
    summary = project.document.import_log
    if not summary:
        return []
    count = len(summary.warnings)
    title = _("Differences: {count}").format(count=count) if count else _("Imported as drawn")
    imgui.set_next_item_open(project.layer_list.is_import_log_open)
    is_open = imgui.tree_node_ex(f"{title}###summary", _FOLD)
    actions = [do(dialog_actions.toggle_import_log)] if imgui.is_item_toggled_open() else []
    if not is_open:
        return actions
    for loss in few_notices(summary.warnings):
        small_text(look, message_of(loss), look.palette.text)
    if summary.notes and imgui.tree_node_ex(
        _("Minor differences: {count}").format(count=len(summary.notes)), _FOLD
    ):
        for matter in few_notices(summary.notes):
            small_text(look, message_of(matter))
    imgui.separator()
    return actions


def _bending_offers(look: Look, project: Project) -> list[Action]:
    """Draw the offers to bend layers as one that lie on each other, like ink and colour."""
    actions: list[Action] = []
    for layers in bending_suggestions(project):
        imgui.push_id(str(layers))
        names = join_names([project.document.layer(each).name for each in reversed(layers)])
        text = _("{layers} lie on each other, like the ink and the colour of one part.")
        small_text(look, display_name(text.format(layers=names)))
        if imgui.button(_("Bend as one")):
            actions.append(do(bend_layers_as_one, *layers))
        imgui.same_line()
        if imgui.button(_("No")):
            actions.append(do(dismiss_bending_suggestion, *layers))
        imgui.pop_id()
    return actions


def _offers(look: Look, project: Project) -> list[Action]:
    """Draw the offers to make a switch of a group whose name suggests one, like mouths."""
    actions: list[Action] = []
    for path, layers in suggest_switch_groups(project.document):
        if path in project.layer_list.dismissed_suggestions:
            continue
        name = path.rpartition("/")[2]
        imgui.push_id(path)
        text = _("{name}: show one of its {count} parts at a time?")
        small_text(look, text.format(count=len(layers), name=name))
        if imgui.button(_("Create switch")):
            actions.append(do(create_switch, *layers, name=name))
        imgui.same_line()
        if imgui.button(_("No")):
            actions.append(do(dismiss_switch_suggestion, path))
        imgui.pop_id()
    return actions
