"""Taps of one key that wait for the same frame.

Dear ImGui takes one press of a key every second frame. A remote desktop sends a held key as taps.
Where frames are slow, the taps of one second would go on for many seconds.
"""

from collections import deque

from imgui_bundle import imgui

Key = imgui.Key
# Keys that step, and type nothing.
COUNTED = (
    *(Key.left_arrow, Key.right_arrow, Key.up_arrow, Key.down_arrow),
    *(Key.page_up, Key.page_down),
)


class TapCounter:
    """Counts taps of a key, and drops all but the first while it waits for its frame.

    Attributes
    ----------
    is_on : bool
        Whether shortcuts have the keys, and not a text field, a menu or a dialog.
    is_waiting : bool
        Whether `read_frame` is due.
    """

    def __init__(self) -> None:
        self.is_on = self.is_waiting = False
        # Taps for each press that waits, the oldest first.
        self._waiting: dict[Key, deque[int]] = {key: deque() for key in COUNTED}
        # The last released key, and the number of waiting events with its release.
        self._released: tuple[Key, int] | None = None
        self._dropped: Key | None = None  # the key whose release is dropped, too
        self._times: dict[Key, int] = {}

    def drops(self, key: Key, *, is_down: bool, waiting: int) -> bool:
        """Count an event of a key, and return whether Dear ImGui must not get it.

        `waiting` events wait before this one.
        """
        if is_down and self.is_on and self._released == (key, waiting):
            self._waiting[key][-1] += 1
            self._dropped = key
            return True
        if not is_down and self._dropped == key:
            self._dropped = None
            return True
        self._released = None
        if is_down and key in self._waiting:
            self._waiting[key].append(1)
            self.is_waiting = True
        elif self._waiting.get(key):
            self._released = key, waiting + 1
        return False

    def read_frame(self) -> None:
        """Read how many taps each press of this frame stands for, and of none the frame after.

        A press whose frame has come gets no further taps.
        """
        self._times, self._released = {}, None
        for key, counts in self._waiting.items():
            if counts and imgui.is_key_pressed(key, repeat=False):
                self._times[key] = counts.popleft()
        self.is_waiting = bool(self._times) or any(self._waiting.values())

    def times(self, key: int) -> int:
        """Return how many taps the press of a key stands for in this frame."""
        return self._times.get(Key(key), 1)
