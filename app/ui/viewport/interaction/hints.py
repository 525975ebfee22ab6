"""Texts of the viewport: hints under the pointer, next steps, and special states."""

from functools import reduce

from imgui_bundle import ImVec2, imgui

from app.editor import Action, Hint, Project, Session
from app.editor.actions import tutorials, viewing
from app.editor.actions.action_spec import ActionSpec
from app.editor.actions.posing.motion_presets import apply_motion, rigging
from app.editor.actions.timing import keys
from app.editor.tools import move_tool
from app.editor.tools.table import tools_of
from app.editor.tools.tool import PointerHit
from app.texts import _
from app.ui.shortcuts.keys import ALT, CTRL, SHIFT, format_modified, shown_keys
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import draw_tooltip
from app.ui.viewport.marks import find_auto_pinned
from app.ui.viewport.screen import ScreenMapping

HINTS = (
    _("Click on the drawing to add a handle."),
    _("Drag a handle to pose. A second handle holds another part in place."),
    _("Move the playhead, then drag again to set the second key."),
)
KEYS = {"ctrl": (CTRL,), "shift": (SHIFT,), "alt": (ALT,), "ctrl+shift": (SHIFT, CTRL)}


def find_hint(session: Session, screen: ScreenMapping, spot: PointerHit) -> str:
    """Return the possible gestures at the pointer."""
    project = screen.project
    if session.tools.active_tool is not None:
        return _sentence(
            [*map(_format_hint, session.tools.active_tool.active_hints), _("Esc cancels")]
        )
    if not session.tools.is_cutting and project.timeline.playhead.since is not None:
        return _("Space stops")
    needs_handles = session.tools.is_posing or session.tools.mode == "bone"
    if needs_handles and not session.display.overlays.handles:
        return _("The handles are hidden: {key} shows them").format(key=shown_keys(viewing.HANDLES))
    hints = [
        _format_hint(hint)
        for tool in tools_of(session)
        for hint in tool.hints(session, project, spot)
    ]
    if not session.tools.is_posing:
        return _sentence([*hints, _("Esc goes back to posing")])
    if spot.handle is not None:
        if spot.handle in find_auto_pinned(screen.shown):
            hints.append(_("stays in place until the next key"))
        return f"{screen.shown.clip.layer.handle(spot.handle).name}: {', '.join(hints)}"
    if not (spot.on_shape or spot.on_gizmo):
        hints += [_("wheel to zoom"), _("middle drag to move the view")]
    return _sentence(hints)


def _sentence(parts: list[str]) -> str:
    text = ", ".join(parts)
    return text[:1].upper() + text[1:]


def _format_hint(hint: Hint) -> str:
    keys = KEYS.get(hint.key, ())
    return reduce(lambda text, key: format_modified(key, text), keys, hint.text)


def draw_badges(
    session: Session, look: Look, project: Project, corner: ImVec2, room: ImVec2
) -> list[Action]:
    """Draw special states: a pose without a key, the active tool, or the next step."""
    top = corner + ImVec2(room.x / 2, look.em)
    if project.unkeyed_pose is not None and not session.tools.is_cutting:
        return _draw_pill(look, _("Unkeyed pose"), top, room.x, keys.insert_key_in_row)
    has_bar = session.tools.is_cutting or session.tools.motion_setup is not None
    mode = next(filter(None, (tool.mode(session, project) for tool in tools_of(session))), "")
    if mode and not has_bar:
        end = shown_keys(move_tool.return_to_posing)
        text = _("{mode}: {keys} goes back to posing").format(mode=mode, keys=end)
        return _draw_pill(look, text, top, room.x)
    cancellable = _cancellable_job(session, project)
    if cancellable is not None:
        job_step, cancel = cancellable
        text = _("{step} · {keys} cancels").format(step=job_step, keys=shown_keys(cancel))
        return _draw_pill(look, text, top, room.x)
    step = find_first_step(project)
    if step is None or tutorials.is_tutorial_shown(session):
        return []
    # Messages are below, and so are feet.
    return _draw_pill(look, HINTS[step], corner + ImVec2(room.x / 2, 0.5 * look.em), room.x)


def _cancellable_job(session: Session, project: Project) -> tuple[str, ActionSpec] | None:
    """Return the step of a job for which the person waits, and the action that cancels it."""
    if project.motion_job is not None:
        return project.motion_job.step_label, apply_motion.cancel_motion_job
    if rigging.RIGGING in session.jobs.kinds:
        return rigging.RIGGING.label, rigging.cancel_rigging
    return None


def find_first_step(project: Project) -> int | None:
    """Return the index of a new project's next hint; None once the person has done all steps."""
    layer = project.layer
    if not layer.handles:
        return 0
    if len(layer.keys) > 1 or project.timeline.playhead.since is not None:
        return None
    return 2 if tutorials.is_first_pose_changed(layer) else 1


def _draw_pill(
    look: Look, text: str, place: ImVec2, room: float, remedy: ActionSpec | None = None
) -> list[Action]:
    """Draw a text below a place, wrapped to a width. A warning has a remedy's button beside it."""
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    padding = 0.7 * look.em
    beside = imgui.calc_text_size(remedy.label).x + 1.6 * look.em if remedy else 0.0
    wrap = max(room - 4 * padding - beside, look.em)
    size = imgui.calc_text_size(text, wrap_width=wrap)
    height = size.y + 1.1 * look.em
    low = place - ImVec2(size.x / 2 + padding + beside / 2, 0)
    high = low + ImVec2(size.x + 2 * padding + beside, height)
    draw_list.add_rect_filled(low, high, colour_u32(palette.panel, 0.92), look.em)
    draw_list.add_rect(
        low, high, colour_u32(palette.warning if remedy else palette.line), look.em, 1.2
    )
    text_place = low + ImVec2(padding, (height - size.y) / 2)
    colour = colour_u32(palette.warning if remedy else palette.text)
    font = imgui.get_font()
    draw_list.add_text(font, imgui.get_font_size(), text_place, colour, text, wrap_width=wrap)
    if remedy is None:
        return []
    slim = imgui.get_frame_height() - 0.1 * look.em
    corner = ImVec2(high.x - beside - 0.2 * look.em, low.y + (height - slim) / 2)
    imgui.set_cursor_screen_pos(corner)
    imgui.push_style_var(imgui.StyleVar_.frame_rounding, slim / 2)
    imgui.push_style_var(imgui.StyleVar_.frame_padding, ImVec2(0, 0))
    is_pressed = imgui.button(remedy.label, ImVec2(beside, slim))
    imgui.pop_style_var(2)
    draw_tooltip(remedy.hint, shown_keys(remedy))
    return [remedy.action] if is_pressed else []
