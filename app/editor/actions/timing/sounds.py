"""Sounds of the document: added, found again, dragged in time, and their waveforms."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

from app.document import VOLUME, Command, Document, Sound, sound_commands
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action
from app.editor.error_reports import run_job
from app.editor.parts.timeline.gestures import SoundDrag
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.errors import LissomError, display_name
from app.sound import SUFFIXES, InspectedSound, inspect_sound, new_sound
from app.storage import read_file
from app.texts import _

WAVEFORMS = JobKind(_("Waveforms"), _("A waveform cannot be drawn"))


@named_action(_("Add sound…"), icon="MUSIC", hint=_("Add a WAV, FLAC, MP3 or OGG file"))
def ask_sound_to_add(session: Session) -> None:
    session.ask_file(_("Add a sound"), SUFFIXES, lambda path: do(add_sounds, [path]))


def add_sounds(session: Session, paths: Sequence[Path]) -> None:
    """Read sound files on the worker, and add them at the playhead."""
    for path in paths:
        name = display_name(path.name)
        kind = JobKind(
            _("Reading {name}").format(name=name), _("{name} cannot be added").format(name=name)
        )
        run_job(session, kind, partial(_read, path), partial(add_inspected_sound, session))


@with_project
def add_inspected_sound(session: Session, project: Project, inspected: InspectedSound) -> None:
    """Add a sound that was read, select it, and show its tab."""
    project.measured.note_waveform(inspected)
    start = playback.current_frame(session, project)
    editing.edit_document(session, sound_commands.add_sound(new_sound(inspected, start)))
    project.selection.select_sound(project.document.sounds[-1].name)
    session.display.focus_panel("Animate")
    file = inspected.file
    text = _("Added {name}: {seconds:.1f} s. The project keeps its {size:,.0f} KB.")
    known = {"name": file.name, "seconds": file.seconds, "size": file.size / 1000}
    session.notices.show(text.format(**known), tone="good")


def ask_sound_file(session: Session, name: str) -> None:
    """Ask for the file of a sound that is missing, or for another."""
    title = _("Find the file of {name}").format(name=name)
    session.ask_file(title, SUFFIXES, lambda path: do(find_sound_file, name, path))


def find_sound_file(session: Session, name: str, path: Path) -> None:
    """Read a sound file on the worker, and give it to a sound."""
    kind = JobKind(
        _("Reading {name}").format(name=display_name(path.name)),
        _("The sound cannot be replaced"),
    )
    run_job(session, kind, partial(_read, path), partial(_replace, session, name))


@with_project
def _replace(session: Session, project: Project, name: str, inspected: InspectedSound) -> None:
    old = project.document.sound(name).file
    project.measured.note_waveform(inspected)
    editing.edit_document(session, sound_commands.replace_sound_file(name, inspected.file))
    if old.data is None and old.sha256 != inspected.file.sha256:
        text = _("{name} is not the file that was missing. The sound plays it anyway.")
        session.notices.show(text.format(name=inspected.file.name))


def _read(path: Path) -> InspectedSound:
    return inspect_sound(read_file(path), display_name(path.name))


def selected_sound(project: Project) -> Sound | None:
    """Return the selected sound, or else the first one."""
    sounds, chosen = project.document.sounds, project.selection.channel
    if chosen is not None and chosen.kind is VOLUME:
        return next((each for each in sounds if each.name == chosen.part), None) or sounds[0]
    return sounds[0] if sounds else None


@with_project
def select_sound(_: Session, project: Project, name: str) -> None:
    project.selection.select_sound(name)


@with_project
def update_waveforms(session: Session, project: Project) -> None:
    """Inspect the sounds without a waveform on the worker, one after the other."""
    known = project.measured.waveforms
    missing = [
        each.file
        for each in project.document.sounds
        if each.file.data is not None and each.file.sha256 not in known
    ]
    if not missing or WAVEFORMS in session.jobs.kinds:
        return
    file = missing[0]

    def inspect() -> InspectedSound | None:
        try:
            return inspect_sound(file.data or b"", file.name)
        except LissomError:
            return None

    def done(inspected: InspectedSound | None) -> None:
        if session.project is project:
            project.measured.note_waveform(inspected, file.sha256)

    run_job(session, WAVEFORMS, inspect, done)


def drag_sound(before: Document, drag: SoundDrag, frame: float) -> Command:
    """Return the command that moves or cuts a sound by a drag; it keeps to whole frames."""
    sound, fps = before.sound(drag.sound), before.fps
    by = round(frame - drag.start)
    match drag.part:
        case "whole":
            return sound_commands.move_sound(sound.name, sound.start + by)
        case "begin":
            at = round(sound.start + frame - drag.start) - sound.start
            skip = max(sound.skip + at / fps, 0.0)
            return sound_commands.cut_sound(sound.name, skip, sound.length - (skip - sound.skip))
        case "end":
            end = round(sound.end(fps) + frame - drag.start)
            return sound_commands.cut_sound(sound.name, sound.skip, (end - sound.start) / fps)
