"""The list of recovered work from earlier sessions."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, RecoverableFile, RecoveryDialog, do, error_reports
from app.editor.actions.dialog_actions import answer_dialog, close_dialog
from app.editor.actions.project_files import recovery
from app.errors import display_name
from app.texts import _
from app.ui.dialogs.folder_listing import Entry
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, main_button, shorten_text

WIDEST = 14.0  # em, of a name
WIDTH, SUMMARY_AT, BUTTONS_AT = 36.0, 14.5, 27.5  # em
TALLEST = 20.0  # em, height of the rows before they scroll


def draw_recovery_dialog(recovery: RecoveryDialog, look: Look) -> list[Action]:
    """Draw each recovered project with its buttons."""
    actions: list[Action] = []
    imgui.push_text_wrap_pos(30 * look.em)
    imgui.text_unformatted(
        _(
            "Lissom quit unexpectedly and kept your unsaved work. Open it, discard it, or find "
            "it later in File › Unsaved work."
        )
    )
    imgui.pop_text_wrap_pos()
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    row = imgui.get_frame_height_with_spacing()
    height = min(len(recovery.candidates) * row + 0.5 * look.em, TALLEST * look.em)
    imgui.begin_child("unsaved work", ImVec2(WIDTH * look.em, height))
    for index, leftover in enumerate(recovery.candidates):
        imgui.push_id(index)
        actions += _row(leftover, look, is_main=index == 0)
        imgui.pop_id()
    imgui.end_child()
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    if imgui.button(_("Later")):
        actions.append(do(close_dialog))
    imgui.same_line()
    if imgui.button(_("Report a problem…")):
        actions.append(do(error_reports.show_kept_or_new_report))
    return actions


def _row(leftover: RecoverableFile, look: Look, *, is_main: bool) -> list[Action]:
    actions: list[Action] = []
    entry = Entry(path=leftover.path, is_folder=False, size=leftover.size, changed=leftover.kept)
    imgui.align_text_to_frame_padding()
    origin = leftover.origin
    imgui.text_unformatted(shorten_text(origin.name, WIDEST * look.em))
    draw_tooltip(display_name(origin.path) if origin.path else _("Never saved"))
    imgui.same_line(SUMMARY_AT * look.em)
    imgui.text_disabled(f"{entry.changed_in_words}   {entry.size_in_words}   ")
    imgui.same_line(BUTTONS_AT * look.em)
    if main_button(look, _("Open")) if is_main else imgui.button(_("Open")):
        actions.append(do(answer_dialog, do(recovery.recover_file, leftover.path)))
    if is_main:
        imgui.set_item_default_focus()
    imgui.same_line()
    if imgui.button(_("Discard")):
        actions.append(do(answer_dialog, do(recovery.discard_recoverable_file, leftover.path)))
    return actions
