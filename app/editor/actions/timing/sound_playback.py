"""Playing and scrubbing sounds. While they play, they lead the playhead."""

from dataclasses import replace

from app.document import loop_length
from app.editor.error_reports import as_sentence
from app.editor.parts.timeline.gestures import ScrubDrag
from app.editor.parts.timeline.timeline_state import HeardSound
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import LissomError
from app.sound import PlayedRange, SoundMix, stream_part, stream_range
from app.texts import _, message_of

SHORTEST = 0.06  # seconds of a frame that are heard while it is scrubbed
UNHEARD = _("Sounds cannot be heard here: {error}. Exports still contain them.")


@with_project
def play_heard_sounds(session: Session, project: Project) -> None:
    """Play what the playhead plays, and let it follow what is heard; once a frame."""
    timing, player = project.timeline, session.player
    playhead, heard = timing.playhead, timing.heard or HeardSound(playhead=timing.playhead)
    is_heard = any(not each.muted and each.file.data for each in project.document.sounds)
    if heard.playhead.since is not None and (playhead.since is None or not is_heard):
        player.stop()
    if not is_heard:
        timing.note_heard(None)
    elif playhead.since is not None:
        if heard.playhead is not playhead or heard.source != _source(project):
            _play(session, project)
        elif player.failure is None:
            _lead(session, project, heard)
    elif isinstance(timing.gesture, ScrubDrag) and heard.playhead.frame != playhead.frame:
        _scrub(session, project)
    elif heard.playhead is not playhead or timing.heard is None:
        timing.note_heard(replace(heard, playhead=playhead))
    player.rest()


def _source(project: Project) -> tuple[object, ...]:
    """Return all values that a mix depends on."""
    document = project.document
    return document.sounds, document.fps, document.loop, document.frames, document.preview


def _mix(session: Session, project: Project) -> SoundMix | None:
    """Return the mix of the present sounds; None if they cannot be heard, said in one notice."""
    heard, player = project.timeline.heard, session.player
    if heard is not None and heard.source == _source(project):
        return heard.mix
    if player.failure is not None:
        return None
    try:
        return SoundMix(project.document, player.rate)
    except LissomError as error:
        session.notices.show(as_sentence(UNHEARD.format(error=message_of(error))))
        return None


def _play(session: Session, project: Project) -> None:
    """Play from the present frame on."""
    document, timing = project.document, project.timeline
    mix, now = _mix(session, project), session.clock()
    frame = timing.playhead.frame_at(document, now)
    if mix is not None:
        played = document.played_frames
        session.player.play(
            stream_range(
                mix,
                PlayedRange(
                    start=frame,
                    speed=timing.playhead.speed,
                    first=played.first,
                    length=loop_length(document) if document.loop else None,
                ),
            )
        )
        if timing.recording is None:
            timing.seek(frame, now)
    timing.note_heard(HeardSound(source=_source(project), playhead=timing.playhead, mix=mix))


def _lead(session: Session, project: Project, heard: HeardSound) -> None:
    """Put the playhead where the sound is."""
    if heard.mix is None:
        return
    elapsed = session.player.elapsed()
    if elapsed is None:
        reason = _("the sound device does not answer")
        session.player.lose_device(reason)
        session.notices.show(UNHEARD.format(error=reason))
    elif project.timeline.recording is None:
        project.timeline.lead(session.clock() - elapsed)


def _scrub(session: Session, project: Project) -> None:
    """Let the frame under the playhead be heard."""
    mix, playhead = _mix(session, project), project.timeline.playhead
    if mix is not None:
        seconds = max(1 / project.document.fps, SHORTEST)
        session.player.play(stream_part(mix, playhead.frame, seconds))
    heard = HeardSound(source=_source(project), playhead=playhead, mix=mix)
    project.timeline.note_heard(heard)
