"""What is painted in front around a handle, where the drawing lies over itself."""

from imgui_bundle import imgui

from app.document import USUAL_EXTENT, Handle, layer_commands
from app.editor import Action, Project, Session, do, layering
from app.editor.actions import editing, playback
from app.ui.style import Look, Scale, heading, label, slider, small, tip
from engine.geometry import box_diagonal

DEPTHS = Scale(left=-1.0, right=1.0)


def draw(session: Session, look: Look, project: Project, handle: Handle) -> list[Action]:
    """Draw the depth of a handle, its extent, and from which key on it holds."""
    heading(look, "In front")
    actions: list[Action] = []
    figure = project.figure
    frame = playback.current_frame(session, project)
    key = figure.key(frame) if frame in figure.key_frames else None
    is_keyed = key is not None and handle.id in key.fronts
    front = key.fronts[handle.id] if key is not None and is_keyed else handle.front
    imgui.begin_group()
    label(look, "Depth")
    hint = "Where the drawing lies over itself: −1 paints this part behind, 1 in front"
    entered = slider(look, "depth", front, DEPTHS, text="%.2f", hint=hint)
    if entered is not None:
        value = round(min(max(entered.value, -1.0), 1.0), 2)
        if is_keyed:
            actions.append(
                do(editing.edit_figure, layer_commands.key_front, frame, handle.id, value)
            )
        else:
            actions.append(_set(handle, value, handle.extent))
    usual = USUAL_EXTENT * box_diagonal(figure.domain.outline)
    label(look, "Extent")
    extents = Scale(left=0.1 * usual, right=8 * usual, logarithmic=True)
    hint = "How far around the handle that holds, in pixels along the drawing"
    entered = slider(look, "extent", handle.extent or usual, extents, text="%.0f", hint=hint)
    if entered is not None and entered.value > 0:
        actions.append(_set(handle, handle.front, round(entered.value, 1)))
    if len(figure.keys) > 1:
        imgui.begin_disabled(key is None)
        changed, keyed = imgui.checkbox("From this key on", is_keyed)
        imgui.end_disabled()
        tip("The depth holds from this key until another one says otherwise")
        if changed:
            kept = front if keyed else None
            actions.append(
                do(editing.edit_figure, layer_commands.key_front, frame, handle.id, kept)
            )
        if key is None:
            small(look, "Go to a key to let the depth change there.")
    imgui.end_group()
    # The drawing is tinted as long as the pointer is at these settings.
    is_pointed = imgui.is_item_hovered(imgui.HoveredFlags_.rect_only) and imgui.is_window_hovered(
        imgui.HoveredFlags_.allow_when_blocked_by_active_item
    )
    if is_pointed != session.tints_depth:
        actions.append(do(layering.tint_depth, is_pointed))
    return actions


def _set(handle: Handle, front: float, extent: float | None) -> Action:
    return do(editing.edit_figure, layer_commands.set_front, handle.id, front, extent)
