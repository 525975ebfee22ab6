"""Stiff and soft parts of the drawing: brush, bones, and an update of existing keys."""

import numpy as np
from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import FOLDING_ANGLE, Bone, Layer, stiffness_commands
from app.editor import Action, Project, Session, StiffnessTool, do
from app.editor.actions import editing, viewing
from app.editor.actions.layer_setup import cut_out_editing, resolving, stiffness_editing
from app.editor.actions.posing.pose_drag import pose_at_playhead
from app.texts import _
from app.ui.panels.modes.cut_out import BRUSHES, brush_hint
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    align_right,
    draw_tooltip,
    fitted_button,
    heading,
    icon_button,
    label,
    progress_bar,
    small_text,
    split_line,
    text_button,
)

STRENGTHS = Scale(
    left=stiffness_editing.WEAKEST, right=stiffness_editing.STRONGEST, logarithmic=True
)
AMOUNTS = Scale(
    left=1 / stiffness_editing.SOFTEST, right=stiffness_editing.STRONGEST, logarithmic=True
)
SOFTNESSES = Scale(left=0.0, right=1.0)
TOOLS: tuple[tuple[StiffnessTool, str, str], ...] = (
    ("stiff", _("Stiff"), _("Brush over parts that bend and stretch less")),
    ("soft", _("Soft"), _("Brush over parts that bend and stretch more")),
    ("normal", _("Normal"), _("Brush over parts to make them normal again")),
    (
        "bone",
        _("Bone"),
        _("Drag from one handle to another: the limb is stiff"),
    ),
)


def draw_material(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the brush, the bones, and the button that applies both to existing keys."""
    layer = project.layer
    heading(look, _("Stiffness"), framed=True)
    align_right(1.15 * imgui.get_frame_height())
    hint, is_painted = _("Delete all strokes; bones stay"), layer.stiffness is not None
    actions = [] if session.display.tint == "stiffness" else [do(viewing.set_tint, "stiffness")]
    reason = None if is_painted else _("There are no strokes.")
    if icon_button(look, icons.ICON_FA_TRASH, "clear material", hint, reason=reason):
        actions.append(do(editing.edit_layer, stiffness_commands.clear_stiffness))
    actions += _tools(session, look) + _brush(session, look, project)
    heading(look, _("Bones"), framed=True)
    actions += _bones(look, layer)
    heading(look, _("Whole layer"))
    actions += _whole(layer)
    heading(look, _("Keys"))
    return actions + _keys(session, look, project)


def _tools(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    widest = max(imgui.calc_text_size(name).x for _tool, name, _hint in TOOLS)
    palette, widths = look.palette, split_line(len(TOOLS), widest=widest + 0.4 * look.em)
    for (tool, name, hint), width in zip(TOOLS, widths, strict=True):
        is_chosen = session.tools.mode == tool
        imgui.push_style_color(imgui.Col_.button, palette.accent if is_chosen else palette.raised)
        imgui.push_style_color(imgui.Col_.text, palette.on_accent if is_chosen else palette.text)
        if fitted_button(f"{name}###{tool} tool", width):
            actions.append(do(stiffness_editing.toggle_stiffness_tool, tool))
        imgui.pop_style_color(2)
        draw_tooltip(hint)
    return actions


def _brush(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    label(look, _("Size"))
    radius = cut_out_editing.brush_radius(project)
    entered = slider(look, "material brush", radius, BRUSHES, text="%.0f", hint=brush_hint())
    if entered is not None:
        actions.append(do(cut_out_editing.set_brush_radius, entered.value))
    label(look, _("Strength"))
    hint = _("How many times stiffer or softer the brush makes the shape")
    entered = slider(look, "strength", session.tools.strength, STRENGTHS, text="%.1f ×", hint=hint)
    if entered is not None:
        actions.append(do(stiffness_editing.set_stiffness_strength, entered.value))
    label(look, _("Soft edge"))
    hint = _("How much of the radius fades out")
    entered = slider(look, "softness", session.tools.softness, SOFTNESSES, hint=hint)
    if entered is not None:
        actions.append(do(stiffness_editing.set_brush_softness, entered.value))
    small_text(
        look,
        _("Brush along the edge: the limb changes all the way through."),
    )
    if session.tools.mode == "stiff":
        small_text(look, _describe_limits(project.layer, session.tools.strength))
    return actions


def _bones(look: Look, layer: Layer) -> list[Action]:
    if not layer.bones:
        small_text(
            look,
            _("There are no bones yet. Choose “Bone”, then drag from a handle to the next one."),
        )
        return []
    actions: list[Action] = []
    is_shown = any(bone.is_shown for bone in layer.bones)
    align_right(1.15 * imgui.get_frame_height())
    eye = icons.ICON_FA_EYE if is_shown else icons.ICON_FA_EYE_SLASH
    if icon_button(look, eye, "show bones", _("Show or hide the bones. Hidden bones act, too.")):
        actions.append(
            do(editing.edit_layer, stiffness_commands.set_bones_visible, shown=not is_shown)
        )
    for bone in layer.bones:
        first, second = (layer.handle(identity).name for identity in bone.ends)
        name = f"{first} – {second}"
        imgui.push_id(str(bone.ends))
        imgui.align_text_to_frame_padding()
        imgui.text_unformatted(name)
        align_right(1.15 * imgui.get_frame_height())
        if icon_button(look, icons.ICON_FA_XMARK, "delete bone", _("Delete this bone")):
            actions.append(do(editing.edit_layer, stiffness_commands.remove_bone, bone.ends))
        hint = _("Stiffness of the limb: 1 is normal")
        entered = slider(look, "amount", bone.stiffness, AMOUNTS, text="%.1f ×", hint=hint)
        if entered is not None:
            stiffen = stiffness_commands.set_bone_stiffness
            actions.append(do(editing.edit_layer, stiffen, bone.ends, entered.value))
        small_text(look, _describe_bone(layer, bone))
        imgui.pop_id()
    return actions


def _describe_limits(layer: Layer, amount: float) -> str:
    """Describe the limits of new poses in a stiff part."""
    limits = layer.bounds.scaled_by(np.array([amount]))
    fields = limits.k, limits.sigma_a, limits.sigma_b
    shear, stretch, squeeze = (float(np.ravel(each)[0]) for each in fields)
    return _(
        "In new poses this part bends at most {shear:.0%}, stretches at most {stretch:.0%} and "
        "shrinks at most {shrinkage:.0%}."
    ).format(shear=shear, stretch=stretch - 1, shrinkage=1 - squeeze)


def _describe_bone(layer: Layer, bone: Bone) -> str:
    """Describe what a bone does in new poses."""
    if not bone.is_limb:
        return _("This part bends and stretches more, within the limits of the layer.")
    if bone.ends[1] not in layer.bone_joints:
        return _("This bone keeps its length.")
    return _("This bone keeps its length. {joint} may fold by {angle:.0f}°.").format(
        joint=layer.handle(bone.ends[1]).name, angle=FOLDING_ANGLE
    )


def _whole(layer: Layer) -> list[Action]:
    actions: list[Action] = []
    widths = split_line(2)
    hint = _("Make heads, hands and feet stiff, tails and hair soft, by the names of the handles")
    text = f"{icons.ICON_FA_WAND_MAGIC_SPARKLES}  {_('By names')}"
    reason = None if layer.handles else _("Add a handle first.")
    if text_button(text, next(widths), hint, reason=reason):
        actions.append(do(stiffness_editing.suggest_stiffness))
    hint = _("Copy the material of one side of the mirror axis to the other side")
    is_any = layer.stiffness is not None or bool(layer.bones)
    text = f"{icons.ICON_FA_ARROWS_LEFT_RIGHT}  {_('Mirror')}"
    reason = None if is_any else _("Brush over a part or draw a bone first.")
    if text_button(text, next(widths), hint, reason=reason):
        actions.append(do(stiffness_editing.mirror_stiffness))
    return actions


def _keys(session: Session, look: Look, project: Project) -> list[Action]:
    small_text(look, _("Keys keep their poses until you re-pose them with this material."))
    resolver = project.key_resolver
    if resolver is not None and resolver.new_layer is None:
        return (
            [do(resolving.cancel_solving_keys)]
            if progress_bar(resolver.progress, resolver.status_text)
            else []
        )
    actions: list[Action] = []
    reason = resolving.solving_disabled_reason(project)
    here, widths = reason, split_line(2)
    if reason is None and pose_at_playhead(session, project) is None:
        here = _("Move the playhead to a key first.")
    hint = _("Pull the handles of the pose that is shown to their targets again")
    if text_button(_("Re-pose this key"), next(widths), hint, reason=here):
        actions.append(do(stiffness_editing.solve_shown_pose_again))
    hint = _("Pull the handles of every key to their targets again")
    if text_button(_("Re-pose all keys"), next(widths), hint, reason=reason):
        actions.append(do(resolving.solve_keys_again))
    return actions
