"""Parenting: attaching layers to a parent, and detaching them."""

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

from app.document import (
    PARENT,
    TRANSFORM,
    Attachment,
    Channel,
    Command,
    Document,
    channel_commands,
    combine_commands,
    layer_commands,
    transform_at,
)
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.layering.deform_groups import moving_layers
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.motion import (
    ParentTransforms,
    anchor_or_default,
    attach_as_drawn,
    attach_in_place as joint_at_rest,
    reparent_in_place as joint_that_keeps,
)
from app.texts import N_, _, ngettext
from engine.geometry import Similarity

SAME_SCALE = 1e-9
ATTACHING = JobKind(_("Attaching a layer"), _("The layer cannot be attached"))
PARENT_IS_DESCENDANT = N_(
    "{parent} cannot be attached to {name}, because {name} is attached to {parent}. Detach "
    "{name} first."
)


def is_same_or_descendant(project: Project, identity: int, ancestor: int) -> bool:
    """Return whether a layer is another layer, or its descendant at any time."""
    others = project.document.all_ancestors(identity)
    return identity == ancestor or any(each.id == ancestor for each in others)


@with_project
def attach_layer(
    session: Session,
    project: Project,
    child: int,
    parent: int,
    turns: bool = True,  # noqa: FBT001, FBT002 - of an action
    place: complex | None = None,
) -> None:
    """Attach a layer by its anchor to a parent.

    A layer without a pose of its own is joined as it is drawn, if the drawings overlap. Others do
    not move at the present frame.

    Parameters
    ----------
    turns : bool
        Whether the child turns with the parent.
    place : complex, optional
        The joint, in the scene. The default is the anchor, or the middle of the overlap.
    """
    child, parent = (moving_layers(project.document, [each])[0] for each in (child, parent))
    if is_same_or_descendant(project, parent, child):
        names = [project.document.layer(identity).name for identity in (parent, child)]
        session.notices.show(
            _(PARENT_IS_DESCENDANT).format(name=names[0], parent=names[1]),
            tone="error",
            topic="joint",
        )
        return
    frame = playback.current_frame(session, project)

    def find(joints: ParentTransforms) -> Command:
        if place is None:
            return _attach_command(joints, child, parent, frame, turns=turns)
        held = joint_at_rest(joints, child, parent, frame, place=place, turns=turns)
        return layer_commands.attach_layer(child, *held)

    joining = do(_attach, (child, parent), find)
    pending_changes.run_when_idle(session, joining, _("Attach layer"))


@with_project
def attach_layers(session: Session, project: Project, parent: int, *children: int) -> None:
    """Attach layers to a parent; descendants of these layers move with them."""
    frame = playback.current_frame(session, project)
    (parent,) = moving_layers(project.document, [parent])
    whole = [child for child in moving_layers(project.document, children) if child != parent]
    carried = {
        child
        for child in whole
        if any(other != child and is_same_or_descendant(project, child, other) for other in whole)
    }
    free = [child for child in whole if child not in carried]
    if not free:
        return
    circles = [child for child in free if is_same_or_descendant(project, parent, child)]
    if circles or len(free) == 1:
        attach_layer(session, (circles or free)[0], parent)
        return

    def find(joints: ParentTransforms) -> Command:
        attached = [_attach_command(joints, child, parent, frame, turns=True) for child in free]
        label = ngettext("Attach {count} layer", "Attach {count} layers", len(free))
        return combine_commands(label.format(count=len(free)), attached)

    joining = do(_attach, (*free, parent), find)
    pending_changes.run_when_idle(session, joining, _("Attach layers"))


def _attach_command(
    joints: ParentTransforms, child: int, parent: int, frame: int, *, turns: bool
) -> Command:
    """Return the command that joins layers as they are drawn, or else as they are at a frame."""
    held = attach_as_drawn(joints, child, parent, turns=turns)
    held = held or joint_at_rest(joints, child, parent, frame, turns=turns)
    return layer_commands.attach_layer(child, *held)


@with_project
def _attach(
    session: Session,
    project: Project,
    joined: Sequence[int],
    find: Callable[[ParentTransforms], Command],
) -> None:
    """Attach layers to a parent by the joints that `find` computes."""
    document = project.document
    if not set(joined) <= project.runtimes.layers.keys():
        return
    siblings = project.samplers

    def done(command: Command) -> None:
        if project.document is document:
            editing.edit_document(session, command)
        else:
            session.notices.show(
                _("The layer was not attached: the project changed meanwhile. Try again.")
            )

    pending_changes.begin_pending_change(
        session,
        project,
        ATTACHING,
        lambda: find(ParentTransforms(document, siblings)),
        done,
    )


@with_project
def detach_layer(session: Session, project: Project, child: int) -> None:
    """Detach a layer; nothing moves at the present frame.

    If the layer has other parents at other times, only the present attachment ends.
    """
    shown, layer = project.runtimes.layers[child].shown, project.document.layer(child)
    frame = playback.current_frame(session, project)
    joint = layer.attachment_key_at(frame)
    if joint is not None and len(layer.attachments) > 1:
        free = Attachment(parent=None, frame=joint.frame, keep_world_transform=True)
        editing.edit_document(
            session, layer_commands.attach_layer(child, anchor_or_default(layer), free)
        )
    elif shown is not None:
        editing.edit_document(
            session, _detach_command(project.document, child, frame, shown.placement)
        )


@with_project
def set_inherits_rotation(session: Session, project: Project, child: int, turns: bool) -> None:  # noqa: FBT001 - of an action
    """Set whether a layer turns with its parent; nothing moves at the present frame."""
    frame = playback.current_frame(session, project)
    joint = project.document.layer(child).attachment_key_at(frame)
    if joint is not None and joint.parent is not None and turns != joint.inherits_rotation:
        attach_layer(session, child, joint.parent, turns)


@with_project
def reparent_layer(session: Session, project: Project, child: int, parent: int | None) -> None:
    """Attach a layer to another parent, or to none, from the present frame on; nothing jumps."""
    layer = project.document.layer(child)
    frame = layer.joint_frame(playback.current_frame(session, project))
    if parent is None:
        anchor, joint = (
            anchor_or_default(layer),
            Attachment(parent=None, frame=frame, keep_world_transform=True),
        )
        editing.edit_document(session, layer_commands.attach_layer(child, anchor, joint))
        return

    def find(joints: ParentTransforms) -> Command:
        held = layer.attachment_key_at(frame)
        turns = held is None or held.inherits_rotation
        joint = joint_that_keeps(joints, child, parent, frame, turns=turns)
        return layer_commands.attach_layer(child, anchor_or_default(layer), joint)

    joining = do(_attach, (child, parent), find)
    pending_changes.run_when_idle(session, joining, _("Reparent layer"))


@with_project
def delete_parent_key(session: Session, _: Project, child: int, frame: int) -> None:
    """Delete a parent key; the previous parent holds on."""
    keys = {Channel(PARENT, child): frozenset({frame})}
    editing.edit_document(session, channel_commands.delete_keys(keys))


def reparent_child_command(
    joints: ParentTransforms, child: int, gone: Collection[int], frame: int
) -> Command:
    """Return the command that replaces a child's deleted parents by remaining ancestors.

    Nothing moves at `frame`, and nothing jumps at the child's parent keys.
    """
    document = joints.document
    layer, here = document.layer(child), document.layer(child).attachment_key_at(frame)
    lost = [joint for joint in layer.attachments if joint.parent in gone]
    found: list[Command] = []
    has_parent = len(lost) < len(layer.attachments)
    for joint in lost:
        at = frame if joint is here else joint.frame
        parents = document.parent_chain(child, at)[1:]
        heir = next((each.id for each in parents if each.id not in gone), None)
        has_parent |= heir is not None
        held = (
            anchor_or_default(layer),
            Attachment(parent=None, frame=joint.frame, keep_world_transform=True),
        )
        if heir is not None and joint.keep_world_transform and joint is not here:
            held = held[0], joint_that_keeps(joints, child, heir, at, turns=joint.inherits_rotation)
        elif heir is not None:
            held = joint_at_rest(joints, child, heir, at, turns=joint.inherits_rotation)
        found.append(layer_commands.attach_layer(child, *held))
    if lost and not has_parent:
        return _detach_command(document, child, frame, joints.placement(child, frame))
    return combine_commands(_("Attach"), found)


def _detach_command(document: Document, child: int, frame: int, placement: Similarity) -> Command:
    """Return the command that detaches a layer; it keeps its placement at a frame.

    From then on its own transform moves it, which takes the scale of the parents.
    """
    layer, channel = document.layer(child), Channel(TRANSFORM, child)
    scale = abs(transform_at(document, layer, frame).inverse.compose(placement).factor)
    commands: list[Command] = []
    if abs(scale - 1) > SAME_SCALE:
        start = TRANSFORM.key(document.frames.first, TRANSFORM.default)
        for key in layer.keys_of(TRANSFORM) or (start,):
            value = replace(key.value, scale=key.value.scale * scale)
            commands.append(channel_commands.set_key(channel, key.frame, value))
            document = commands[-1](document)
    own = transform_at(document, document.layer(child), frame)
    commands.append(layer_commands.detach_layer(child, *own.inverse.compose(placement)))
    return combine_commands(_("Detach"), commands)
