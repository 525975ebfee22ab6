"""Settings and destination of the next export."""

from collections.abc import Callable
from pathlib import Path

from app.editor.action import Action, do
from app.editor.actions.action_spec import named_action
from app.editor.actions.project_files.exporting import start_export
from app.editor.parts.dialogs import FileDialog
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.export import FRAMES, FrameNames, data_file, with_suffix_for
from app.export_formats import EXPORT_FORMATS
from app.motion import BoundingBox
from app.texts import _


def ask_destination_and_export(session: Session) -> None:
    """Ask for a destination, and start the export."""
    _ask(session, _("Export"), lambda path: do(start_export_at, path))


def ask_export_destination(session: Session) -> None:
    """Ask for the destination of the next export; do not start it."""
    _ask(session, _("Choose"), lambda path: do(set_export_destination, path))


@with_project
def set_export_destination(_: Session, project: Project, out: Path) -> None:
    """Set the destination of the next export of this format."""
    name = project.document.export.format
    project.exports.choose(name, out)
    data = data_file(out, name)
    if EXPORT_FORMATS[name].suffixes and not (data is not None and data.exists()):
        # The file dialog has already asked whether to replace the file.
        project.exports.allow_replacing(name, out)


def start_export_at(session: Session, out: Path) -> None:
    set_export_destination(session, out)
    start_export(session, out)


@named_action(_("Export again"), "Ctrl+Shift+E")
@with_project
def repeat_export(session: Session, project: Project) -> None:
    """Export to the chosen or last destination; ask if there is neither."""
    out = export_destination(project)
    if out is not None:
        start_export(session, out)
    else:
        ask_destination_and_export(session)


def export_destination(project: Project) -> Path | None:
    """Return the destination of the next export, or None.

    This is the last destination of the format. The first export of a format goes beside the last
    export of another format, under a suitable name.
    """
    name, places = project.document.export.format, project.exports.by_format
    newest = next(reversed(places.values()), None)
    return places.get(name) or (with_suffix_for(newest, name) if newest else None)


def set_aspect_locked(session: Session, keeps: bool) -> None:  # noqa: FBT001 - the only argument
    """Link or unlink width and height of an export."""
    session.export.lock_aspect(locked=keeps)


def preview_export_frame(session: Session, box: BoundingBox) -> None:
    """Show the export's frame in the viewport, until the next frame of the window."""
    session.export.show_frame_box(box)


@with_project
def _ask(session: Session, project: Project, verb: str, chosen: Callable[[Path], Action]) -> None:
    if session.export.run is not None:
        return
    settings = project.document.export
    suffixes = EXPORT_FORMATS[settings.format].suffixes
    out = export_destination(project)
    if out is None:
        out = (
            session.settings.usual_folder
            / f"{project.file.name}{suffixes[0] if suffixes else FRAMES}"
        )
    session.dialogs.show(
        FileDialog(
            title=_("Export to file") if suffixes else _("Export to folder"),
            folder=out.parent,
            name=out.name,
            suffixes=suffixes,
            writes=True,
            verb=verb,
            chosen=chosen,
            is_frame=FrameNames(pattern=settings.names, project=project.file.name).fits,
        )
    )
