"""Changes of the document: commands, undo, and what is selected."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import count
from typing import Concatenate, NamedTuple, ParamSpec

from app.document import (
    Command,
    Document,
    FrameRange,
    Handle,
    PreviewPose,
    changed_ranges,
    clip_of,
    handle_commands,
    key_commands,
    layer_commands,
    mirrored_handles_by_name,
    track_commands,
)
from app.editor import promises
from app.editor.actions import playback, posing
from app.editor.actions.posing.moving import giving, placing
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.timeline_view import KeyRow, KeysOf, TrackRow, frames_in, layer_of
from app.editor.work import Puppet
from app.storage import decode_picture

Arguments = ParamSpec("Arguments")


class KeyVerb(NamedTuple):
    """What is done to keys, be they in a row of poses or of a track: the commands for both.

    Where there is none for tracks, their keys stay as they are.
    """

    to_poses: Callable[..., Command]
    to_tracks: Callable[..., Command] | None = None

    def at(self, row: KeyRow, frames: frozenset[int], *args: object) -> Command | None:
        """Return the command for the keys of a row at some frames."""
        if not isinstance(row, TrackRow):
            return self.to_poses(row, frames, *args)
        return None if self.to_tracks is None else self.to_tracks(*row, frames, *args)


FIRST_KEY_STAYS = "The first key of {layers} stays: a layer has at least one key."
DELETE = KeyVerb(key_commands.delete_keys, track_commands.delete_track_keys)


@with_project
def edit(_: Session, project: Project, command: Command) -> None:
    """Run a command; those given in one use of a widget make one step of undo together."""
    project.history.do(command, gesture=project.gesture)
    _forget_what_is_gone(project)


@with_project
def edit_layer(
    session: Session,
    project: Project,
    /,
    command: Callable[Concatenate[int, Arguments], Command],
    *args: Arguments.args,
    **kwargs: Arguments.kwargs,
) -> None:
    """Run a command on the layer that is posed."""
    edit(session, command(project.active, *args, **kwargs))


@with_project
def use_widget(_: Session, project: Project, widget: int) -> None:
    """Note the number of the widget in use, 0 for none; once a frame.

    What is done in one use of a widget is one step of undo.
    """
    if widget != project.used_widget:
        project.used_widget = widget
        project.gesture = object() if widget else None


@with_project
def undo(session: Session, project: Project) -> None:
    """Take the last step back; a pull that is under way goes on in it, should it be done again.

    A change that waits for it, and is the last that was asked for, is taken back before it; so is
    a motion that is on its way. Joints of a motion that is only drafted go back by themselves.
    """
    if project.draft is not None and project.draft.past:
        project.draft = project.draft.undone
        return
    if project.errand is not None:
        giving.cancel(session)
        _tell_step(session, "Undone", "Give a motion")
        return
    is_held = any(pull.is_held for pull in project.pulls)
    waiting = None if is_held else promises.take_back(project)
    if waiting is not None:
        _tell_step(session, "Undone", waiting)
        return
    before, unkeyed, label = (
        project.document,
        project.history.preview_pose,
        project.history.undo_label,
    )
    position = project.history.position
    # What was done since they were wished is taken back before them.
    unseen = [pull for pull in project.pulls if pull.kept is None and pull.position >= position]
    # What the hand has let go can be done again: it becomes a step before that step is undone.
    unseen = [pull for pull in unseen if not posing.adopt_wish(session, project, pull)]
    for pull in unseen or [pull for pull in project.pulls if pull.is_held]:
        posing.give_up(session, project, pull)
    if unseen:
        # Nothing is to be seen of them yet but what their gestures did first.
        for pull in unseen:
            for gesture in (*pull.wishes, pull.gesture):
                project.history.revert(gesture)
    else:
        project.history.undo()
        _tell_step(session, "Undone", label)
    _forget_what_is_gone(project)
    _go_to_change(session, project, before, unkeyed)


@with_project
def take_back(session: Session, project: Project, gesture: object) -> None:
    """Undo what a gesture has done, as if it had never begun."""
    posing.take_back(session, gesture)
    project.history.revert(gesture)
    _forget_what_is_gone(project)


@with_project
def redo(session: Session, project: Project) -> None:
    """Do the step that was taken back again."""
    before, unkeyed = project.document, project.history.preview_pose
    _tell_step(session, "Done again", project.history.redo_label)
    project.history.redo()
    _forget_what_is_gone(project)
    _go_to_change(session, project, before, unkeyed)


def _tell_step(session: Session, what: str, label: str | None) -> None:
    if label is not None:
        session.tell(f"{what}: {label}", topic="undo")


def _go_to_change(
    session: Session, project: Project, before: Document, unkeyed: PreviewPose | None
) -> None:
    """Put a playhead that stands where something has changed, or as near to it as it is to be."""
    if project.playhead.since is not None:
        return
    stretches = changed_ranges(before, project.document)
    if project.history.preview_pose is not unkeyed:
        poses = filter(None, (unkeyed, project.history.preview_pose))
        stretches += [FrameRange(pose.frame, pose.frame) for pose in poses]
    here = project.playhead.frame
    if stretches and not any(here in stretch for stretch in stretches):
        frames = (stretch.clamp(here) for stretch in stretches)
        playback.seek(session, min(frames, key=lambda frame: abs(frame - here)))


@with_project
def select(_: Session, project: Project, handles: frozenset[int]) -> None:
    """Select these handles, as far as they are there, and no keys."""
    project.selected, project.chosen = handles, frozenset()
    _forget_what_is_gone(project)


@with_project
def select_all(session: Session, project: Project) -> None:
    """Select every handle or, in the timeline, the keys in all rows of layers that are posed."""
    if session.in_timeline:
        document = project.document
        posed = [row for row in project.rows if not document.layer(layer_of(row)).still]
        choose_keys_of(session, {row: frames_in(document, row) for row in posed})
    else:
        select(session, frozenset(handle.id for handle in project.layer.handles))


@with_project
def deselect(_: Session, project: Project) -> None:
    """Let no handles and no keys be selected."""
    project.selected, project.chosen_of = frozenset(), {}


@with_project
def deselect_keys(_: Session, project: Project) -> None:
    """Let no keys be selected; handles stay as they are."""
    project.chosen_of = {}


@with_project
def select_mirrored(session: Session, project: Project) -> None:
    """Select the partners of the selected handles on the other side, as their names tell."""
    pairs = mirrored_handles_by_name(project.layer.handles, project.document.pairs)
    partners = frozenset(pairs[handle] for handle in project.selected if handle in pairs)
    if partners:
        select(session, partners)
    else:
        session.tell(
            "No partner was found by name. Names tell the side as in “hand.L” and “hand.R”, "
            "“foot_l” and “foot_r”, or “left ear” and “right ear”."
        )


@with_project
def lock(session: Session, project: Project) -> None:
    """Lock the selected handles, or unlock them if all are locked."""
    if project.selected:
        chosen = [handle for handle in project.layer.handles if handle.id in project.selected]
        locked = not all(handle.locked for handle in chosen)
        edit_layer(session, handle_commands.lock_handles, project.selected, locked=locked)


@with_project
def group(session: Session, project: Project) -> None:
    """Let the selected handles be taken together."""
    if len(project.selected) > 1:
        taken = {handle.group for handle in project.layer.handles}
        name = next(f"group {n}" for n in count(1) if f"group {n}" not in taken)
        edit_layer(session, handle_commands.group_handles, project.selected, name)


@with_project
def ungroup(session: Session, project: Project) -> None:
    """Part the groups that the selected handles belong to."""
    fellows = frozenset[int]().union(*map(project.layer.grouped_handles, project.selected))
    edit_layer(session, handle_commands.group_handles, fellows, "")


@with_project
def choose_keys(session: Session, project: Project, frames: frozenset[int]) -> None:
    """Select the keys at these frames, as far as they are there, and no handles."""
    choose_keys_of(session, {project.active: frames})


@with_project
def choose_keys_of(_: Session, project: Project, chosen_of: KeysOf) -> None:
    """Select keys of several rows, as far as they are there, and no handles."""
    project.selected, project.chosen_of = frozenset(), chosen_of
    _forget_what_is_gone(project)


def change_keys(verb: KeyVerb, chosen_of: KeysOf, *args: object) -> Command:
    """Return the command that changes keys of several rows together."""
    changes = (verb.at(row, frames, *args) for row, frames in chosen_of.items())
    commands = [change for change in changes if change is not None]

    def all_of_them(document: Document) -> Document:
        for command in commands:
            document = command(document)
        return document

    return Command(commands[0].label, all_of_them)


@with_project
def delete(session: Session, project: Project) -> None:
    """Delete the selected keys or, in the timeline, the chosen track, or the selected handles.

    While a motion is drafted, leave out the joint that was touched last.
    """
    if project.draft is not None and project.draft.chosen is not None:
        placing.leave_out(session, project.draft.chosen)
    elif project.chosen_of:
        _delete_keys(session, project)
    elif session.in_timeline and project.chosen_track is not None:
        edit_layer(session, track_commands.remove_tracks, (project.chosen_track,))
    elif project.selected:
        posing.remove_handles(session, project.selected)


def _delete_keys(session: Session, project: Project) -> None:
    """Delete the chosen keys; a layer of which all keys are chosen keeps its first one."""
    chosen_of, keeping = dict(project.chosen_of), list[str]()
    for row, chosen in project.chosen_of.items():
        if not isinstance(row, TrackRow) and chosen >= frames_in(project.document, row):
            chosen_of[row] = chosen - {min(chosen)}
            keeping.append(repr(project.document.layer(row).name))
    left = {row: frames for row, frames in chosen_of.items() if frames}
    edit(session, change_keys(DELETE, left or project.chosen_of))
    if keeping:
        session.tell(FIRST_KEY_STAYS.format(layers=", ".join(keeping)))


def follow_layers(project: Project) -> None:
    """Let the window have the layers that the document has, and no others."""
    document = project.document
    gone = project.puppets.keys() - {layer.id for layer in document.layers}
    for identity in gone:
        del project.puppets[identity]
    # Those of layers that undo and redo may bring back are kept as well.
    spare = project.pictures.keys() - {layer.picture for layer in document.layers}
    for file in spare - project.history.picture_files if spare else ():
        del project.pictures[file]
    for layer in document.layers:
        puppet = project.puppets.get(layer.id)
        if puppet is not None and puppet.file is layer.picture:
            project.pictures[layer.picture] = puppet.picture
            continue
        if layer.picture not in project.pictures:
            decoded = decode_picture(layer.picture.data, layer.name)
            project.pictures[layer.picture] = decoded
        picture = project.pictures[layer.picture]
        project.puppets[layer.id] = Puppet.of(
            clip_of(document, layer.id), picture, among=len(document.layers)
        )
    if project.active not in project.puppets:
        posable = [layer.id for layer in document.layers if not layer.still]
        project.active = (posable or [layer.id for layer in document.layers])[-1]
        project.selected = project.chosen = frozenset()


def _forget_what_is_gone(project: Project) -> None:
    document = project.document
    follow_layers(project)
    project.beside &= project.puppets.keys()
    project.solo &= project.puppets.keys()
    project.selected &= {handle.id for handle in project.layer.handles}
    chosen = {row: at & frames_in(document, row) for row, at in project.chosen_of.items()}
    project.chosen_of = {row: frames for row, frames in chosen.items() if frames}
    if project.playhead.frame not in document.frames:
        frame = document.frames.clamp(project.playhead.frame)
        project.playhead = replace(project.playhead, frame=frame)


def depth_now(session: Session, project: Project, handle: Handle) -> float:
    """Return what is painted in front around a handle at the present frame, from −1 to 1."""
    return _fronts_here(session, project).get(handle.id, handle.depth)


@with_project
def set_depth(session: Session, project: Project, identity: int, front: float) -> None:
    """Set what is painted in front around a handle, in the present key if it says so already."""
    if identity in _fronts_here(session, project):
        frame = playback.posed_frame(session, project)
        edit_layer(session, layer_commands.key_depth, frame, identity, front)
    else:
        extent = project.layer.handle(identity).extent
        edit_layer(session, layer_commands.set_depth, identity, front, extent)


def _fronts_here(session: Session, project: Project) -> Mapping[int, float]:
    """Return what the key at the present frame says, if there is one."""
    frame, layer = playback.posed_frame(session, project), project.layer
    return layer.key(frame).depths if frame in layer.key_frames else {}
