"""Actions on cycles: create from selected keys, end, and bake into keys."""

from collections.abc import Callable, Iterator

from app.document import (
    SWITCH,
    Command,
    Cycle,
    Document,
    cycle_commands,
    frames_in,
    pose_channel,
)
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.errors import LissomError
from app.texts import _, message_of


def selected_range(project: Project) -> tuple[int, int] | None:
    """Return the first and last frame of the selected keys, or of all keys of selected layers.

    None if there are fewer than two keys.
    """
    frames = set[int]().union(*project.selection.keys.values())
    if len(frames) < 2:
        layers = project.selected_layers
        channels = map(pose_channel, layers) if len(layers) > 1 else [project.channel]
        frames = set[int]().union(*(frames_in(project.document, each) for each in channels))
    return (min(frames), max(frames)) if len(frames) > 1 else None


def cycle_at_playhead(session: Session, project: Project, frame: int | None = None) -> Cycle | None:
    """Return the active layer's cycle at a frame, by default the present one."""
    here = playback.current_frame(session, project) if frame is None else frame
    return project.layer.cycle_at(here)


def _repeat_text(_session: Session, project: Project) -> str:
    frames = selected_range(project)
    if frames is None:
        return ""
    return _("Repeat frames {first} to {last}").format(first=frames[0], last=frames[1])


@named_action(
    _("Repeat"),
    detail=_repeat_text,
    why_disabled=unless(_repeat_text, _("Set a second key first. Keys are repeated.")),
)
@with_project
def create_cycle(session: Session, project: Project) -> None:
    """Make a cycle of the selected keys, in all layers that are selected or have such keys."""
    stretch = selected_range(project)
    if stretch is None:
        return
    document, layers = project.document, _layers(project)
    ends = [cycle_commands.end_of_cycle(document.layer(each), *stretch) for each in layers]
    until = min((end for end in ends if end is not None), default=None)
    commands = [cycle_commands.set_cycle(each, *stretch, until) for each in layers]
    editing.edit_document(session, Command(_("Repeat"), lambda now: _all_of(commands, layers, now)))


UNLESS_CYCLE = unless(cycle_at_playhead, _("Move the playhead to frames that repeat first."))


@named_action(_("Stop repeating"), why_disabled=UNLESS_CYCLE)
@with_project
def end_cycle(session: Session, project: Project, frame: int | None = None) -> None:
    """Remove the repeats of the cycle at a frame, by default the present one."""
    _change(session, project, frame, cycle_commands.delete_cycle)


@named_action(_("Bake repeats"), why_disabled=UNLESS_CYCLE)
@with_project
def bake_cycle(session: Session, project: Project, frame: int | None = None) -> None:
    """Bake the repeats at a frame into keys; by default the present frame."""
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
    """Change the cycle at a frame, and cycles of other selected layers that begin with it."""
    cycle = cycle_at_playhead(session, project, frame)
    if cycle is None:
        return
    layers = [
        each
        for each in {project.selection.active, *_layers(project)}
        if any(cycle.first == other.first for other in project.document.layer(each).cycles)
    ]
    commands = [command(each, cycle.first) for each in layers]
    label = commands[0].label
    editing.edit_document(session, Command(label, lambda now: _all_of(commands, layers, now)))


def _layers(project: Project) -> list[int]:
    """Return the layers of selected keys and the selected layers, or the active layer."""
    together = project.selected_layers if len(project.selected_layers) > 1 else ()
    layers = {*together, *_layers_of_keys(project)} or {project.selection.active}
    return sorted(each for each in layers if _may_repeat(project.document, each))


def _layers_of_keys(project: Project) -> Iterator[int]:
    """Yield the layers of the selected keys; a switch stands for its layers."""
    for channel in project.selection.keys:
        if channel.layer is not None:
            yield channel.layer
        elif channel.kind is SWITCH:
            switch = project.document.switch_group(str(channel.part))
            yield from (layer.id for layer in project.document.moving_layers(switch))


def _may_repeat(document: Document, identity: int) -> bool:
    """Return whether a layer can have a cycle; a still picture only without its pose channel."""
    layer = document.layer(identity)
    in_time = layer.attachments[1:] or layer.channels
    return not layer.still or bool(in_time) or bool(document.switches_around(layer))


def _all_of(commands: list[Command], layers: list[int], document: Document) -> Document:
    """Run a command on each layer; for several layers, errors name the layer."""
    for layer, command in zip(layers, commands, strict=True):
        try:
            document = command(document)
        except LissomError as error:
            if len(layers) == 1:
                raise
            raise LissomError(f"{document.layer(layer).name}: {message_of(error)}") from error
    return document
