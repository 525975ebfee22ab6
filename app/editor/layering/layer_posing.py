"""Moving, turning and scaling layers at their joints, by keys of their transforms."""

from collections.abc import Mapping
from dataclasses import replace

from app.document import (
    HOLD,
    IK_TARGET,
    TRANSFORM,
    Channel,
    Command,
    IkTarget,
    Transform,
    channel_commands,
    combine_commands,
    frames_in,
    joint_commands,
)
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import named_action, unless
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.motion import LayerPull
from app.texts import _


def find_pull(session: Session, project: Project, layer: int) -> LayerPull | None:
    """Return the pull of a layer at the present frame; None until all layers are shown."""
    frame = playback.current_frame(session, project)
    return project.evaluator.pull(project.document, layer, frame)


def tell_if_planted(session: Session, pull: LayerPull) -> bool:
    """Show a notice if an IK target bends the layer, so that it cannot turn by itself."""
    end = pull.planted_end
    if end is not None:
        text = _("{layer} bends to the IK target of {end}. Drag {end}, or release it first.")
        name = pull.document.layer(pull.layer).name
        session.notices.show(text.format(layer=name, end=end.name), topic="planted")
    return end is not None


@with_project
def set_transforms(
    session: Session,
    project: Project,
    transforms: Mapping[int, Transform],
    *,
    label: str,
    gesture: object = None,
) -> None:
    """Key the transforms of layers at the present frame.

    A layer without such keys also gets one at the first frame, where it stays as it was.
    """
    frame = playback.current_frame(session, project)
    commands = _set_transforms(project, frame, transforms)
    if commands:
        command = combine_commands(label, commands)
        editing.edit_document(session, command, gesture=gesture)


def _set_transforms(
    project: Project, frame: int, transforms: Mapping[int, Transform]
) -> list[Command]:
    commands, start = [], project.document.frames.first
    for layer, transform in transforms.items():
        channel = Channel(TRANSFORM, layer)
        if frame > start and not frames_in(project.document, channel):
            commands.append(channel_commands.set_key(channel, start, TRANSFORM.default))
        commands.append(channel_commands.set_key(channel, frame, transform))
    return commands


@with_project
def set_ik_target(
    session: Session,
    project: Project,
    layer: int,
    target: IkTarget,
    *,
    gesture: object = None,
) -> None:
    """Key the IK target of a layer at the present frame."""
    frame = playback.current_frame(session, project)
    command = channel_commands.set_key(Channel(IK_TARGET, layer), frame, target)
    editing.edit_document(session, command, gesture=gesture)


@with_project
def set_ik_parents(session: Session, _: Project, layer: int, count: int) -> None:
    """Set how many parents bend with a layer."""
    editing.edit_document(session, joint_commands.set_ik_parents(layer, count))


@with_project
def apply_own_transform(session: Session, _: Project, layer: int) -> None:
    """Let a layer's own transform act at its joints, as in new projects."""
    editing.edit_document(session, joint_commands.apply_transform(layer))


def _limb_end(session: Session, project: Project) -> LayerPull | None:
    """Return the pull of the limb's end that the active layer is, or of the end below it."""
    own = project.selection.active
    for layer in (own, *(each.id for each in project.document.layers if each.id != own)):
        pull = find_pull(session, project, layer)
        if pull is None or len(pull.bones) < 2:
            continue
        if own in {layer, *(each.id for each in pull.bones)}:
            return pull
    return None


def _has_limb(session: Session, project: Project) -> bool:
    return _limb_end(session, project) is not None


NO_LIMB = _(
    "Select a layer with two parents first, such as a foot that is attached to a shin, which is "
    "attached to a thigh."
)


@named_action(
    _("Bend layers other way"),
    icon="LEFT_RIGHT",
    hint=_("Bend the knee or elbow between the layer's parents to the other side"),
    why_disabled=unless(_has_limb, NO_LIMB),
)
@with_project
def flip_layer_limb(session: Session, project: Project) -> None:
    """Bend the bones of the active layer's limb to their other side; the end stays."""
    pull = _limb_end(session, project)
    if pull is None:
        return
    own = project.document.layer(pull.layer)
    commands: list[Command] = []
    if pull.target is not None or own.pole_side:
        commands.append(joint_commands.set_pole_side(pull.layer, side=-pull.side))
    frame = playback.current_frame(session, project)
    if pull.target is None or pull.target.mix < 1:
        commands += _set_transforms(project, frame, pull.flipped())
    editing.edit_document(session, combine_commands(_("Bend layers other way"), commands))


@named_action(
    _("Plant layer"),
    icon="ANCHOR",
    hint=_("Keep the layer where it is from this frame on, by its IK target; its parents bend"),
    why_disabled=unless(_has_limb, NO_LIMB),
)
@with_project
def plant_layer(session: Session, project: Project) -> None:
    """Key the IK target of the active layer's limb where the end is now; nothing jumps."""
    pull = _limb_end(session, project)
    if pull is not None:
        _key_target(session, project, pull, 1.0, _("Plant layer"))


@named_action(
    _("Release layer"),
    icon="LOCK_OPEN",
    hint=_("From this frame on, the layer follows its parents and not its IK target"),
    why_disabled=unless(
        lambda session, project: _is_planted(session, project),  # noqa: PLW0108 - defined below
        _("The selected layer has no IK target at this frame. Plant it first."),
    ),
)
@with_project
def release_layer(session: Session, project: Project) -> None:
    """Key the IK target of the active layer's limb without an effect; nothing jumps."""
    pull = _limb_end(session, project)
    if pull is not None:
        _key_target(session, project, pull, 0.0, _("Release layer"))


def _is_planted(session: Session, project: Project) -> bool:
    pull = _limb_end(session, project)
    return pull is not None and pull.target is not None and pull.target.mix > 0


def _key_target(
    session: Session, project: Project, pull: LayerPull, mix: float, label: str
) -> None:
    """Key the IK target where the limb's end is now; a key before it with another mix holds.

    The end of a planted time keeps the present rotations as transforms.
    """
    frame, channel = playback.current_frame(session, project), Channel(IK_TARGET, pull.layer)
    keys = project.document.layer(pull.layer).keys_of(IK_TARGET)
    before = [key for key in keys if key.frame < frame][-1:]
    commands = [
        channel_commands.set_easing({channel: frozenset({key.frame})}, HOLD)
        for key in before
        if key.value.mix != mix
    ]
    if not mix:
        commands += _set_transforms(project, frame, pull.transforms())
    target = replace(pull.present_target(), mix=mix)
    commands.append(channel_commands.set_key(channel, frame, target))
    editing.edit_document(session, combine_commands(label, commands))
