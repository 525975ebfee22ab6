"""Hanging one layer on another, and letting it go."""

from collections.abc import Callable

from app.document import Attachment, layer_commands
from app.editor import promises
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work import Kind
from app.motion import Joints, hang as joint_at_rest

HANGING = Kind("Hanging a layer", "The layers cannot be joined")


def hangs_on(project: Project, identity: int, carrier: int) -> bool:
    """Tell whether a layer is another one, or hangs on it at some time, directly or by others."""
    others = project.document.all_carriers(identity)
    return identity == carrier or any(each.id == carrier for each in others)


@with_project
def hang(
    session: Session,
    project: Project,
    child: int,
    parent: int,
    turns: bool = True,  # noqa: FBT001, FBT002 - of an action
    place: complex | None = None,
) -> None:
    """Hang a layer by its anchor on another one; nothing moves at the present frame.

    Parameters
    ----------
    child, parent : int
        Ids of layers.
    turns : bool
        Whether the child turns with the parent.
    place : complex, optional
        Of the joint, in the scene; by default the anchor's, or the middle of where they overlap.
    """
    if hangs_on(project, parent, child):
        names = [project.document.figure(identity).name for identity in (parent, child)]
        session.tell(
            f"{names[0]} hangs on {names[1]}, so that {names[1]} cannot hang on it: that would be "
            "a circle. Detach one of the layers between first.",
            tone="error",
            topic="joint",
        )
        return
    frame = playback.current_frame(session, project)

    def find(joints: Joints) -> tuple[complex, Attachment]:
        return joint_at_rest(joints, child, parent, frame, place=place, turns=turns)

    joining = do(_join, child, parent, find)
    promises.once_settled(session, joining, "Hang the layer")


@with_project
def _join(
    session: Session,
    project: Project,
    child: int,
    parent: int,
    find: Callable[[Joints], tuple[complex, Attachment]],
) -> None:
    """Hang a layer on another one by the joint that is found."""
    document = project.document
    if not {child, parent} <= project.puppets.keys():
        return
    siblings = project.samplers

    def done(joint: tuple[complex, Attachment]) -> None:
        if project.document is document:
            editing.edit(session, layer_commands.attach(child, *joint))
        else:
            session.tell("The layer was not hung: the project changed meanwhile. Try again.")

    promises.begin(
        session,
        project,
        HANGING,
        lambda: find(Joints(document, siblings)),
        done,
    )


@with_project
def let_hang(session: Session, project: Project, child: int) -> None:
    """Let a layer hang on nothing any more; nothing moves at the present frame."""
    shown = project.puppets[child].shown
    if shown is not None:
        editing.edit(session, layer_commands.detach(child, *shown.placement))


@with_project
def turn_with(session: Session, project: Project, child: int, turns: bool) -> None:  # noqa: FBT001 - of an action
    """Let a layer turn with the one that it hangs on, or keep its own turn; nothing moves now."""
    frame = playback.current_frame(session, project)
    joint = project.document.figure(child).joint_at(frame)
    if joint is not None and joint.to is not None and turns != joint.turns:
        hang(session, child, joint.to, turns)
