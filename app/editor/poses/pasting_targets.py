"""Pasting the targets of a copied pose on selected handles."""

from collections.abc import Collection, Mapping
from dataclasses import replace
from functools import partial

from app.document import Chain, Keyframe, Layer, Target, find_chains
from app.editor.action import do
from app.editor.actions.action_spec import ActionSpec, named_action
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.poses import pose_insertion
from app.editor.poses.paste_destinations import (
    PasteDestination,
    PasteMode,
    find_active_paste_destination,
    paste_keys_disabled_reason,
)
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.solving import flip_targets
from app.texts import _


def paste_on_selected_disabled_reason(
    session: Session, project: Project, way: PasteMode
) -> str | None:
    """Return why nothing can be pasted on the selected handles; None if it can."""
    landing = find_active_paste_destination(session, project, way)
    if landing is None:
        return paste_keys_disabled_reason(session, project, way) or _(
            "Select a copied layer first."
        )
    if not project.selection.handles:
        return _("Select the handles to paste on first.")
    return landing.disabled_reason


@named_action(
    _("Paste on selected handles"),
    "Ctrl+Alt+V",
    why_disabled=partial(paste_on_selected_disabled_reason, way="as it is"),
)
@with_project
def paste_on_selected(session: Session, project: Project, way: PasteMode = "as it is") -> None:
    """Move the selected handles to the copied places of themselves or of their partners."""
    if not paste_on_selected_disabled_reason(session, project, way):
        landing = find_active_paste_destination(session, project, way)
        if landing is not None:
            targets = pasted_targets(project, landing, way)
            set_targets(session, {i: targets[i] for i in project.selection.handles if i in targets})


FLIP_ON_SELECTED = ActionSpec(
    do(paste_on_selected, "flipped"),
    _("Paste flipped on selected"),
    "Ctrl+Alt+Shift+V",
    why_disabled=partial(paste_on_selected_disabled_reason, way="flipped"),
)


def selected_limb(layer: Layer, selected: Collection[int]) -> tuple[Chain, ...]:
    """Return the chain of the selected handle, and the chains that start along or beyond it.

    A handle at which several chains start stands for all of them.
    """
    chains, found = find_chains(layer.bones), list[Chain]()
    inside = [each for each in chains if set(each.handles[1:]) & set(selected)]
    found += inside or [each for each in chains if each.root in selected]
    for each in found:
        found += [other for other in chains if other.root == each.end and other not in found]
    return tuple(found)


def paste_on_limb_disabled_reason(session: Session, project: Project, way: PasteMode) -> str | None:
    """Return why nothing can be pasted on the selected limb; None if it can."""
    reason = paste_on_selected_disabled_reason(session, project, way)
    if reason is None and not selected_limb(project.layer, project.selection.handles):
        return _("Select a handle of a limb with bones first, such as a hand or a foot.")
    return reason


@with_project
def paste_on_limb(session: Session, project: Project, way: PasteMode) -> None:
    """Pose the limb of the selected handle as in the copied pose, from its present root on."""
    landing = find_active_paste_destination(session, project, way)
    shown = project.layer_runtime.shown
    if paste_on_limb_disabled_reason(session, project, way) or landing is None or shown is None:
        return
    targets = pasted_targets(project, landing, way)
    places = dict(
        zip(
            (handle.id for handle in shown.clip.layer.handles),
            shown.handle_positions.tolist(),
            strict=True,
        )
    )
    chains = selected_limb(project.layer, project.selection.handles)
    wanted: dict[int, Target] = {}
    root = chains[0].root
    away = places[root] - targets[root].position if root in targets else 0j
    for chain in chains:
        for identity in chain.handles[1:]:
            if identity in targets:
                target = targets[identity]
                wanted[identity] = replace(target, position=target.position + away)
    set_targets(session, wanted)


def _limb_action(way: PasteMode, label: str) -> ActionSpec:
    return ActionSpec(
        do(paste_on_limb, way),
        label,
        why_disabled=partial(paste_on_limb_disabled_reason, way=way),
    )


PASTE_ON_LIMB = _limb_action("as it is", _("Paste on this limb"))
FLIP_ON_LIMB = _limb_action("flipped", _("Paste flipped on limb"))
SWAP_ON_LIMB = _limb_action("swapped", _("Paste swapped on limb"))


def pasted_targets(
    project: Project, landing: PasteDestination, way: PasteMode
) -> Mapping[int, Target]:
    """Return the targets of a layer's handles from the first copied key, by id."""
    if landing.is_own:
        pose, layer = fit_copied_keys(project, landing)[0].pose, landing.layer
        if way == "flipped":
            return flip_targets(layer, pose, layer.axis, project.document.pairs)
        if landing.is_direct(way):
            return pose.targets
    return landing.pose_transfer(way).transfer_targets(landing.layer, landing.copied.keys[0].pose)


def fit_copied_keys(project: Project, landing: PasteDestination) -> list[Keyframe]:
    """Return the copied keys with poses within the limits of the layer that takes them."""
    copied = landing.copied
    return pose_insertion.fit_keys_to_layer(
        project, landing.layer.id, copied.keys, copied.layer.bounds
    )
