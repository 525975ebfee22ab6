"""Pasting what was copied flipped, and again where the axis has been moved."""

from collections.abc import Sequence
from dataclasses import replace

from app.document import Figure, Keyframe, Pose, pairs_by_name, pose_commands
from app.editor import promises
from app.editor.action import do
from app.editor.actions import playback
from app.editor.poses import copying, putting
from app.editor.project import Flip, Project
from app.editor.session import Session, with_project
from app.editor.work import Kind
from app.solving import Rig, flip_poses, flipped_targets

FLIPPING = Kind("Flipping", "The pose could not be flipped", "hand")


@with_project
def paste(session: Session, project: Project) -> None:
    """Put what was copied into keys, mirrored at the figure's axis."""
    frame = putting.stand_at_frame(session, project)
    promises.once_settled(session, do(_paste, frame), "Paste flipped")


@with_project
def _paste(session: Session, project: Project, frame: int) -> None:
    copied = copying.copied_here(session, project)
    if copied is None:
        return
    keys = putting.fitted(project, project.active, copied.keys, copied.figure.bounds)
    _flip(session, project, frame, keys, gesture=object())


@with_project
def paste_on_selected(session: Session, project: Project) -> None:
    """Let the selected handles go where their partners were, and the shape follow."""
    copied = copying.copied_for_selected(session, project)
    if copied is None:
        return
    (key, *_) = putting.fitted(project, project.active, copied.keys, copied.figure.bounds)
    figure = project.figure
    copying.pull_selected(session, project, flipped_targets(figure, key.pose, figure.axis))


def is_fresh(project: Project) -> bool:
    """Tell whether what was flipped last is still what the chosen keys hold."""
    flip = project.flip
    if flip is None or project.chosen != flip.frames or project.active != flip.figure:
        return False
    return all(
        project.figure.key(frame).pose is pose
        for frame, pose in zip(sorted(flip.frames), flip.poses, strict=True)
    )


def shows_axis(session: Session, project: Project) -> bool:
    """Tell whether the axis is shown: after a flip, and as long as the person wants to see it."""
    return project.playhead.since is None and (session.overlays.mirror or is_fresh(project))


@with_project
def move_axis(_: Session, project: Project, x: float | None, gesture: object) -> None:
    """Put the axis elsewhere, or in the middle."""
    project.history.do(pose_commands.set_mirror(project.active, x), gesture=gesture)


@with_project
def flip_again(session: Session, project: Project, gesture: object) -> None:
    """Flip once more what was flipped last, at the axis of now."""
    flip = project.flip
    if flip is not None and is_fresh(project):
        _flip(session, project, min(flip.frames), flip.keys, gesture=gesture)


def place_axis(session: Session, x: float | None) -> None:
    """Put the axis elsewhere, or in the middle, and flip again what was flipped last."""
    gesture = object()
    move_axis(session, x, gesture)
    flip_again(session, gesture)


def _with_pose(figure: Figure, key: Keyframe, pose: Pose) -> Keyframe:
    """Return a key as its mirror image: it turns the other way, and partners exchange depths."""
    pairs = pairs_by_name(figure.handles)
    fronts = {pairs.get(identity, identity): front for identity, front in key.fronts.items()}
    return replace(key, pose=pose, turns=-key.turns, fronts=fronts)


def _flip(
    session: Session, project: Project, frame: int, keys: Sequence[Keyframe], gesture: object
) -> None:
    figure = project.figure
    rig, axis = Rig.of(figure, project.puppet.rig), figure.axis

    def done(poses: list[Pose]) -> None:
        now = project.figure
        if now.id != figure.id:
            session.tell("The pose was not flipped: another layer was chosen. Paste again.")
            return
        if now.domain is not figure.domain or now.handles != figure.handles:
            session.tell("The pose was not flipped: the shape or its handles changed. Paste again.")
            return
        flipped = [_with_pose(figure, key, pose) for key, pose in zip(keys, poses, strict=True)]
        keys_of = {project.active: flipped}
        putting.put(session, project, frame, keys_of, label="Paste flipped", gesture=gesture)
        project.flip = Flip(
            figure=figure.id, keys=tuple(keys), frames=project.chosen, poses=tuple(poses)
        )
        if playback.current_frame(session, project) != frame:
            playback.seek(session, frame)

    promises.begin(
        session,
        project,
        FLIPPING,
        lambda: flip_poses(rig, [key.pose for key in keys], axis),
        done,
    )
