"""What is done with tracks: choosing their rows, and keys of single handles."""

from collections.abc import Mapping, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np

from app.document import (
    Command,
    Document,
    Figure,
    Track,
    TrackKey,
    clip_of,
    track_at,
    track_commands,
)
from app.editor import promises
from app.editor.actions import editing, playback, posing
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.timeline_view import own_frame, seen_at
from app.editor.work import Kind
from app.motion import Animation, PoseSampler, hung_on
from engine.geometry import HERE, RigidMotion

PLACING = Kind("Placing keys of a track", "The places of the track's keys could not be found")


@with_project
def choose(_: Session, project: Project, handle: int | None) -> None:
    """Choose the row of a handle's track, so that drags of it go there; None the whole pose's."""
    project.chosen_track = handle


@with_project
def key_selected(session: Session, project: Project) -> None:
    """Key the selected handles alone at the present frame."""
    key_here(session, sorted(project.selected))


@with_project
def key_here(session: Session, project: Project, handles: Sequence[int]) -> None:
    """Key handles alone at the present frame, where they are now, and choose their track's row.

    Those that have no track get one together, with the pose; their first key is no offset.
    """
    playback.halt(session)
    posing.let_go(session)
    figure, gesture = project.figure, object()
    new = tuple(identity for identity in handles if figure.track_of(identity) is None)
    if new:
        frame = playback.current_frame(session, project)
        key = TrackKey(frame=frame, place=0j, easing=session.preferences.easing)
        command = track_commands.put_track(project.active, Track(handles=new, keys=(key,)))
        project.history.do(Command("Key handle", command.change), gesture=gesture)
    known = {figure.track_of(identity) for identity in handles} - {None}
    for track in known:
        if track is not None:
            _key(session, project, track, gesture)
    project.chosen_track = (new or tuple(handles))[0]
    project.timing.unfolded |= {project.active}


def _key(session: Session, project: Project, track: Track, gesture: object) -> None:
    """Insert a key into a track at the present frame that changes nothing there."""
    frame, figure = playback.current_frame(session, project), project.figure
    own = _own_frame(session, project, track, frame)
    if own is None or own in track.key_frames:
        return
    easing = session.preferences.easing

    def put(place: complex, turn: float | None = None) -> None:
        put_key = track_commands.put_track_key
        command = put_key(figure.id, track.handles[0], own, place, turn=turn, easing=easing)
        if figure.id in project.puppets and project.document.figure(figure.id).tracks:
            project.history.do(command, gesture=gesture)

    at = track_at(track, project.clip, frame)
    if at is not None:
        put(at.place, at.turn if track.turns else None)
    elif not track.planted:
        put(0j)
    else:
        place = partial(_beside, project.document, figure, track, [frame], project.samplers)
        promises.begin(session, project, PLACING, place, lambda found: put(found[0].planted(0j)))


@with_project
def put(
    session: Session, project: Project, handle: int, place: complex, turn: float | None = None
) -> None:
    """Let the track of a handle have a key at the present frame that wants it at a place.

    Of a track with the pose, 0 is where the pose has it: there the track may begin and end.
    """
    playback.halt(session)
    track = project.figure.track_of(handle)
    if track is None:
        return
    own = _own_frame(session, project, track, playback.current_frame(session, project))
    if own is not None:
        key, easing = track_commands.put_track_key, session.preferences.easing
        editing.edit_figure(session, key, handle, own, place, turn=turn, easing=easing)


def _own_frame(session: Session, project: Project, track: Track, frame: int) -> int | None:
    """Return the frame of the key that is seen at a frame; where there can be none, it is told."""
    own = own_frame(project.document, track, frame)
    if own is None:
        session.tell(
            f"The track is {track.delay} frames late: no key of it can be seen at frame {frame}."
        )
    return own


class _Beside(NamedTuple):
    """Where a handle is in a frame without its track, as places of tracks' keys are told by it."""

    place: complex  # by the figure itself
    turned: complex  # of modulus 1: by how much the shape is turned there
    carried: RigidMotion  # where the figure hangs

    def planted(self, offset: complex) -> complex:
        """Return the place in the picture of an offset beside the pose."""
        place = np.array([self.place + offset * self.turned])
        return complex(self.carried.on(place)[0])

    def offset(self, planted: complex) -> complex:
        """Return by how much a place in the picture is beside the pose."""
        return (self.carried.back(planted) - self.place) * self.turned.conjugate()


def _beside(
    document: Document,
    figure: Figure,
    track: Track,
    frames: Sequence[int],
    siblings: Mapping[int, PoseSampler],
) -> list[_Beside]:
    """Return where the first handle of a track is in some frames without it."""
    clip, point = clip_of(document, figure.id), figure.handle(track.handles[0]).position
    hung = hung_on(document, figure.id, siblings)
    sampler = PoseSampler(
        figure.domain,
        anchor=figure.anchor,
        points=np.array([point]),
        sibling=siblings.get(figure.id),
    )
    animation = Animation(clip, sampler=sampler, hung=hung)
    found = []
    for frame in frames:
        still = animation.still_frame(frame)
        fz = complex(still.fz[0])
        hangs = HERE if hung is None else hung.carried(frame)
        found.append(_Beside(complex(still.positions[0]), fz / abs(fz), hangs))
    return found


@with_project
def plant(session: Session, project: Project, handle: int, planted: bool) -> None:  # noqa: FBT001
    """Let a track's keys be places in the picture, or beside the pose; none moves by that."""
    figure, track = project.figure, project.figure.track_of(handle)
    if track is None or track.planted == planted:
        return
    frames = [seen_at(project.document, track, key.frame) for key in track.keys]
    work = partial(_beside, project.document, figure, track, frames, project.samplers)

    def take(found: list[_Beside]) -> None:
        now = {each.id: each for each in project.document.figures}.get(figure.id)
        if now is None or track not in now.tracks:
            # It became another one meanwhile.
            return
        pairs = zip(found, track.keys, strict=True)
        places = [
            each.planted(key.place) if planted else each.offset(key.place) for each, key in pairs
        ]
        project.history.do(track_commands.plant_track(figure.id, handle, places, planted=planted))

    promises.begin(session, project, PLACING, work, take)
