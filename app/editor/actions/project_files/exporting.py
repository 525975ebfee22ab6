"""Exports: started here, drawn by the window a few frames at a time."""

import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from app.document import ExportSettings, FrameRange
from app.editor import pending_changes
from app.editor.action import Action, do
from app.editor.actions import playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.actions.posing.pose_commit import key_pose_command
from app.editor.error_reports import as_sentence, report_failure, run_job
from app.editor.parts.export_state import ExportRun
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.pending_change import DeferredAction
from app.errors import LissomError, display_name
from app.export import (
    ExportRequest,
    check_request,
    clipboard_program,
    list_overwritten_files,
    plan_export,
    put_on_clipboard,
    with_reduced_meshes,
)
from app.export_formats import EXPORT_FORMATS, STILL_FORMAT
from app.motion import Evaluator, extent_key
from app.storage import make_settings_folder, temporary_picture
from app.texts import _, ngettext

UNDER_WAY = _("An export is running. Start the next export when it is done.")
RUNNING = _("An export is running")
CANCELLED_UNWRITTEN = _("The export was cancelled. Nothing was written.")
CANCELLED_MIDWAY = _("The export was cancelled. Frames that were written stay.")
PREPARING = JobKind(_("Preparing the export"), _("The export could not begin"), "export")
COPYING = JobKind(_("Copying the picture"), _("The picture was not copied"), "export")


@with_project
def replace_export_files(session: Session, project: Project, out: Path) -> None:
    """Export, and replace existing files."""
    project.exports.allow_replacing(project.document.export.format, out)
    start_export(session, out)


@with_project
def start_export(session: Session, project: Project, out: Path) -> None:
    """Export to a folder or a file; ask first if the export replaces other files."""
    if not _is_free(session):
        return
    settings = project.document.export
    request = _request(session, project, out, settings)
    check_request(project.document, request)
    is_replaceable = project.exports.replaceable == (settings.format, out)
    there = [] if is_replaceable else list_overwritten_files(project.document, request)
    if there:
        count, listed = len(there), there[0] if len(there) == 1 else f"{there[0]} … {there[-1]}"
        folder = out.parent if out.name in there else out
        session.dialogs.ask(
            title=ngettext("Replace the file?", "Replace the {count} files?", count).format(
                count=count
            ),
            text=_("{folder} already contains {files}.").format(folder=folder, files=listed),
            answers=((_("Replace"), do(replace_export_files, out)),),
        )
        return
    # Playback would take the time of the export.
    playback.stop_playback(session)
    session.export.begin()
    pending_changes.run_when_idle(session, do(_begin, request), _("Export"), changes=False)


@with_project
def _begin(session: Session, project: Project, request: ExportRequest) -> None:
    """Start an export once no change is pending."""
    out, settings = request.out, request.settings

    def begun(run: ExportRun) -> None:
        session.export.start(run)
        project.exports.choose(settings.format, out)
        folder = out.parent if EXPORT_FORMATS[settings.format].suffixes else out
        session.settings.prefer(exported=folder)
        # A new pose makes a new picture, which must not replace this one without a question.
        if EXPORT_FORMATS[settings.format].is_still:
            project.exports.forbid_replacing()
        else:
            project.exports.allow_replacing(settings.format, out)

    _prepare(session, project, request, begun)


@named_action(_("Copy picture"), "Ctrl+Shift+C")
@with_project
def copy_picture(session: Session, project: Project) -> None:
    """Copy the picture of the shown frame to the clipboard, drawn as an export draws it."""
    if not _is_free(session):
        return
    clipboard_program()  # raises an error with the program to install if there is none
    make_settings_folder(session.settings.folder)
    settings = replace(project.document.export, format=STILL_FORMAT)
    request = _request(session, project, temporary_picture(session.settings.folder), settings)
    check_request(project.document, request)
    session.export.begin()
    label = _("Copy the picture")
    pending_changes.run_when_idle(session, do(_begin_copy, request), label, changes=False)


@with_project
def _begin_copy(session: Session, project: Project, request: ExportRequest) -> None:
    def begun(run: ExportRun) -> None:
        session.export.start(replace(run, for_clipboard=True))

    _prepare(session, project, request, begun)


def is_export_under_way(session: Session) -> bool:
    """Return whether an export runs, is prepared, or waits for pending changes."""
    is_waiting = session.project is not None and any(
        map(_is_export, session.project.pending.deferred)
    )
    return is_waiting or session.export.run is not None or PREPARING in session.jobs.kinds


def _is_export(waiting: DeferredAction) -> bool:
    return waiting.then.verb in {_begin, _begin_copy}


def _is_free(session: Session) -> bool:
    """Return whether no export is under way; if one is, show a notice."""
    if not is_export_under_way(session):
        return True
    session.notices.show(UNDER_WAY, topic="export")
    return False


def _request(
    session: Session, project: Project, out: Path, settings: ExportSettings
) -> ExportRequest:
    if EXPORT_FORMATS[settings.format].is_still:
        now = project.timeline.playhead.frame_at(project.document, session.clock())
        settings = replace(settings, frames=FrameRange(now, now))
    return ExportRequest(
        out=out, settings=settings, project=project.file.name, sources=project.file.sources
    )


def _prepare(
    session: Session,
    project: Project,
    request: ExportRequest,
    begun: Callable[[ExportRun], None],
) -> None:
    """Prepare a checked export on a worker, and then start it."""
    document, format_ = project.document, EXPORT_FORMATS[request.settings.format]
    unkeyed = project.history.preview_pose
    if format_.is_still and unkeyed is not None and unkeyed.layer == project.selection.active:
        frames = request.settings.frames
        if frames is not None and unkeyed.frame in frames:
            document = key_pose_command(session, project, unkeyed)(document)
    pictures = {layer: each.cut.value.texture for layer, each in project.runtimes.layers.items()}
    samplers = project.samplers
    extent = project.measured.extent
    box = extent.value if extent.follows(extent_key(document)) else None
    cancellation = session.export.cancellation

    def work() -> ExportRun:
        detail = request.settings.shapes.triangles
        exported = document if format_.is_drawn else with_reduced_meshes(document, detail)
        evaluator = Evaluator.exact(exported, samplers, cancellation.check)
        plan = plan_export(exported, request, evaluator, box)
        return ExportRun(document=exported, pictures=pictures, evaluator=evaluator, plan=plan)

    run_job(session, PREPARING, work, begun)


@named_action(
    _("Cancel export"),
    "Escape",
    why_disabled=unless(
        lambda session, _: is_export_under_way(session) and session.export.run is None,
        _("No export is being prepared."),
    ),
)
def cancel_preparing(session: Session) -> None:
    """Cancel an export of which no frame is drawn yet."""
    cancel_export(session)


def cancel_export(session: Session) -> None:
    """Cancel the export unless its file is complete; written frames stay."""
    run, project = session.export.run, session.project
    if not is_export_under_way(session):
        return
    if project is not None:
        project.pending.drop_deferred(list(filter(_is_export, project.pending.deferred)))
    # Dropped first, so that no failure is reported; then abandoned, since it may take long.
    session.jobs.drop(PREPARING)
    session.jobs.abandon(PREPARING)
    is_nothing_written = session.export.cancellation.cancel()
    if run is not None and _is_one_file(run) and not is_nothing_written:
        return
    session.export.end()
    session.notices.show(CANCELLED_UNWRITTEN if is_nothing_written else CANCELLED_MIDWAY)


def confirm_ending_export(session: Session, then: Action) -> None:
    """Run an action that ends an export, but ask first if one is under way."""
    run = session.export.run
    if not is_export_under_way(session):
        then.apply(session)
        return
    done, total = (run.done, len(run.plan.times)) if run is not None else (0, 0)
    progress = _("The export is being prepared.")
    if total:
        progress = ngettext(
            "{done} of {total} frame is drawn.", "{done} of {total} frames are drawn.", total
        ).format(done=done, total=total)
    result = _("If you quit now, the written frames stay.")
    if run is not None and _is_one_file(run):
        result = _("If you quit now, no file is written.")
    session.dialogs.ask(
        title=RUNNING,
        text=f"{progress} {result}",
        answers=((_("Quit"), then),),
    )


def _is_one_file(run: ExportRun) -> bool:
    return bool(EXPORT_FORMATS[run.plan.format].suffixes)


def update_export_progress(session: Session, run: ExportRun, done: int) -> None:
    """Note the number of drawn frames."""
    session.export.note_progress(run, done)


def finish_export(session: Session, run: ExportRun, notices: Sequence[str]) -> None:
    """Show a notice that an export is complete, with its warnings."""
    session.export.end()
    if run.for_clipboard:
        _copy(session, run.plan.out)
        return
    session.export.complete(run.plan)
    folder = run.plan.out if run.plan.out.is_dir() else run.plan.out.parent
    name, count = run.plan.out.name, len(run.plan.times)
    if EXPORT_FORMATS[run.plan.format].is_drawn:
        text = ngettext(
            "Exported {count} frame to {name}.", "Exported {count} frames to {name}.", count
        ).format(count=count, name=name)
    else:
        text = _("Exported {name}.").format(name=name)
    session.notices.show(
        text,
        tone="good",
        label=_("Open folder"),
        action=do(open_folder, folder),
    )
    for notice in (*notices, *run.plan.notices):
        session.notices.show(as_sentence(notice))


def _copy(session: Session, picture: Path) -> None:
    """Put a picture on the clipboard, and delete its file."""

    def work() -> None:
        try:
            put_on_clipboard(picture)
        finally:
            picture.unlink(missing_ok=True)

    text = _("The picture is on the clipboard.")
    run_job(session, COPYING, work, lambda _result: session.notices.show(text, tone="good"))


def report_failed_export(session: Session, error: Exception) -> None:
    session.export.end()
    report_failure(session, _("The export failed"), error)


def open_folder(session: Session, folder: Path) -> None:
    try:
        if sys.platform == "win32":
            os.startfile(folder)  # noqa: S606 - the folder of the export
            return
        opener = "open" if sys.platform == "darwin" else "xdg-open"
        subprocess.Popen([opener, folder], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)  # noqa: S603
    except OSError:
        text = _("no file manager was found; the folder is {folder}")
        raise LissomError(text.format(folder=folder)) from None
    session.tools.show_hint(display_name(folder))
