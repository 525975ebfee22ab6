"""Mouths of a sound: keys from cues or from the volume, and the drawing of each cue."""

from imgui_bundle import imgui

from app.document import Document, Mouths, Sound
from app.editor import Action, Project, Session, do
from app.editor.actions.timing import mouths
from app.errors import display_name
from app.texts import _
from app.ui.style.sliders import Scale, number_field, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    draw_tooltip,
    heading,
    label,
    small_text,
    split_line,
    text_button,
)

SECONDS = Scale(left=0.0, right=0.5)
FACTORS = Scale(left=0.25, right=4.0, logarithmic=True)
NO_TARGET = _(
    "Create a switch of mouths or a slider in Layers, or select a handle: then keys are made from "
    "cues of a lip-sync program, or from the volume."
)


def draw_mouths(session: Session, look: Look, project: Project, sound: Sound) -> list[Action]:
    heading(look, _("Mouths"))
    targets = mouths.list_volume_targets(project)
    if not targets:
        small_text(look, NO_TARGET)
        return []
    actions: list[Action] = []
    chosen = next(
        (each for each in targets if each.label == session.tools.volume_target), targets[0]
    )
    label(look, _("Target"))
    if imgui.begin_combo("##target", display_name(chosen.label)):
        actions += [
            do(mouths.choose_volume_target, each.label)
            for each in targets
            if imgui.selectable(f"{display_name(each.label)}###{each.label}", each == chosen)[0]
        ]
        imgui.end_combo()
    draw_tooltip(_("Switches and sliders, and the selected handles of the active layer"))
    actions += _response(session, look, is_handle=chosen.kind == "track")
    is_switch = chosen.kind == "switch"
    widths = split_line(2 if is_switch else 1)
    hint = _("Make keys that open it with the volume, in place of those that were made before")
    if text_button(f"{_('Open with volume')}###volume", next(widths), hint):
        actions.append(do(mouths.open_with_volume, sound.name, chosen))
    if is_switch:
        hint = _("Make keys from a file of Rhubarb, Papagayo or Moho, or from CSV lines")
        if text_button(f"{_('Read cues…')}###cues", next(widths), hint):
            actions.append(do(mouths.ask_cues, sound.name, str(chosen.part)))
    own, document = sound.mouths, project.document
    names = {each.name for each in document.switch_groups}
    return actions + (_drawings(look, document, sound, own) if own and own.switch in names else [])


def _response(session: Session, look: Look, *, is_handle: bool) -> list[Action]:
    actions: list[Action] = []
    response = session.tools.response
    for name, text, value, scale, form, hint in (
        ("attack", _("Attack"), response.attack, SECONDS, "%.2f s", _("Time until it is open")),
        ("release", _("Release"), response.release, SECONDS, "%.2f s", _("Time until it closes")),
        (
            *("sensitivity", _("Sensitivity"), response.sensitivity, FACTORS, "%.2f"),
            _("More opens it at lower volumes"),
        ),
    ):
        label(look, text)
        moved = slider(look, name, value, scale, text=form, hint=hint)
        if moved is not None:
            changed = response._replace(**{name: moved.value})
            actions.append(do(mouths.set_volume_response, changed))
    if is_handle:
        opening = session.tools.opening
        label(look, _("Opens by"))
        for name, value, width in zip(
            ("right", "up"),
            (opening.real, opening.imag),
            split_line(2, imgui.get_style().item_inner_spacing.x),
            strict=True,
        ):
            imgui.set_next_item_width(width)
            entered = number_field(f"opens {name}", value, f"%.1f px {_(name)}")
            if entered is not None:
                other = complex(entered, opening.imag)
                other = other if name == "right" else complex(opening.real, entered)
                actions.append(do(mouths.set_volume_opening, other))
    return actions


def _drawings(look: Look, document: Document, sound: Sound, own: Mouths) -> list[Action]:
    """Draw the table from cue to drawing. A choice makes the keys again."""
    actions: list[Action] = []
    small_text(
        look,
        _("{cues} cues, {keys} keys in {switch}. Keys that you set or change stay.").format(
            cues=len(own.cues), keys=len(own.keys), switch=own.switch
        ),
    )
    layers = document.switch_group(own.switch).members
    for cue, drawing in own.drawings:
        label(look, display_name(cue))
        name = document.member_name(drawing) if drawing in layers else ""
        if imgui.begin_combo(f"##drawing of {cue}", name):
            actions += [
                do(mouths.choose_drawing, sound.name, cue, each)
                for each in layers
                if imgui.selectable(document.member_name(each), each == drawing)[0]
            ]
            imgui.end_combo()
        draw_tooltip(_("The drawing that shows {cue}").format(cue=display_name(cue)))
    hint = _("Make the keys anew, for example after the sound was moved")
    if text_button(f"{_('Make again')}###again", FILL, hint):
        actions.append(do(mouths.make_mouths_again, sound.name))
    return actions
