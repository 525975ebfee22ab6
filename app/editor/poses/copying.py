"""Copying poses and keys, and pasting them, as they are or onto the selected handles."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial

from app.document import Figure, Keyframe, Pose, Target, Track, track_commands
from app.editor import promises
from app.editor.action import do
from app.editor.actions import playback, posing
from app.editor.poses import putting
from app.editor.project import Project
from app.editor.session import CopiedKeys, CopiedTrack, Session, with_project
from app.editor.timeline_view import TrackRow, figure_of, seen_at
from app.editor.work import Kind

COPYING = Kind("Copying a pose", "The pose could not be copied", "hand")


@with_project
def copy(session: Session, project: Project) -> None:
    """Copy the pose at the playhead or, in the timeline, the keys that are chosen there."""
    if copies_keys(session, project):
        copy_keys(session)
    else:
        frame = playback.current_frame(session, project)
        putting.take_pose(session, project, COPYING, partial(_copy, session, frame))


def copies_keys(session: Session, project: Project) -> bool:
    """Tell whether keys would be copied, and not the pose at the playhead."""
    return session.in_timeline and bool(project.chosen_of)


@with_project
def copy_keys(session: Session, project: Project) -> None:
    """Copy the chosen keys; poses on their way come to rest in the copies, too."""
    keys, tracks = [], []
    for row, at in project.chosen_of.items():
        figure, track = project.document.figure(figure_of(row)), project.track_in(row)
        if isinstance(row, TrackRow) and track is not None:
            taken = tuple(key for key in track.keys if key.frame in at)
            tracks.append(CopiedTrack(row, track, taken))
        else:
            keys.append(CopiedKeys(figure, tuple(map(figure.key, sorted(at)))))
    _take(session, keys, tracks)


def _copy(session: Session, frame: int, figure: Figure, pose: Pose) -> None:
    _take(session, [CopiedKeys(figure, (Keyframe(frame=frame, pose=pose),))])


def _take(
    session: Session, copied: Sequence[CopiedKeys], tracks: Sequence[CopiedTrack] = ()
) -> None:
    session.copied, session.copied_tracks = tuple(copied), tuple(tracks)
    poses = [key.frame for each in copied for key in each.keys]
    first, *more = poses + [key.frame for each in tracks for key in each.keys]
    single = f"Pose at frame {first}" if poses else f"Key of the track at frame {first}"
    session.tell(f"{1 + len(more)} keys copied." if more else f"{single} copied.", topic="copy")


def can_paste(session: Session, project: Project) -> bool:
    """Tell whether anything that was copied can be pasted."""
    return bool(copied_for(session, project) or _tracks_here(session, project))


def _tracks_here(session: Session, project: Project) -> Mapping[TrackRow, CopiedTrack]:
    """Return what was copied of each track, by the row on which it can be pasted.

    Keys of several tracks go to those that they are of, keys of one to that which is chosen.
    """
    copied = session.copied_tracks
    chosen = project.chosen_track
    if len(copied) == 1 and chosen is not None:
        return {TrackRow(project.active, chosen): copied[0]}
    figures = {figure.id: figure for figure in project.document.figures}
    return {
        each.row: each
        for each in copied
        if each.row.figure in figures
        and any(handle.id == each.row.handle for handle in figures[each.row.figure].handles)
    }


def copied_for(session: Session, project: Project) -> Mapping[int, CopiedKeys]:
    """Return what was copied of each figure, by the id of that on which it can be pasted.

    Keys of several figures go to those that they are of, keys of one to that which is posed.
    """
    copied = session.copied
    if len(copied) > 1:
        domains = {figure.id: figure.domain for figure in project.document.figures}
        return {
            each.figure.id: each
            for each in copied
            if domains.get(each.figure.id) is each.figure.domain
        }
    if copied and copied[0].figure.domain is project.figure.domain:
        return {project.active: copied[0]}
    return {}


def copied_here(session: Session, project: Project) -> CopiedKeys | None:
    """Return what was copied for the figure that is posed, None where that is nothing."""
    return copied_for(session, project).get(project.active)


def copied_for_selected(session: Session, project: Project) -> CopiedKeys | None:
    """Return what was copied for the figure that is posed, if handles of it are selected."""
    return copied_here(session, project) if project.selected else None


@with_project
def paste(session: Session, project: Project) -> None:
    """Put what was copied into a key at the present frame: of several keys, the first one."""
    frame = putting.stand_at_frame(session, project)
    promises.once_settled(session, do(_paste, frame), "Paste")


@with_project
def _paste(session: Session, project: Project, frame: int) -> None:
    if not can_paste(session, project):
        return
    copied, tracks = copied_for(session, project), _tracks_here(session, project)
    keys = {
        figure: putting.fitted(project, figure, each.keys, each.figure.bounds)
        for figure, each in copied.items()
    }
    frames = [key.frame for each in keys.values() for key in each]
    starts = [seen_at(project.document, c.track, k.frame) for c in tracks.values() for k in c.keys]
    first, gesture = min([*frames, *starts], default=0), object()
    project.chosen_of = {}
    if keys:
        putting.put(session, project, frame + min(frames) - first, keys, gesture=gesture)
    for row, each in tracks.items():
        _paste_track(session, project, row, each, frame - first, gesture)


def _paste_track(
    session: Session, project: Project, row: TrackRow, copied: CopiedTrack, by: int, gesture: object
) -> None:
    """Put keys of a track into that of a row so many frames later; these are chosen then."""
    figure = project.document.figure(row.figure)
    track, name = figure.track_of(row.handle), figure.handle(row.handle).name
    if track is not None and track.planted != copied.track.planted:
        session.tell(
            f"The keys that were copied are {_kind(copied.track)}, those of {name} are "
            f"{_kind(track)}. Set both alike in the Handle tab, then copy again."
        )
        return
    by += copied.track.delay - (0 if track is None else track.delay)
    keys = tuple(replace(key, frame=key.frame + by) for key in copied.keys)
    if keys[0].frame < 0:
        session.tell(f"The track of {name} is too late for a key at this frame.")
        return
    if track is None:
        track = replace(copied.track, handles=(row.handle,), keys=keys)
        command = track_commands.put_track(row.figure, track)
    else:
        command = track_commands.put_track_keys(*row, keys)
    project.history.do(command, gesture=gesture)
    frames = frozenset(key.frame for key in keys)
    project.selected, project.chosen_of = frozenset(), {**project.chosen_of, row: frames}


def _kind(track: Track) -> str:
    return "planted" if track.planted else "with the pose"


@with_project
def paste_on_selected(session: Session, project: Project) -> None:
    """Let the selected handles go where they were in what was copied, and the shape follow."""
    copied = copied_for_selected(session, project)
    if copied is not None:
        pull_selected(session, project, copied.keys[0].pose.targets)


def pull_selected(session: Session, project: Project, targets: Mapping[int, Target]) -> None:
    """Wish the selected handles, as far as they are known, where a pose has them."""
    wishes = {i: targets[i] for i in project.selected if i in targets}
    if wishes:
        posing.wish(session, wishes)
