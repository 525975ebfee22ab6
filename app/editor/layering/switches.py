"""Switches: layers and groups of which exactly one is visible, such as mouths."""

from app.document import SwitchMember, layer_commands, switch_group_commands
from app.editor.actions import editing, playback
from app.editor.project import Project
from app.editor.session import Session, with_project


@with_project
def create_switch(
    session: Session, project: Project, *members: SwitchMember, name: str = "choice"
) -> None:
    taken = {choice.name for choice in project.document.switch_groups}
    free = layer_commands.unique_name(name, taken)
    editing.edit_document(session, switch_group_commands.create_switch_group(free, members))


@with_project
def key_switch(session: Session, project: Project, member: SwitchMember) -> None:
    """Key a switch to a layer or group at the present frame."""
    frame = playback.current_frame(session, project)
    editing.edit_document(session, switch_group_commands.choose_at(member, frame))


@with_project
def dismiss_switch_suggestion(_: Session, project: Project, group: str) -> None:
    """Stop suggesting a switch for a group."""
    project.layer_list.dismiss_suggestion(group)


def add_to_switch(session: Session, name: str, *identities: int) -> None:
    editing.edit_document(session, switch_group_commands.add_to_switch_group(name, identities))


def rename_switch(session: Session, name: str, new: str) -> None:
    if new.strip():
        editing.edit_document(session, switch_group_commands.rename_switch_group(name, new))
