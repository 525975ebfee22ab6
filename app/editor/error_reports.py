"""Notices of failures, and problem reports about unexpected errors."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TypeVar

from app.editor.action import do
from app.editor.parts.dialogs import FileDialog, ProblemReport, RecoveryDialog
from app.editor.session import Session
from app.editor.work.jobs import Job, JobKind
from app.errors import EXPECTED_ERRORS
from app.reports import format_problem_report, format_trace, redact_names
from app.storage import (
    check_writable,
    load_report,
    mark_report_seen,
    read_fault_log,
    remove_report,
    write_atomically,
    write_report,
)
from app.texts import _, message_of
from engine.errors import Message

Result = TypeVar("Result")


def as_sentence(said: Exception | Message | str) -> str:
    """Return an error or notice as a sentence: an upper-case start and a full stop."""
    text = message_of(said)
    begins_with_name = not text.partition(" ")[0].isalpha()
    text = text if begins_with_name else text[:1].upper() + text[1:]
    return text if text.endswith((".", "?", "…")) else f"{text}."


def run_job(
    session: Session,
    kind: JobKind,
    work: Callable[[], Result],
    done: Callable[[Result], None],
    failed: Callable[[Exception], None] | None = None,
) -> None:
    """Run a job in place of an unfinished job of its kind; show a notice if it fails."""
    complain = partial(report_failure, session, kind.complaint)
    session.jobs.put(Job(kind=kind, work=work, done=done, failed=failed or complain))


def report_first_failure(session: Session, what: str, error: Exception) -> None:
    """Report the failure of a repeated attempt once, until the attempt succeeds."""
    if session.diagnostics.note_failure(what):
        report_failure(session, what, error)


def report_failure(session: Session, what: str, error: Exception) -> None:
    """Show which work failed and why; an unexpected error comes with details to copy."""
    if isinstance(error, EXPECTED_ERRORS):
        session.notices.show(as_sentence(f"{what}: {message_of(error)}"), tone="error")
    else:
        report_unexpected_error(session, f"{what}.", error)


def report_unexpected_error(
    session: Session, text: str, error: Exception, *, topic: str = ""
) -> None:
    """Report a fault of the program, with details to copy and a report to save."""
    trace = error_trace(session, error)
    session.diagnostics.note_error(trace)
    session.notices.show(
        text,
        tone="error",
        topic=topic,
        details=trace,
        label=_("Report…"),
        action=do(show_problem_report),
    )


def error_trace(session: Session, error: Exception) -> str:
    """Return the traceback of an unexpected error, without the person's paths."""
    return format_trace(error, _hidden(session))


def problem_report_text(session: Session) -> str:
    """Return the text of a report about the session and its last error."""
    known = session.diagnostics
    return format_problem_report(
        graphics=known.graphics, actions=known.logged_actions, trace=known.last_error_trace
    )


def keep_crash_report(session: Session, error: Exception) -> str:
    """Write a report of a fatal error beside unsaved work, and return it."""
    session.diagnostics.note_error(error_trace(session, error))
    text = problem_report_text(session)
    write_report(session.settings.folder, text)
    return text


def keep_fault_report(session: Session) -> None:
    """Write a report of an earlier crash of Python, for example in a driver, if there was one."""
    logged = read_fault_log(session.settings.folder)
    if logged:
        trace = redact_names(logged, _hidden(session))
        write_report(
            session.settings.folder, format_problem_report(graphics="", actions=(), trace=trace)
        )


def show_problem_report(session: Session) -> None:
    text = problem_report_text(session)
    session.dialogs.show(ProblemReport(text=text, is_kept=False, behind=_behind(session)))


def show_kept_or_new_report(session: Session) -> None:
    """Show the kept report of an earlier crash, or else a report of this session."""
    text = load_report(session.settings.folder)
    if text:
        session.dialogs.show(ProblemReport(text=text, is_kept=True, behind=_behind(session)))
    else:
        show_problem_report(session)


def offer_kept_report(session: Session) -> None:
    """Offer the kept report of an earlier crash once, unless a dialog is open."""
    if session.dialogs.current is None and mark_report_seen(session.settings.folder):
        session.notices.show(
            _(
                "Lissom quit unexpectedly last time. A report is saved on this computer. "
                "Nothing was sent."
            ),
            label=_("Show"),
            action=do(show_kept_or_new_report),
        )


def edit_report_text(session: Session, report: ProblemReport, text: str) -> None:
    """Set the text of the report after an edit by the person."""
    session.dialogs.show(replace(report, text=text))


def ask_report_path(session: Session, report: ProblemReport) -> None:
    session.dialogs.show(
        FileDialog(
            title=_("Save the report"),
            folder=session.settings.usual_folder,
            name=_("Lissom report") + ".txt",
            suffixes=(".txt",),
            writes=True,
            chosen=lambda path: do(save_report, report, path),
        )
    )


def save_report(session: Session, report: ProblemReport, path: Path) -> None:
    """Save a report to a file; a kept report is deleted then."""
    check_writable(path, sources=())
    write_atomically(path, lambda file: file.write(report.text.encode()))
    if report.is_kept:
        remove_report(session.settings.folder)
    session.dialogs.show(report.behind)
    session.notices.show(_("Saved {name}.").format(name=path.name), tone="good")


def discard_report(session: Session, report: ProblemReport) -> None:
    remove_report(session.settings.folder)
    session.dialogs.show(report.behind)
    session.notices.show(_("The report was discarded."))


def _behind(session: Session) -> RecoveryDialog | None:
    """Return the dialog that follows a report."""
    dialog = session.dialogs.current
    if isinstance(dialog, ProblemReport):
        return dialog.behind
    return dialog if isinstance(dialog, RecoveryDialog) else None


def _hidden(session: Session) -> set[Path]:
    """Return the paths that a report hides."""
    project, preferences = session.project, session.settings.preferences
    known = {*preferences.recent, *preferences.written}
    if project is not None:
        known |= {*project.file.sources, *project.exports.by_format.values()}
    return known
