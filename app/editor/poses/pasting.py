"""Pasting copied poses: as they are, with sides swapped, or flipped; by names onto any layer."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from app.document import (
    Keyframe,
    clip_of,
    parse_pairs,
    pose_channel,
    scene_commands,
    track_display_frame,
)
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import editing, playback
from app.editor.actions.action_spec import ActionSpec
from app.editor.poses import pose_insertion
from app.editor.poses.paste_destinations import (
    PasteDestination,
    PasteMode,
    find_paste_destinations,
    paste_keys_disabled_reason,
    skipped_layers_reasons,
)
from app.editor.poses.pasting_keys import paste_keys, pasteable_keys
from app.editor.poses.pasting_targets import fit_copied_keys
from app.editor.poses.pasting_tracks import paste_track, pasteable_tracks
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.pose_edits import LastFlip
from app.solving import Rig, fit_shown_pose, flip_poses
from app.texts import _, ngettext

LABELS: Mapping[PasteMode, str] = {
    "swapped": _("Paste swapped"),
    "flipped": _("Paste flipped"),
}
PASTING = JobKind(_("Pasting"), _("The poses could not be pasted"), "hand")
FLIPPING = JobKind(_("Flipping"), _("The pose could not be flipped"), "hand")
NO_PLACE = _("The copied keys fit no channel here. Paste them as they are.")
# By the way of pasting: onto another layer than the active one, and onto several layers.
PASTE_TEXTS: Mapping[PasteMode, tuple[str, str]] = {
    "as it is": (_("Paste onto {layer}"), _("Paste onto {count} layers")),
    "flipped": (_("Paste flipped onto {layer}"), _("Paste flipped onto {count} layers")),
    "swapped": (_("Paste swapped onto {layer}"), _("Paste swapped onto {count} layers")),
}
NOT_PASTED = _("The pose was not pasted: a layer, its shape or its handles changed. Paste again.")


def paste_disabled_reason(session: Session, project: Project, way: PasteMode) -> str | None:
    """Return why nothing copied can be pasted, as a sentence; None if it can."""
    if pasteable_tracks(session, project, way) or pasteable_keys(session, project, way):
        return None
    reason = paste_keys_disabled_reason(session, project, way)
    return reason or (None if session.clipboard.poses else NO_PLACE)


@with_project
def paste_copied(session: Session, project: Project, way: PasteMode = "as it is") -> None:
    """Paste the copied keys at the present frame; the first key is there."""
    frame = pose_insertion.stop_and_get_frame(session, project)
    pending_changes.run_when_idle(session, do(_paste, frame, way), LABELS.get(way, _("Paste")))


def _paste_text(session: Session, project: Project, way: PasteMode) -> str:
    """Name the layers that receive the paste, unless it is only the active layer."""
    onto = [each.layer for each in find_paste_destinations(session, project, way)]
    onto_layer, onto_layers = PASTE_TEXTS[way]
    if len(onto) > 1:
        return onto_layers.format(count=len(onto))
    others = [layer for layer in onto if layer.id != project.selection.active]
    return "".join(onto_layer.format(layer=layer.name) for layer in others)


def _paste_action(way: PasteMode, label: str, keys: str, **more: Any) -> ActionSpec:
    return ActionSpec(
        do(paste_copied, way),
        label,
        keys,
        detail=partial(_paste_text, way=way),
        why_disabled=partial(paste_disabled_reason, way=way),
        **more,
    )


PASTE = _paste_action("as it is", _("Paste"), "Ctrl+V")
PASTE_FLIPPED = _paste_action(
    "flipped",
    _("Paste flipped"),
    "Ctrl+Shift+V",
    icon="PASTE",
    hint=_("Paste into a key at this frame, mirrored: left and right change places"),
)
PASTE_SWAPPED = _paste_action(
    "swapped",
    _("Paste swapped"),
    "Ctrl+Shift+X",
    icon="RIGHT_LEFT",
    hint=_(
        "Paste into a key at this frame: near and far, or left and right, change places. "
        "Nothing is mirrored."
    ),
)


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
        if any(each.layer.id != project.selection.active for each in found):
            if len(names) > 1:
                text = ngettext(
                    "Pasted onto {count} layer.", "Pasted onto {count} layers.", len(names)
                )
                text = text.format(count=len(names))
            else:
                text = _("Pasted onto {layer}.").format(layer=names[0])
            session.notices.show(text, topic="paste")

    project.selection.deselect_keys()
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
    keys = {each.layer.id: fit_copied_keys(project, each) for each in found if each.is_direct(way)}
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


def _is_as_it_was(project: Project, landing: PasteDestination) -> bool:
    """Return whether a layer still has the shape and the handles that poses were solved for."""
    was = landing.layer
    return any(
        each.id == was.id and each.domain is was.domain and each.handles == was.handles
        for each in project.document.layers
    )


def _solving(
    project: Project, landing: PasteDestination, way: PasteMode, by: int
) -> Callable[[], Sequence[Keyframe]]:
    """Return the function that solves the poses for a layer, on the worker's thread."""
    layer, runtime = landing.layer, project.runtimes.layers[landing.layer.id]
    earlier, sibling = runtime.rig, runtime.store.sampler
    if landing.is_own and way == "flipped":
        keys, pairs = fit_copied_keys(project, landing), project.document.pairs

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
    flip = LastFlip(
        layer=layer,
        keys=tuple(fit_copied_keys(project, landing)),
        frames=project.selection.keys.get(pose_channel(layer), frozenset()),
        poses=tuple(key.pose for key in flipped),
    )
    project.pose_edits.note_flip(flip)
