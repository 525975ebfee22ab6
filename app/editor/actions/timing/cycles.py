"""Stretches that repeat: made of chosen keys, ended, and made into keys."""

from collections.abc import Callable

from app.document import Command, Cycle, Document, cycle_commands
from app.editor.actions import editing, playback
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.timeline_view import frames_in, layer_of
from app.errors import LissomError


def selected_range(project: Project) -> tuple[int, int] | None:
    """Return the first and the last frame of the chosen keys, or else of all of the chosen layers'.

    None where there are fewer than two.
    """
    frames = set[int]().union(*project.selected_keys.values())
    if len(frames) < 2:
        rows = project.selected_layers if len(project.selected_layers) > 1 else [project.row]
        frames = set[int]().union(*(frames_in(project.document, row) for row in rows))
    return (min(frames), max(frames)) if len(frames) > 1 else None


def cycle_at_playhead(session: Session, project: Project, frame: int | None = None) -> Cycle | None:
    """Return what repeats at a frame, by default the present one, of the layer that is posed."""
    here = playback.current_frame(session, project) if frame is None else frame
    return project.layer.cycle_at(here)


@with_project
def create_cycle(session: Session, project: Project) -> None:
    """Let the stretch of the chosen keys repeat, in all layers that have some or are chosen."""
    stretch = selected_range(project)
    if stretch is None:
        return
    document, layers = project.document, _layers(project)
    ends = [cycle_commands.end_of_cycle(document.layer(each), *stretch) for each in layers]
    until = min((end for end in ends if end is not None), default=None)
    commands = [cycle_commands.set_cycle(each, *stretch, until) for each in layers]
    editing.edit_document(
        session, Command("Repeat stretch", lambda now: _all_of(commands, layers, now))
    )


@with_project
def end_cycle(session: Session, project: Project, frame: int | None = None) -> None:
    """Let what repeats at a frame, by default the present one, be there once."""
    _change(session, project, frame, cycle_commands.delete_cycle)


@with_project
def bake_cycle(session: Session, project: Project, frame: int | None = None) -> None:
    """Make the repeats at a frame, by default the present one, into keys of their own."""
    last = project.document.frames.last
    _change(
        session, project, frame, lambda each, first: cycle_commands.bake_cycle(each, first, last)
    )


def _change(
    session: Session,
    project: Project,
    frame: int | None,
    command: Callable[[int, int], Command],
) -> None:
    """Change what repeats at a frame, and what begins with it in other layers of chosen keys."""
    cycle = cycle_at_playhead(session, project, frame)
    if cycle is None:
        return
    layers = [
        each
        for each in {project.active, *_layers(project)}
        if any(cycle.first == other.first for other in project.document.layer(each).cycles)
    ]
    commands = [command(each, cycle.first) for each in layers]
    label = commands[0].label
    editing.edit_document(session, Command(label, lambda now: _all_of(commands, layers, now)))


def _layers(project: Project) -> list[int]:
    """Return the layers of chosen keys, with those that are chosen together, or the one posed."""
    together = project.selected_layers if len(project.selected_layers) > 1 else ()
    layers = {*together, *map(layer_of, project.selected_keys)} or {project.active}
    return sorted(each for each in layers if _may_repeat(project.document, each))


def _may_repeat(document: Document, identity: int) -> bool:
    """Tell whether a layer can have something to repeat: a still picture only beside its pose."""
    layer = document.layer(identity)
    beside = (
        *layer.attachments[1:],
        *layer.transform_keys,
        *layer.opacity_keys,
        *layer.draw_order_keys,
    )
    in_time = beside or layer.visibility_keys or document.switch_group_of(identity) is not None
    return not layer.still or bool(in_time)


def _all_of(commands: list[Command], layers: list[int], document: Document) -> Document:
    """Run a command on each of some layers; of more than one, errors name the layer."""
    for layer, command in zip(layers, commands, strict=True):
        try:
            document = command(document)
        except LissomError as error:
            if len(layers) == 1:
                raise
            raise LissomError(f"{document.layer(layer).name}: {error}") from error
    return document
