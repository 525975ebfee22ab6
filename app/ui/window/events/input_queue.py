"""Input in its order: some events belong to this frame, the rest to the next frame.

Dear ImGui applies a move and the following press in one frame. But tabs and overlapping items
take a press only if an earlier frame had the pointer over them. A tap of a pen moves and presses
at the same moment, so it would hit nothing.

Events that wait become older while frames are slow. The time that they wait is no part of the time
between the two presses of a double click.
"""

from imgui_bundle import hello_imgui, imgui

Event = imgui.internal.InputEventType
DOUBLE_CLICK = 0.3  # seconds between the two presses


class InputQueue:
    """Holds back the events of the next frame while Dear ImGui takes those of this frame.

    Attributes
    ----------
    has_pending : bool
        Whether some input has not reached Dear ImGui yet.
    """

    def __init__(self) -> None:
        self._all = imgui.ImVector_InputEvent()
        self._due = 0
        self._waited = 0.0  # seconds that input has waited since the last press
        self.has_pending = False

    def hold_events(self) -> None:
        """Remove the events of the next frame from the queue."""
        self._allow_slow_double_click()
        queue = imgui.get_current_context().input_events_queue
        self._all, self._due = imgui.ImVector_InputEvent(queue), _due(queue)
        while queue.size() > self._due:
            queue.pop_back()

    def release_events(self) -> None:
        """Put the held events behind those that Dear ImGui left. Request the next frame at once."""
        queue = imgui.get_current_context().input_events_queue
        for number in range(self._due, self._all.size()):
            queue.push_back(self._all[number])
        self._due = self._all.size()
        self.has_pending = bool(queue.size())
        if self.has_pending:
            hello_imgui.request_refresh()
        if imgui.is_mouse_clicked(imgui.MouseButton_.left):
            self._waited = 0.0

    def _allow_slow_double_click(self) -> None:
        """Lengthen the time of a double click by the time for which its second press waited.

        The press came at any time during the last frame, and then waited for its own frame.
        """
        io = imgui.get_io()
        self._waited += io.delta_time * self.has_pending
        last = 0.0 if self.has_pending else io.delta_time
        io.mouse_double_click_time = DOUBLE_CLICK + self._waited + last
        # Dear ImGui wants it to be longer.
        io.mouse_single_click_delay = 2 * io.mouse_double_click_time


def _due(events: imgui.ImVector_InputEvent) -> int:
    """Return how many events belong to one frame.

    A press waits for the frame after the pointer arrived. While Ctrl, Shift or Alt is held, each
    key has its own frame. Otherwise a modifier released at the same moment would be lost.
    """
    io = imgui.get_io()
    is_down, has_moved, has_key = any(io.mouse_down), False, False
    for number in range(events.size()):
        kind = events[number].type
        if kind == Event.mouse_button and has_moved and not is_down:
            return number
        if kind == Event.key and has_key and io.key_mods:
            return number
        has_moved |= kind == Event.mouse_pos
        has_key |= kind == Event.key
    return int(events.size())
