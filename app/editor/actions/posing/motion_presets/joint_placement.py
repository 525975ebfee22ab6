"""Placement of joints: found, dragged, left out, restored and mirrored."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.editor.actions.action_spec import named_action, unless
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.motion_setup import MotionSetup
from app.rigging import other_side, swap_limbs
from app.texts import _

# Offset of a joint that was not found from its parent joint, in heights of the body.
BELOW = 0.12
BESIDE: Mapping[str, complex] = {
    "chest": 2j,
    "neck": 1j,
    "head": 1.5j,
    "tail": -1.0,
    "shoulder": 0.7,
    "elbow": 1.0 - 0.5j,
    "hand": 0.7 - 0.7j,
    "hip": 0.4 - 0.2j,
    "knee": 0.3 - 1j,
    "foot": -1j,
}


def swap_near_limbs(session: Session, end: str) -> None:
    """Make the other limb of a pair the near one; the question is answered."""
    draft = session.tools.motion_setup
    if draft is not None:
        swapped = draft.with_joints(swap_limbs(draft.joints, end), end)
        session.tools.select(swapped.with_answer(end))


def keep_near_limbs(session: Session, end: str) -> None:
    """Keep the guessed near limb of a pair; the question is answered."""
    draft = session.tools.motion_setup
    if draft is not None:
        session.tools.select(draft.with_answer(end))


def select_joint(session: Session, name: str | None) -> None:
    draft = session.tools.motion_setup
    if draft is not None:
        session.tools.select(replace(draft, selected_joint=name))


def move_joint(session: Session, name: str, place: complex) -> None:
    """Put a joint at a place of the drawing at rest."""
    draft = session.tools.motion_setup
    if draft is not None:
        session.tools.select(draft.with_joints({**draft.joints, name: place}, name))


@with_project
def move_shown_joint(session: Session, project: Project, name: str, place: complex) -> None:
    """Put a joint at a shown place of the drawing, or at the nearest one."""
    shown = project.layer_runtime.shown
    if shown is not None:
        found = shown.mesh.locate(np.array([place]), shown.positions)
        move_joint(session, name, complex(found.positions_on(shown.mesh.domain.mesh.vertices)[0]))


def shown_joint_places(session: Session, project: Project) -> dict[str, complex]:
    """Return the shown places of the draft's joints, by their names."""
    draft, shown = session.tools.motion_setup, project.layer_runtime.shown
    if draft is None or shown is None or not draft.joints:
        return {}
    places = shown.mesh.locate_at_rest(draft.joints.values()).positions_on(shown.positions)
    return dict(zip(draft.joints, places.tolist(), strict=True))


def exclude_joint(session: Session, name: str) -> None:
    """Leave a joint out of the motion."""
    draft = session.tools.motion_setup
    if draft is not None and name in draft.joints:
        session.tools.select(draft.without(name))


def include_joint(session: Session, name: str) -> None:
    """Put a joint where it was found, or else beside its parent joint."""
    draft = session.tools.motion_setup
    if draft is not None and name not in draft.joints:
        place = draft.suggested.get(name)
        move_joint(session, name, _beside(draft, name) if place is None else place)


@named_action(
    _("Detect joints"),
    icon="WAND_MAGIC_SPARKLES",
    hint=_("Move all joints back to where they were detected"),
    why_disabled=unless(
        lambda session, _: (
            session.tools.motion_setup is not None and session.tools.motion_setup.suggested
        ),
        _("Choose a motion preset for a body with joints first."),
    ),
)
def reset_joints(session: Session) -> None:
    draft = session.tools.motion_setup
    if draft is not None:
        session.tools.select(draft.with_joints(draft.suggested))


@named_action(
    _("Mirror joints"),
    icon="LEFT_RIGHT",
    hint=_("Mirror the joints of one side to the other side"),
    why_disabled=unless(
        lambda session, _: (
            session.tools.motion_setup is not None
            and session.tools.motion_setup.kind == "biped-front"
        ),
        _("Choose a motion preset for a body seen from the front first."),
    ),
)
def mirror_joints(session: Session) -> None:
    """Mirror the joints of one side to the other side.

    The side is that of the last selected joint, or the left one.
    """
    draft = session.tools.motion_setup
    if draft is None:
        return
    side = mirrored_side(draft)
    axis = _axis(draft)
    joints, outside = dict(draft.joints), []
    for name, place in draft.joints.items():
        if name.endswith(f".{side}"):
            mirrored = complex(2 * axis - place.real, place.imag)
            (nearest,) = _inside(draft, mirrored)
            joints[other_side(name)] = nearest
            outside += [other_side(name)] if nearest != mirrored else []
    session.tools.select(draft.with_joints(joints, draft.selected_joint))
    if outside:
        text = _(
            "The mirrored places of {joints} are outside the drawing. Drag these joints to "
            "their places."
        )
        session.notices.show(text.format(joints=", ".join(map(_, outside))))


def mirrored_side(draft: MotionSetup) -> str:
    """Return the side whose joints are mirrored to the other side."""
    name = draft.selected_joint or ""
    return name[-1] if name.endswith((".L", ".R")) else "L"


def _axis(draft: MotionSetup) -> float:
    """Return x of the body's middle, from the joints that are on neither side."""
    middle = [at.real for name, at in draft.joints.items() if name in {"hips", "chest", "head"}]
    outline = draft.domain.outline.real
    return float(np.mean(middle) if middle else (outline.min() + outline.max()) / 2)


def _inside(draft: MotionSetup, *places: complex) -> list[complex]:
    """Return the places on the drawing nearest to the given places."""
    nearest: list[complex] = draft.domain.nearest(np.array(places, dtype=np.complex128)).tolist()
    return nearest


def _beside(draft: MotionSetup, name: str) -> complex:
    """Return a place for a joint that was not found: like the other side, or near its parent."""
    kind, joints = draft.body_kind, draft.joints
    outline = draft.domain.outline
    opposite = joints.get(other_side(name))
    if opposite is not None and kind.name == "biped-front":
        return _inside(draft, complex(2 * _axis(draft) - opposite.real, opposite.imag))[0]
    reach = BELOW * float(np.ptp(outline.imag))
    if opposite is not None and other_side(name) != name:
        return _inside(draft, opposite + 0.4 * reach)[0]
    before = kind.parent(name, joints)
    joint, _, side = name.partition(".")
    start = joints[before] if before else complex(np.mean(outline))
    step = BESIDE.get(joint, 1.0)
    return _inside(draft, start + reach * complex(-step.conjugate() if side == "R" else step))[0]
