"""What a person does with layers: choosing, ordering, hiding, hanging one on another."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

import numpy as np

from app.document import Attachment, Figure, is_visible, layer_commands
from app.editor.action import do
from app.editor.actions import editing, files, playback, posing
from app.editor.dialogs import FileDialog, Question
from app.editor.failures import report, sentence
from app.editor.jobs import Job
from app.editor.project import Project
from app.editor.session import Session
from app.errors import LissomError
from app.motion import Joints
from app.storage import (
    Layer,
    Picture,
    decode_picture,
    layer_figure,
    read_picture_file,
    still_figure,
)
from engine.geometry import contains

T = TypeVar("T")
RISING, ADDING, HANGING = "Finding a shape", "Adding a layer", "Hanging a layer"


def choose(session: Session, identity: int) -> None:
    """Let a figure be the one whose handles and keys are shown and changed."""
    project = session.project
    if project is None or identity == project.active:
        return
    posing.drop(session)
    project.active = identity
    project.selected = project.chosen = frozenset()
    project.meshing = project.drafted_bounds = None
    session.hovered = None


def figure_at(
    project: Project, place: complex, *, below: int | None = None, besides: int | None = None
) -> int | None:
    """Return the figure that is seen in front at a place of the scene, None where there is none.

    Still, hidden and locked ones are passed through.

    Parameters
    ----------
    project : Project
    place : complex
    below : int, optional
        Where that figure is there, too, the next one behind it is returned, or at last the first.
    besides : int, optional
        A figure that is passed through.
    """
    found = [
        each.id
        for each in reversed(project.document.figures)
        if each.id != besides and not (each.still or each.locked) and is_at(project, each.id, place)
    ]
    if below in found:
        return found[(found.index(below) + 1) % len(found)]
    return found[0] if found else None


def is_at(project: Project, identity: int, place: complex) -> bool:
    """Tell whether a figure is seen at a place of the scene."""
    shown = project.puppets[identity].shown
    if shown is None or not is_visible(project.document.figure(identity), shown.frame):
        return False
    outline = shown.positions[: len(shown.mesh.domain.outline)]
    return bool(contains(outline, np.array([shown.placement.back(place)]))[0])


def rename(session: Session, identity: int, name: str) -> None:
    """Give a layer another name."""
    if session.project and name.strip():
        editing.edit(session, layer_commands.rename_figure(identity, name))


def move(session: Session, identity: int, index: int) -> None:
    """Put a layer at an index in the order from back to front."""
    editing.edit(session, layer_commands.move_figure(identity, index))


def show(session: Session, identity: int) -> None:
    """Hide a layer, or show it again."""
    if session.project:
        hidden = session.project.document.figure(identity).hidden
        editing.edit(session, layer_commands.set_hidden(identity, hidden=not hidden))


def lock(session: Session, identity: int) -> None:
    """Let clicks on the drawing pass through a layer, or stop at it again."""
    if session.project:
        locked = session.project.document.figure(identity).locked
        editing.edit(session, layer_commands.set_locked(identity, locked=not locked))


def refer(session: Session, identity: int) -> None:
    """Leave a layer out of exports, or take it in again."""
    if session.project:
        reference = session.project.document.figure(identity).reference
        editing.edit(session, layer_commands.set_reference(identity, reference=not reference))


def fade(session: Session, identity: int, opacity: float) -> None:
    """Set how opaque a layer is."""
    editing.edit(session, layer_commands.set_opacity(identity, opacity))


def switch_here(session: Session, identity: int) -> None:
    """Show or hide a layer from the present frame on: the other way than it is there."""
    project = session.project
    if project:
        frame = playback.current_frame(session, project)
        figure = project.document.figure(identity)
        visible = not is_visible(figure, frame)
        editing.edit(session, layer_commands.switch_at(identity, frame, visible=visible))


def unswitch_here(session: Session, identity: int) -> None:
    """Take back that a layer is shown or hidden from the present frame on."""
    project = session.project
    if project:
        frame = playback.current_frame(session, project)
        editing.edit(session, layer_commands.switch_at(identity, frame, visible=None))


def duplicate(session: Session, identity: int) -> None:
    """Put a copy of a layer in front of it, and choose it."""
    project = session.project
    if project is None:
        return
    free = layer_commands.free_identity(project.document)
    editing.edit(session, layer_commands.duplicate_figure(identity))
    choose(session, free)


def remove(session: Session, identity: int) -> None:
    """Delete a layer."""
    editing.edit(session, layer_commands.remove_figure(identity))


def stand_still(session: Session, identity: int) -> None:
    """Make a layer a still picture, without handles and keys."""
    if session.project:
        figure = session.project.document.figure(identity)
        editing.edit(session, layer_commands.replace_figure(identity, still_figure(figure)))


def stand_up(session: Session, identity: int) -> None:
    """Let a still picture be posed: the shape that is drawn on it, as it was drawn."""
    project = session.project
    if project is None:
        return
    figure, picture = project.document.figure(identity), project.puppets[identity].picture
    layer = Layer(
        name=figure.name,
        data=figure.picture.data,
        picture=picture,
        corner=figure.corner,
        visible=not figure.hidden,
        opacity=figure.opacity,
    )
    is_cut_out = bool((picture.rgba[..., 3] == 0).any())
    meshing = session.meshing

    def work() -> Figure:
        made, notices = layer_figure(layer, identity, meshing, is_cut_out=is_cut_out)
        if made.still:
            raise LissomError(f"there is no shape on it ({'; '.join(notices)})")
        return replace(
            made, reference=figure.reference, locked=figure.locked, switches=figure.switches
        )

    def done(made: Figure) -> None:
        if session.project is project:
            editing.edit(session, layer_commands.replace_figure(identity, made))
            choose(session, identity)

    _put(session, RISING, work, done, f"{figure.name} cannot be posed")


def add(session: Session, paths: Sequence[Path]) -> None:
    """Add pictures as layers in front of all others."""
    project = session.project
    if project is None:
        return
    meshing = session.meshing

    def work() -> list[tuple[Figure, Picture, tuple[str, ...]]]:
        made = []
        for path in paths:
            data = read_picture_file(path)
            picture = decode_picture(data, path.name)
            layer = Layer(name=path.stem, data=data, picture=picture)
            figure, notices = layer_figure(layer, 0, meshing, is_cut_out=False)
            made.append((figure, picture, picture.notices + notices))
        return made

    def done(made: list[tuple[Figure, Picture, tuple[str, ...]]]) -> None:
        if session.project is not project:
            return
        gesture = object()
        for figure, picture, notices in made:
            identity = layer_commands.free_identity(project.document)
            project.pictures[figure.picture] = picture
            command = layer_commands.add_figure(replace(figure, id=identity))
            project.history.do(command, gesture=gesture)
            editing.follow_figures(project)
            choose(session, identity)
            for notice in notices:
                session.tell(sentence(notice))

    _put(session, ADDING, work, done, "The layer cannot be added")


def ask(session: Session) -> None:
    """Ask for a picture that becomes another layer."""
    session.dialog = FileDialog(
        title="Add a picture as a layer",
        folder=session.usual_folder,
        suffixes=files.PICTURES,
        writes=False,
        chosen=lambda path: do(add, [path]),
    )


def drop(session: Session, paths: Sequence[Path]) -> None:
    """Open what was dropped on the window; ask whether pictures are to join the open scene."""
    pictures = [
        path for path in paths if path.suffix.lower() in files.PICTURES and not path.is_dir()
    ]
    if session.project is None or not pictures or len(pictures) < len(paths):
        files.open_dropped(session, paths)
        return
    what = pictures[0].name if len(pictures) == 1 else f"{len(pictures)} pictures"
    session.dialog = Question(
        title=f"Add {what} to this scene?",
        text="A new layer lies in front of the others and shares their timeline.",
        answers=(
            ("New layer" if len(pictures) == 1 else "New layers", do(add, pictures)),
            ("New scene", do(files.open_dropped, pictures)),
        ),
    )


def tint_depth(session: Session, tints: bool) -> None:  # noqa: FBT001 - of an action
    """Show what of the drawing is in front, and what behind."""
    session.tints_depth = tints


def hangs_on(project: Project, identity: int, carrier: int) -> bool:
    """Tell whether a layer is another one, or hangs on it, directly or by others."""
    return any(each.id == carrier for each in project.document.carriers(identity))


def hang(
    session: Session,
    child: int,
    parent: int,
    turns: bool = True,  # noqa: FBT001, FBT002 - of an action
    place: complex | None = None,
) -> None:
    """Hang a layer by its anchor on another one; nothing moves at the present frame.

    Parameters
    ----------
    session : Session
    child, parent : int
        Ids of layers.
    turns : bool
        Whether the child turns with the parent.
    place : complex, optional
        Of the joint, in the scene; by default the anchor's, or the middle of where they overlap.
    """
    project = session.project
    if project is None:
        return
    if hangs_on(project, parent, child):
        names = [project.document.figure(identity).name for identity in (parent, child)]
        session.tell(
            f"{names[0]} hangs on {names[1]}, so that {names[1]} cannot hang on it: that would be "
            "a circle. Detach one of the layers between first.",
            tone="error",
            topic="joint",
        )
        return
    posing.drop(session)
    document, frame = project.document, playback.current_frame(session, project)
    samplers = {figure: puppet.coarse.value.sampler for figure, puppet in project.puppets.items()}
    siblings = {figure: sampler for figure, sampler in samplers.items() if sampler is not None}

    def done(joint: tuple[complex, Attachment]) -> None:
        if session.project is project and project.document is document:
            editing.edit(session, layer_commands.attach(child, *joint))

    _put(
        session,
        HANGING,
        lambda: Joints(document, siblings).hang(child, parent, frame, place=place, turns=turns),
        done,
        "The layers cannot be joined",
    )


def let_hang(session: Session, child: int) -> None:
    """Let a layer hang on nothing any more; nothing moves at the present frame."""
    project = session.project
    shown = project.puppets[child].shown if project else None
    if project and shown is not None:
        editing.edit(session, layer_commands.detach(child, *shown.placement))


def turn_with(session: Session, child: int, turns: bool) -> None:  # noqa: FBT001 - of an action
    """Let a layer turn with the one that it hangs on, or keep its own turn; nothing moves now."""
    project = session.project
    joint = project.document.figure(child).attachment if project else None
    if joint is not None and turns != joint.turns:
        hang(session, child, joint.to, turns)


def _put(
    session: Session, kind: str, work: Callable[[], T], done: Callable[[T], None], complaint: str
) -> None:
    session.jobs.put(
        Job(
            kind=kind,
            work=work,
            done=done,
            failed=lambda error: report(session, complaint, error),
        )
    )
