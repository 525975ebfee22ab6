"""A problem report that can be read and saved."""

from imgui_bundle import ImVec2, imgui

from app.editor import Action, ProblemReport, do, error_reports
from app.editor.actions.dialog_actions import close_dialog
from app.texts import _
from app.ui.style.theme import Look
from app.ui.style.widgets import main_button

WIDTH, HEIGHT, MARGIN = 46.0, 22.0, 6.0  # em: size of the text, margin of the window


def draw_problem_dialog(report: ProblemReport, look: Look) -> list[Action]:
    """Draw the text, which can be edited, and the buttons."""
    actions: list[Action] = []
    room = imgui.get_main_viewport().size
    width = min(WIDTH * look.em, 0.9 * room.x - MARGIN * look.em)
    imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width)
    imgui.text_unformatted(
        _(
            "Lissom quit unexpectedly and saved this report. Nothing is sent. The report "
            "leaves out names of files and folders. Read it, change it as you like, then save "
            "it and send it to the makers of Lissom."
        )
        if report.is_kept
        else _(
            "Nothing is sent. The report leaves out names of files and folders. Read it, "
            "change it as you like, then save it and send it to the makers of Lissom."
        )
    )
    imgui.pop_text_wrap_pos()
    height = min(HEIGHT * look.em, 0.9 * room.y - 2.5 * MARGIN * look.em)
    changed, text = imgui.input_text_multiline("##report", report.text, ImVec2(width, height))
    if changed:
        actions.append(do(error_reports.edit_report_text, report, text))
    if main_button(look, _("Save as…")):
        actions.append(do(error_reports.ask_report_path, report))
    imgui.same_line()
    if imgui.button(_("Copy")):
        imgui.set_clipboard_text(report.text)
    imgui.same_line()
    if report.is_kept:
        if imgui.button(_("Discard")):
            actions.append(do(error_reports.discard_report, report))
        imgui.same_line()
    if imgui.button(_("Close")):
        actions.append(do(close_dialog))
    return actions
