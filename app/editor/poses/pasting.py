"""Pasting copied poses: as they are, with sides swapped, or flipped; by names onto any layer."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

from app.document import (
    Keyframe,
    Target,
    clip_of,
    parse_pairs,
    pose_channel,
    scene_commands,
    track_display_frame,
)
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.poses import pose_insertion
from app.editor.poses.paste_destinations import (
    PasteDestination,
    PasteMode,
    find_active_paste_destination,
    find_paste_destinations,
    paste_keys_disabled_reason,
    skipped_layers_reasons,
)
from app.editor.poses.pasting_keys import paste_keys, pasteable_keys
from app.editor.poses.pasting_tracks import paste_track, pasteable_tracks
from app.editor.project import LastFlip, Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.solving import Rig, fit_shown_pose, flip_poses, flip_targets
from app.texts import _, ngettext

LABELS: Mapping[PasteMode, str] = {
    "swapped": _("Paste swapped"),
    "flipped": _("Paste flipped"),
}
PASTING = JobKind(_("Pasting"), _("The poses could not be pasted"), "hand")
FLIPPING = JobKind(_("Flipping"), _("The pose could not be flipped"), "hand")
NO_PLACE = _("The copied keys fit no channel here. Paste them as they are.")
NOT_PASTED = _("The pose was not pasted: a layer, its shape or its handles changed. Paste again.")


def paste_disabled_reason(session: Session, project: Project, way: PasteMode) -> str:
    """Return why nothing copied can be pasted, as a sentence; empty if it can."""
    if pasteable_tracks(session, project, way) or pasteable_keys(session, project, way):
        return ""
    reason = paste_keys_disabled_reason(session, project, way)
    return reason or ("" if session.clipboard.poses else NO_PLACE)


def paste_on_selected_disabled_reason(session: Session, project: Project, way: PasteMode) -> str:
    """Return why nothing can be pasted on the selected handles; empty if it can."""
    landing = find_active_paste_destination(session, project, way)
    if landing is None:
        return paste_keys_disabled_reason(session, project, way) or _(
            "Select a copied layer first."
        )
    if not project.selected_handles:
        return _("Select the handles to paste on first.")
    return landing.disabled_reason


@with_project
def paste_copied(session: Session, project: Project, way: PasteMode = "as it is") -> None:
    """Paste the copied keys at the present frame; the first key is there."""
    frame = pose_insertion.stop_and_get_frame(session, project)
    pending_changes.run_when_idle(session, do(_paste, frame, way), LABELS.get(way, _("Paste")))


@with_project
def _paste(session: Session, project: Project, frame: int, way: PasteMode) -> None:
    if paste_disabled_reason(session, project, way):
        return
    tracks, others = (
        pasteable_tracks(session, project, way),
        pasteable_keys(session, project, way),
    )
    found = [each for each in find_paste_destinations(session, project, way) if each.copied.keys]
    starts = [key.frame for each in found for key in each.copied.keys]
    starts += [
        track_display_frame(project.document, each.track, key.frame)
        for each in tracks.values()
        for key in each.keys
    ]
    starts += [key.frame for keys in others.values() for key in keys]
    by, gesture = frame - min(starts), object()
    reasons = skipped_layers_reasons(session, project, way)

    def then() -> None:
        for row, each in tracks.items():
            paste_track(session, project, row, each, by, gesture)
        paste_keys(session, project, others, by, gesture)
        for reason in reasons:
            session.notices.show(reason)
        names = [each.layer.name for each in found]
        if any(each.layer.id != project.active for each in found):
            if len(names) > 1:
                text = ngettext(
                    "Pasted onto {count} layer.", "Pasted onto {count} layers.", len(names)
                )
                text = text.format(count=len(names))
            else:
                text = _("Pasted onto {layer}.").format(layer=names[0])
            session.notices.show(text, topic="paste")

    project.selected_keys = {}
    if found:
        paste_poses(session, project, found, way, by, gesture=gesture, then=then)
    else:
        then()


def paste_poses(
    session: Session,
    project: Project,
    found: Sequence[PasteDestination],
    way: PasteMode,
    by: int,
    *,
    label: str | None = None,
    gesture: object | None = None,
    then: Callable[[], None] = lambda: None,
) -> None:
    """Paste keys onto their layers, `by` frames later than they were copied.

    The worker solves the poses that come from other layers. All pastes are one undo step.

    Parameters
    ----------
    label : str, optional
        The undo label; by default it is a paste.
    gesture : object, optional
        Edits of one gesture are one undo step.
    then : callable, optional
        Runs after the keys are inserted.
    """
    gesture, label = gesture or object(), label or LABELS.get(way)
    keys = {each.layer.id: _fitted(project, each) for each in found if each.is_direct(way)}
    works = {
        each.layer.id: _solving(project, each, way, by)
        for each in found
        if each.layer.id not in keys
    }
    frame = min(key.frame for each in found for key in each.copied.keys) + by

    def put(solved: Mapping[int, Sequence[Keyframe]]) -> None:
        everything = {each.layer.id: {**keys, **solved}[each.layer.id] for each in found}
        poses = {each.layer.id for each in found if each.copied.is_pose}
        pose_insertion.insert_poses(
            session, project, frame, everything, poses=poses, label=label, gesture=gesture
        )
        if way == "flipped" and len(found) == 1 and found[0].is_own:
            _note_flip(project, found[0], everything[found[0].layer.id])
        then()

    def done(solved: Mapping[int, Sequence[Keyframe]]) -> None:
        if not all(_is_as_it_was(project, each) for each in found):
            session.notices.show(NOT_PASTED)
            return
        put(solved)
        if playback.current_frame(session, project) != frame:
            playback.seek(session, frame)

    if works:
        kind = FLIPPING if way == "flipped" else PASTING
        pending_changes.begin_pending_change(
            session, project, kind, lambda: {i: work() for i, work in works.items()}, done
        )
    else:
        put({})


def set_mirror_names(session: Session, text: str) -> None:
    """Set the words or whole names that mark the two sides of layers and handles."""
    editing.edit_document(session, scene_commands.set_mirror_names(parse_pairs(text)))


@with_project
def paste_on_selected(session: Session, project: Project, way: PasteMode = "as it is") -> None:
    """Move the selected handles to the copied places of themselves or of their partners."""
    if not paste_on_selected_disabled_reason(session, project, way):
        landing = find_active_paste_destination(session, project, way)
        if landing is not None:
            targets = pasted_targets(project, landing, way)
            set_targets(session, {i: targets[i] for i in project.selected_handles if i in targets})


def pasted_targets(
    project: Project, landing: PasteDestination, way: PasteMode
) -> Mapping[int, Target]:
    """Return the targets of a layer's handles from the first copied key, by id."""
    if landing.is_own:
        pose, layer = _fitted(project, landing)[0].pose, landing.layer
        if way == "flipped":
            return flip_targets(layer, pose, layer.axis, project.document.pairs)
        if landing.is_direct(way):
            return pose.targets
    return landing.pose_transfer(way).transfer_targets(landing.layer, landing.copied.keys[0].pose)


def _is_as_it_was(project: Project, landing: PasteDestination) -> bool:
    """Return whether a layer still has the shape and the handles that poses were solved for."""
    was = landing.layer
    return any(
        each.id == was.id and each.domain is was.domain and each.handles == was.handles
        for each in project.document.layers
    )


def _fitted(project: Project, landing: PasteDestination) -> list[Keyframe]:
    copied = landing.copied
    return pose_insertion.fit_keys_to_layer(
        project, landing.layer.id, copied.keys, copied.layer.bounds
    )


def _solving(
    project: Project, landing: PasteDestination, way: PasteMode, by: int
) -> Callable[[], Sequence[Keyframe]]:
    """Return the function that solves the poses for a layer, on the worker's thread."""
    layer, runtime = landing.layer, project.layer_runtimes[landing.layer.id]
    earlier, sibling = runtime.rig, runtime.store.sampler
    if landing.is_own and way == "flipped":
        keys, pairs = _fitted(project, landing), project.document.pairs

        def flip() -> Sequence[Keyframe]:
            rig = Rig.of(layer, earlier)
            poses = flip_poses(rig, [key.pose for key in keys], layer.axis, pairs)
            return [
                replace(key, pose=pose, revolutions=-key.revolutions)
                for key, pose in zip(keys, poses, strict=True)
            ]

        return flip
    carriage, clip = landing.pose_transfer(way), clip_of(project.document, layer.id)
    turns = -1 if carriage.similarity.mirrors else 1

    def carry() -> Sequence[Keyframe]:
        rig = Rig.of(layer, earlier)
        is_whole = {handle.id for handle in rig.handles} <= landing.pairs.keys()
        solved = []
        for key in landing.copied.keys:
            present = None if is_whole else fit_shown_pose(rig, clip, key.frame + by, sibling)
            pose = carriage.transfer_pose(rig, key.pose, present)
            solved.append(replace(key, pose=pose, revolutions=turns * key.revolutions))
        return solved

    return carry


def _note_flip(project: Project, landing: PasteDestination, flipped: Sequence[Keyframe]) -> None:
    """Note a flip, so that moving the mirror axis flips the same poses again."""
    layer = landing.layer.id
    project.last_flip = LastFlip(
        layer=layer,
        keys=tuple(_fitted(project, landing)),
        frames=project.selected_keys.get(pose_channel(layer), frozenset()),
        poses=tuple(key.pose for key in flipped),
    )
