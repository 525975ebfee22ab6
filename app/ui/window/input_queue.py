"""Input in the order in which it came: what one picture may know of it, and what the next one.

Dear ImGui lets a picture know of a move and of the press after it at once. But tabs, and whatever
lies over something else, take a press only where a picture before it has shown the pointer on them:
a tap of a pen, which comes in the same moment as its place, would be nobody's.
"""

from imgui_bundle import hello_imgui, imgui

Event = imgui.internal.InputEventType


class InputQueue:
    """Holds back what is for the next picture, while Dear ImGui takes what is for this one.

    Attributes
    ----------
    are_left : bool
        Whether there is input that this picture does not know of.
    """

    def __init__(self) -> None:
        self._all = imgui.ImVector_InputEvent()
        self._due = 0
        self.has_pending = False

    def hold_events(self) -> None:
        """Take from the events that wait those that are not for this picture."""
        queue = imgui.get_current_context().input_events_queue
        self._all, self._due = imgui.ImVector_InputEvent(queue), _due(queue)
        while queue.size() > self._due:
            queue.pop_back()

    def release_events(self) -> None:
        """Let them wait behind what Dear ImGui has left; the next picture comes at once."""
        queue = imgui.get_current_context().input_events_queue
        for number in range(self._due, self._all.size()):
            queue.push_back(self._all[number])
        self._due = self._all.size()
        self.has_pending = bool(queue.size())
        if self.has_pending:
            hello_imgui.request_refresh()


def _due(events: imgui.ImVector_InputEvent) -> int:
    """Return how many of some events are for one picture.

    A press waits until the pointer has been seen at its place. While Ctrl, Shift or Alt is held,
    keys come one by one: let go in the same moment, it would be missing from the chord before.
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
