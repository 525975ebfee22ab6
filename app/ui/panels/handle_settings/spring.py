"""The spring of a handle, which swings about the handle's place in the motion."""

from dataclasses import replace
from typing import Any

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import SPRING_PRESETS, Handle, Layer, Spring, spring_root, track_commands
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.editor.actions.timing import springs
from app.texts import _
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    align_right,
    draw_tooltip,
    heading,
    icon_button,
    label,
    option_buttons,
    small_text,
    text_button,
)

FREQUENCIES = Scale(left=0.2, right=12.0, logarithmic=True)
DAMPINGS = Scale(left=0.0, right=1.5)
LAGS = Scale(left=0.0, right=12.0)
STRENGTHS = Scale(left=0.0, right=2.0)
STRETCHES = Scale(left=0.0, right=1.0)
PRESET_NAMES = {
    "tail": _("Tail"),
    "ear": _("Ear"),
    "hair": _("Hair"),
    "cloth": _("Cloth"),
    "jelly": _("Jelly"),
}
LEAST_FREQUENCY = 0.01  # Hz
NEAREST = _("Nearest handle")
NO_ROOT = _("The handle swings freely. Add a handle at its root to keep its length.")
# The numbers of a spring: field, label, range, format, explanation.
NUMBERS = (
    ("frequency", _("Frequency"), FREQUENCIES, "%.2f", _("Swings per second, in Hz")),
    (
        "damping",
        _("Damping"),
        DAMPINGS,
        "%.2f",
        _("How soon the handle comes to rest: 0 never, 1 at once"),
    ),
    ("lag", _("Lag"), LAGS, "%.1f", _("How many frames the handle lags behind the shape")),
    ("strength", _("Strength"), STRENGTHS, "%.2f", _("How far the handle swings: 1 is normal")),
    (
        "stretch",
        _("Stretch"),
        STRETCHES,
        "%.2f",
        _("How far its distance to the root changes: 0 not at all, 1 freely"),
    ),
)


def draw_spring(look: Look, project: Project, handle: Handle) -> list[Action]:
    spring, actions = project.layer.spring_of(handle.id), list[Action]()
    heading(look, _("Spring"), framed=True)
    if spring is not None:
        align_right(1.15 * imgui.get_frame_height())
        if icon_button(look, icons.ICON_FA_TRASH, "delete spring", _("Delete the spring")):
            command = track_commands.remove_springs
            actions.append(do(editing.edit_layer, command, (handle.id,)))
    label(look, _("Preset"))
    names = [(name, PRESET_NAMES[name]) for name in SPRING_PRESETS]
    taken = option_buttons(look, "preset", names, "" if spring is None else _preset(spring))
    draw_tooltip(_("Let the handle lag and swing like one of these"))
    if taken is not None:
        frequency, damping = SPRING_PRESETS[taken]
        usual = spring or Spring(handle=handle.id, frequency=frequency, damping=damping)
        actions.append(_set(replace(usual, frequency=frequency, damping=damping)))
    if spring is None:
        small_text(
            look, _("The handle follows the shape at once. Choose a spring to let it swing.")
        )
        return actions
    track = project.layer.track_of(handle.id)
    if track is not None and track.enabled:
        small_text(
            look, _("The track overrides the spring. Switch the track off to use the spring.")
        )
    label(look, _("Spring"))
    changed, enabled = imgui.checkbox(_("on") + "##spring", spring.enabled)
    draw_tooltip(_("Switch the spring on or off. Its settings stay."))
    if changed:
        actions.append(_set(replace(spring, enabled=enabled)))
    actions += _root(look, project.layer, spring)
    for field, text, scale, written, hint in NUMBERS:
        label(look, text)
        entered = slider(look, field, getattr(spring, field), scale, text=written, hint=hint)
        if entered is not None:
            changed_field: dict[str, Any] = {field: _allowed(field, entered.value)}
            actions.append(_set(replace(spring, **changed_field)))
    reason = None if spring.enabled else _("Switch the spring on first.")
    if spring.enabled and track is not None:
        reason = _("The track overrides the spring. Delete the track first.")
    hint = _("Turn the swing into a track with keys that you can edit")
    if text_button(_("Bake to keys"), FILL, hint, reason=reason):
        actions.append(do(springs.bake_spring, handle.id))
    return actions


def _allowed(field: str, value: float) -> float:
    """Round a number and clamp it to the field's range."""
    least = LEAST_FREQUENCY if field == "frequency" else 0.0
    most = {
        "frequency": 1000.0,
        "damping": 100.0,
        "lag": 10_000.0,
        "strength": 10.0,
        "stretch": 1.0,
    }[field]
    return min(max(round(value, 3), least), most)


def _root(look: Look, layer: Layer, spring: Spring) -> list[Action]:
    """Draw the root handle of the spring, and the menu that chooses another."""
    actions: list[Action] = []
    nearest = spring_root(layer, replace(spring, root=None))
    nearest_name = (
        NEAREST
        if nearest is None
        else _("Nearest handle: {name}").format(name=layer.handle(nearest).name)
    )
    label(look, _("Swings about"))
    imgui.set_next_item_width(-1)
    shown = nearest_name if spring.root is None else layer.handle(spring.root).name
    if imgui.begin_combo("##root", shown):
        names = [(handle.id, handle.name) for handle in layer.handles]
        for root, name in [(None, nearest_name), *names]:
            if root != spring.handle and imgui.menu_item_simple(f"{name}###about {root}"):
                actions.append(_set(replace(spring, root=root)))
        imgui.end_combo()
    draw_tooltip(_("The root: the handle keeps its distance to it, as an ear's tip to the head"))
    if nearest is None and spring.root is None:
        small_text(look, NO_ROOT)
    return actions


def _set(spring: Spring) -> Action:
    return do(editing.edit_layer, track_commands.put_spring, spring)


def _preset(spring: Spring) -> str:
    """Return the name of the spring's preset, or ""."""
    own = spring.frequency, spring.damping
    return next((name for name, numbers in SPRING_PRESETS.items() if numbers == own), "")
