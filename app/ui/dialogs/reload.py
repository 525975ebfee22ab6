"""The changes of a drawing's file, before it is reloaded."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, ReloadDialog, as_sentence, do
from app.editor.actions.dialog_actions import answer_dialog, close_dialog
from app.editor.layering.reloading import begin_reload
from app.errors import display_name
from app.solving import Change, reload_rows, scene_changes
from app.texts import _
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, main_button, shorten_text

WIDTH, NAME_WIDTH, TALLEST = 42.0, 12.0, 22.0  # em


def draw_reload_dialog(dialog: ReloadDialog, look: Look) -> list[Action]:
    """Draw a row for each layer, changed layers first, and the buttons."""
    actions: list[Action] = []
    imgui.push_text_wrap_pos(WIDTH * look.em)
    text = _("Handles, keys and joints stay. One undo step brings everything back.")
    imgui.text_unformatted(text)
    imgui.pop_text_wrap_pos()
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    rows = sorted(reload_rows(dialog.plan), key=lambda row: row.change is Change.SAME)
    height = (len(rows) + 1.5) * imgui.get_text_line_height_with_spacing()
    flags = imgui.TableFlags_.row_bg | imgui.TableFlags_.scroll_y
    if imgui.begin_table(
        "changes", 3, flags, ImVec2(WIDTH * look.em, min(height, TALLEST * look.em))
    ):
        fixed, rest = imgui.TableColumnFlags_.width_fixed, imgui.TableColumnFlags_.width_stretch
        imgui.table_setup_column(_("Layer"), fixed, NAME_WIDTH * look.em)
        imgui.table_setup_column(_("Change"), fixed, 9 * look.em)
        imgui.table_setup_column(_("Details"), rest)
        imgui.table_setup_scroll_freeze(0, 1)
        imgui.table_headers_row()
        for row in rows:
            imgui.table_next_column()
            imgui.text_unformatted(shorten_text(display_name(row.name), NAME_WIDTH * look.em))
            draw_tooltip(display_name(row.name))
            imgui.table_next_column()
            if row.change is Change.SAME:
                imgui.text_disabled(row.label)
            else:
                imgui.text_unformatted(row.label)
            imgui.table_next_column()
            imgui.text_unformatted(display_name(row.details))
        imgui.end_table()
    for change in scene_changes(dialog.plan):
        imgui.text_disabled(display_name(as_sentence(change)))
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    if main_button(look, _("Reload")):
        actions.append(do(answer_dialog, do(begin_reload, dialog)))
    imgui.set_item_default_focus()
    imgui.same_line()
    if imgui.button(_("Cancel")):
        actions.append(do(close_dialog))
    return actions
