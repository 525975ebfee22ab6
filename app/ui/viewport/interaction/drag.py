"""The active gesture in the viewport: its overlays, and its steps."""

from imgui_bundle import imgui

from app.editor import Action, Session, do
from app.editor.tools import tool_pointer
from app.editor.tools.numeric_entry import ERASE
from app.ui.style.theme import Look
from app.ui.viewport.interaction.shapes import draw_shapes
from app.ui.viewport.screen import ScreenMapping

DIGITS = "0123456789.,-"
AXES = ((imgui.Key.x, "x"), (imgui.Key.y, "y"))


def follow_pointer(session: Session, look: Look, screen: ScreenMapping) -> list[Action]:
    """Continue the gesture at the pointer. End it when the button is released."""
    gesture = session.tools.active_tool
    if gesture is None:
        return []
    if imgui.is_key_pressed(imgui.Key.escape) or imgui.is_mouse_clicked(imgui.MouseButton_.right):
        return [do(tool_pointer.cancel_tool)]
    draw_shapes(look, screen, gesture.shapes(screen.pointer, look.em / screen.scale))
    io, pointer = imgui.get_io(), screen.pointer
    actions: list[Action] = []
    snaps = io.key_ctrl or (gesture.snaps_by_shift and io.key_shift)
    # A Ctrl released after Ctrl+Z must not drag again if the tool takes no steps.
    is_stepped = gesture.snaps and snaps != session.tools.is_snapping
    # A recording continues while the pointer rests.
    is_recorded = (
        screen.project.timeline.recording is not None
        and not screen.project.timeline.recording.is_over
    )
    if io.mouse_delta.x or io.mouse_delta.y or is_stepped or is_recorded:
        move = tool_pointer.move_pointer_in_steps if snaps else tool_pointer.move_pointer
        actions.append(do(move, pointer))
    characters = _typed()
    if characters:
        actions.append(do(tool_pointer.type_in_tool, characters))
    is_entered = any(map(imgui.is_key_pressed, (imgui.Key.enter, imgui.Key.keypad_enter)))
    if is_entered or not imgui.is_mouse_down(imgui.MouseButton_.left):
        end = tool_pointer.release_pointer_forced if io.key_alt else tool_pointer.release_pointer
        actions.append(do(end, pointer))
    return actions


def _typed() -> str:
    """Return the text typed for a drag in this frame, in order."""
    characters = [chr(code) for code in imgui.get_io().input_queue_characters]
    text = "".join(character for character in characters if character in DIGITS)
    # By keys, because characters repeat while a key is held, which would release the axis again.
    text += "".join(axis for key, axis in AXES if imgui.is_key_pressed(key, repeat=False))
    return text + (ERASE if imgui.is_key_pressed(imgui.Key.backspace) else "")
