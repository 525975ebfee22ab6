"""Layers that take turns, as mouths do."""

from app.document import choice_commands, layer_commands
from app.editor.actions import editing, playback
from app.editor.project import Project
from app.editor.session import Session, with_project


@with_project
def form(session: Session, project: Project, *identities: int, name: str = "choice") -> None:
    """Let layers take turns: of them exactly one is seen at a time."""
    taken = {choice.name for choice in project.document.switch_groups}
    free = layer_commands.unique_name(name, taken)
    editing.edit(session, choice_commands.create_switch_group(free, identities))


@with_project
def show_here(session: Session, project: Project, identity: int) -> None:
    """Let a layer be the one of its choice that is seen from the present frame on."""
    frame = playback.current_frame(session, project)
    editing.edit(session, choice_commands.choose_at(identity, frame))


@with_project
def decline(_: Session, project: Project, group: str) -> None:
    """Offer no more to make a choice of a group."""
    project.declined |= {group}


def join(session: Session, name: str, *identities: int) -> None:
    """Take layers into a choice."""
    editing.edit(session, choice_commands.add_to_switch_group(name, identities))


def leave(session: Session, identity: int) -> None:
    """Take a layer out of its choice."""
    editing.edit(session, choice_commands.remove_from_switch_group(identity))


def rename_choice(session: Session, name: str, new: str) -> None:
    """Give a choice another name."""
    if new.strip():
        editing.edit(session, choice_commands.rename_switch_group(name, new))


def dissolve(session: Session, name: str) -> None:
    """Let the layers of a choice take turns no more: each is seen when it was."""
    editing.edit(session, choice_commands.delete_switch_group(name))
