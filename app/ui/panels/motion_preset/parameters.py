"""Sliders of a motion preset's parameters, in a draft and of an applied motion."""

from collections.abc import Collection

from app.document import AppliedMotion
from app.editor import Action, Project, do
from app.editor.actions.posing.motion_presets import apply_motion
from app.rigging import MOTIONS, MotionTemplate, Parameters
from app.texts import _
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import label

SPEEDS = Scale(left=0.25, right=4.0, logarithmic=True)
SIZES = Scale(left=0.1, right=2.0)
ENERGIES = Scale(left=0.0, right=2.0)
LEANS = Scale(left=-30.0, right=30.0)
DELAYS = Scale(left=0.0, right=0.5)
SHARES = Scale(left=0.0, right=0.99)


def draw_parameter_sliders(
    look: Look, now: Parameters, template: MotionTemplate, offered: Collection[str]
) -> tuple[dict[str, float], bool]:
    """Draw the sliders; return the changed parameter, and whether the pointer let it go.

    `offered` are the parameters of single parts that change something.
    """
    steps = template.can_travel
    size = _("Stride") if steps else _("Size")
    height = _("Height") if steps else _("Energy")
    rows = [
        ("speed", _("Speed"), SPEEDS, "%.2f ×", _("How many times as fast as usual")),
        ("size", size, SIZES, "%.2f ×", _("How far limbs swing, and how far steps go")),
        ("energy", height, ENERGIES, "%.2f ×", _("How much the body bounces and sways")),
        ("start", _("Start"), SHARES, "%.2f", _("Where in its cycle the motion begins")),
    ]
    hint = _("By which share of the cycle this part is later")
    parts = [
        ("lean", _("Lean"), LEANS, "%.0f°", _("How far the trunk leans forwards")),
        ("head_delay", _("Head delay"), DELAYS, "%.2f", hint),
        ("arm_delay", _("Arm delay"), DELAYS, "%.2f", hint),
        ("tail_delay", _("Tail delay"), DELAYS, "%.2f", hint),
    ]
    rows += [row for row in parts if row[0] in offered]
    changed, is_final = dict[str, float](), False
    for name, text, scale, form, hint in rows:
        label(look, text)
        entered = slider(look, name, getattr(now, name), scale, text=form, hint=hint)
        if entered is not None:
            changed, is_final = {name: scale.clamp(entered.value)}, entered.is_final
    return changed, is_final


def draw_applied_parameters(look: Look, project: Project, given: AppliedMotion) -> list[Action]:
    """Draw the sliders of an applied motion; a slider that is let go applies it again."""
    if given.motion not in MOTIONS:
        return []
    template = MOTIONS[given.motion].template_for(given.kind)
    offered = template.part_parameters(given.kind, given.joints)
    changed, is_final = draw_parameter_sliders(look, given.parameters, template, offered)
    if not changed or not is_final:
        return []
    change = apply_motion.change_applied_motion
    return [do(change, project.layer.id, given.first, **changed)]
