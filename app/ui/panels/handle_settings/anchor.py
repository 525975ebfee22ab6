"""The anchor, the reference point of the in-betweens."""

from imgui_bundle import icons_fontawesome_6 as icons

from app.document import Handle, motion_anchor, shape_commands
from app.editor import Action, Project, do
from app.editor.actions import editing
from app.editor.layering.anchors import toggle_anchor_at_handle
from app.texts import _
from app.ui.shortcuts.keys import CTRL, format_modified
from app.ui.style.theme import Look
from app.ui.style.widgets import shorten_text, small_text, split_line, text_button


def draw_anchor(look: Look, project: Project, chosen: list[Handle]) -> list[Action]:
    """Describe the anchor, the reference point of the in-betweens, and let it be set."""
    layer = project.layer
    holder = next((h.name for h in layer.handles if h.position == layer.anchor), None)
    if layer.anchor is None:
        text = _("Automatic: in-betweens turn around the middle of the shape.")
        if motion_anchor(layer) is not None:
            text = _("Automatic: in-betweens turn around the body that carries the bones.")
        small_text(look, text)
    elif holder is not None:
        name = shorten_text(holder, 12 * look.em)
        small_text(
            look,
            _("In-betweens turn around “{name}”, which takes the straightest path.").format(
                name=name
            ),
        )
    else:
        anchor = layer.anchor
        y = project.document.canvas[1] - anchor.imag
        text = _("In-betweens turn around the point {x:.0f}, {y:.0f}.")
        small_text(look, text.format(x=anchor.real, y=y))
    reason = None if len(chosen) == 1 else _("Select one handle first.")
    if reason is None and chosen[0].position == layer.anchor:
        reason = _("In-betweens already turn around this handle.")
    halves, actions = split_line(2), list[Action]()
    text = f"{icons.ICON_FA_ANCHOR}  {_('Follow handle')}###anchor here"
    hint, keys = _("Let in-betweens turn around this point"), format_modified(CTRL, _("click"))
    if text_button(text, next(halves), hint, keys, reason=reason):
        actions.append(do(toggle_anchor_at_handle, chosen[0].id))
    reason = _("The anchor is already automatic.") if layer.anchor is None else None
    if text_button(_("Automatic anchor") + "###clear anchor", next(halves), reason=reason):
        actions.append(do(editing.edit_layer, shape_commands.set_anchor, None))
    return actions
