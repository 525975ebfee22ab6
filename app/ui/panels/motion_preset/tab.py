"""The tab of motion presets: the layer's applied motions, and the motion setup."""

from imgui_bundle import ImVec2, imgui

from app.document import AppliedMotion, is_motion_unedited
from app.editor import Action, Project, Session, do
from app.editor.actions.posing.motion_presets import (
    apply_motion,
    joint_placement,
    preset_setup,
    rigging,
)
from app.editor.tools import move_tool
from app.editor.work.motion_setup import MotionSetup
from app.rigging import KINDS, MOTIONS
from app.texts import _, ngettext
from app.ui.panels.motion_preset.diagram import draw_body_diagram, draw_joint_diagram
from app.ui.panels.motion_preset.near_limbs import draw_near_limb_questions
from app.ui.panels.motion_preset.parameters import (
    draw_applied_parameters,
    draw_parameter_sliders,
)
from app.ui.shortcuts.keys import CTRL, format_modified, shown_keys
from app.ui.shortcuts.widgets import draw_action_main_button, draw_action_text_button
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look, colour_u32, icon_glyph
from app.ui.style.widgets import (
    draw_tooltip,
    heading,
    label,
    main_button,
    option_buttons,
    progress_bar,
    small_text,
    split_line,
    text_button,
)

REPEATS = Scale(left=1.0, right=20.0)
KIND_HEIGHT, DIAGRAM_HEIGHT = 3.2, 9.5  # em
IN_A_ROW = 5  # largest number of motions
FACINGS = {None: _("Automatic"), -1: _("Left"), 1: _("Right")}


def draw_motion_panel(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the motion setup or its progress; otherwise the layer's applied motions."""
    job, draft = project.motion_job, session.tools.motion_setup
    if job is not None:
        heading(look, _("Applying “{preset}”").format(preset=job.setup.preset.label))
        return (
            [do(apply_motion.cancel_motion_job)]
            if progress_bar(job.progress, job.step_label)
            else []
        )
    if draft is None:
        return _draw_applied_motions(session, look, project)
    # The end buttons stay visible while the rest scrolls.
    lines = (
        1
        + bool(preset_setup.apply_motion_disabled_reason(session, project))
        + preset_setup.are_edits_lost(session, project)
    )
    below = (2.0 + 1.5 * lines) * look.em + imgui.get_frame_height()
    imgui.begin_child("draft", ImVec2(0, max(imgui.get_content_region_avail().y - below, 1.0)))
    actions = _kinds(look, draft) + _motions(look, draft)
    actions += _joints(session, look, draft) + _parameters(look, draft)
    imgui.end_child()
    return actions + _end(session, look, project, draft)


def _draw_applied_motions(session: Session, look: Look, project: Project) -> list[Action]:
    """Draw the layer's applied motions, and the button that sets up another one."""
    actions: list[Action] = []
    layer = project.layer
    title = _("Motions of {name}") if layer.motions else _("Motion presets")
    heading(look, title.format(name=layer.name))
    if not layer.motions:
        small_text(
            look, _("Let the drawing walk, wave, slither or breathe. Show where its joints are.")
        )
    kept = preset_setup.kept_motion_setup(session, project)
    if kept is not None:
        text = _("The joints and settings that you left for “{preset}” are kept.")
        small_text(look, text.format(preset=kept.preset.label))
    for given in layer.motions:
        imgui.push_id(given.first)
        actions += _row(look, project, given)
        imgui.pop_id()
    imgui.dummy(ImVec2(0, 0.3 * look.em))
    actions += draw_action_main_button(session, look, preset_setup.begin_motion_setup)
    width = imgui.get_content_region_avail().x
    return actions + draw_action_text_button(session, rigging.rig_layer, width)


def _row(look: Look, project: Project, given: AppliedMotion) -> list[Action]:
    actions: list[Action] = []
    name = MOTIONS[given.motion].label if given.motion in MOTIONS else given.motion
    text = _("{name}, frames {first} – {last}")
    imgui.text_unformatted(text.format(name=name, first=given.first, last=given.last))
    if not is_motion_unedited(project.layer, given):
        small_text(look, _("You edited this motion by hand. Other settings keep your edits."))
    actions += draw_applied_parameters(look, project, given)
    widths = split_line(2)
    if text_button(_("Change…"), next(widths), _("Apply it again with other settings")):
        actions.append(do(preset_setup.edit_applied_motion, given))
    hint = _("Add another motion from frame {frame} on").format(frame=given.last)
    if text_button(_("Add motion…"), next(widths), hint):
        actions.append(do(preset_setup.append_motion, given))
    return actions


def _kinds(look: Look, draft: MotionSetup) -> list[Action]:
    """Draw a button with a diagram for each kind of body."""
    actions: list[Action] = []
    heading(look, _("Body"))
    palette = look.palette
    widths = split_line(len(KINDS), 0.3 * look.em)
    for (name, kind), width in zip(KINDS.items(), widths, strict=True):
        is_chosen = name == draft.kind
        low = imgui.get_cursor_screen_pos()
        size = ImVec2(width, KIND_HEIGHT * look.em)
        imgui.push_style_color(imgui.Col_.button, palette.accent if is_chosen else palette.raised)
        if imgui.button(f"###{name} kind", size):
            actions.append(do(preset_setup.set_body_kind, name))
        imgui.pop_style_color()
        draw_tooltip(_("{label}. {hint}").format(label=kind.label, hint=kind.hint))
        colour = colour_u32(palette.on_accent if is_chosen else palette.text)
        inset = ImVec2(0.2 * look.em, 0.4 * look.em)
        draw_body_diagram(look, kind, low + inset, size - inset * 2, colour)
    kind = draft.body_kind
    small_text(look, _("{label}. {hint}.").format(label=kind.label, hint=kind.hint))
    return actions


def _joints(session: Session, look: Look, draft: MotionSetup) -> list[Action]:
    heading(look, _("Joints"))
    if not draft.body_kind.parents:
        small_text(look, _("The drawing moves as a whole. It has no joints."))
        return []
    width = imgui.get_content_region_avail().x
    actions = draw_near_limb_questions(look, draft)
    actions += draw_joint_diagram(look, draft, ImVec2(width, DIAGRAM_HEIGHT * look.em))
    small_text(
        look,
        _(
            "Drag the joints to their places on the drawing. To leave a joint out, click it "
            "here, or {keys} it on the drawing."
        ).format(keys=format_modified(CTRL, _("click"))),
    )
    has_sides = draft.kind == "biped-front"
    widths = split_line(1 + has_sides)
    if has_sides:
        spec = joint_placement.mirror_joints
        way = (
            _("Mirror left to right")
            if joint_placement.mirrored_side(draft) == "L"
            else _("Mirror right to left")
        )
        text = f"{icon_glyph(spec.icon)}  {way}###mirror joints"
        hint = _("{hint}: from the side that you dragged last")
        hint = hint.format(hint=spec.hint)
        reason = None if draft.joints else _("Add a joint first.")
        if text_button(text, next(widths), hint, reason=reason):
            actions.append(spec.action)
    return actions + draw_action_text_button(session, joint_placement.reset_joints, next(widths))


def _motions(look: Look, draft: MotionSetup) -> list[Action]:
    heading(look, _("Preset"))
    actions: list[Action] = []
    fitting = [motion for motion in MOTIONS.values() if draft.kind in motion.templates]
    rows = -(-len(fitting) // IN_A_ROW)
    width = -(-len(fitting) // rows)
    for row in range(0, len(fitting), width):
        options = [(motion.name, motion.label) for motion in fitting[row : row + width]]
        chosen = option_buttons(look, f"motions {row}", options, draft.motion)
        if chosen is not None:
            actions.append(do(preset_setup.set_motion_preset, chosen))
    small_text(look, _("{hint}.").format(hint=draft.preset.hint))
    return actions


def _parameters(look: Look, draft: MotionSetup) -> list[Action]:
    heading(look, _("Settings"))
    actions: list[Action] = []
    now = draft.parameters
    template = draft.preset.template_for(draft.kind)
    offered = template.part_parameters(draft.kind, draft.joints)
    changed, _is_final = draw_parameter_sliders(look, now, template, offered)
    if changed:
        actions.append(do(preset_setup.set_motion_parameters, **changed))
    label(look, _("Repeats"))
    hint = _("How many times the motion plays")
    entered = slider(look, "rounds", draft.rounds, REPEATS, text="%.0f", hint=hint)
    if entered is not None:
        rounds = min(max(round(entered.value), 1), preset_setup.MOST_ROUNDS)
        actions.append(do(preset_setup.set_motion_options, rounds=rounds))
    if draft.kind in {"biped-side", "four-legs"}:
        label(look, _("Facing"))
        options = [(str(way), text) for way, text in FACINGS.items()]
        chosen = option_buttons(look, "facing", options, str(draft.facing))
        if chosen is not None:
            ways = {str(way): way for way in FACINGS}
            actions.append(do(preset_setup.set_motion_options, facing=ways[chosen]))
    actions += _switches(look, draft)
    return actions


def _switches(look: Look, draft: MotionSetup) -> list[Action]:
    actions: list[Action] = []
    now = draft.parameters
    changed, mirrored = imgui.checkbox(_("Mirrored"), now.mirrored)
    draw_tooltip(_("Mirror the motion: the other arm waves, a walk goes the other way"))
    if changed:
        actions.append(do(preset_setup.set_motion_parameters, mirrored=mirrored))
    if draft.preset.template_for(draft.kind).can_travel:
        imgui.same_line(0, 1.2 * look.em)
        changed, travels = imgui.checkbox(_("Travels"), now.travel)
        draw_tooltip(
            _(
                "The layer moves across the picture, and does not loop. Otherwise it walks on "
                "the spot."
            )
        )
        if changed:
            actions.append(do(preset_setup.set_motion_parameters, travel=travels))
    return actions


def _end(session: Session, look: Look, project: Project, draft: MotionSetup) -> list[Action]:
    """Draw which motions are replaced, and the buttons that apply or cancel."""
    actions: list[Action] = []
    imgui.separator()
    if preset_setup.are_edits_lost(session, project):
        changed, replaces = imgui.checkbox(_("Replace edits"), draft.replaces_edits)
        if changed:
            actions.append(do(preset_setup.set_motion_options, replaces_edits=replaces))
    small_text(look, _where(project, draft))
    reason = preset_setup.apply_motion_disabled_reason(session, project)
    if reason:
        small_text(look, reason, look.palette.warning)
    widths = split_line(2)
    hint = _("Set the keys and play the motion. One undo removes them.")
    if main_button(look, _("Apply") + "###give", next(widths), hint, reason=reason):
        actions.append(do(apply_motion.apply_motion_preset))
    if text_button(
        _("Cancel") + "###no motion", next(widths), "", shown_keys(move_tool.return_to_posing)
    ):
        actions.append(do(preset_setup.close_motion_setup))
    return actions


def _where(project: Project, draft: MotionSetup) -> str:
    period = draft.preset.frames(draft.parameters, project.document.fps) * draft.rounds
    if draft.applied_motion is not None:
        text = _("It replaces the motion at frames {first} – {last}.")
        return text.format(first=draft.applied_motion.first, last=draft.applied_motion.last)
    text = ngettext(
        "From frame {first}, {count} frame long.",
        "From frame {first}, {count} frames long.",
        period,
    )
    return text.format(first=draft.first, count=period)
