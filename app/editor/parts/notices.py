"""Notices: messages that show for a while over the window."""

from collections.abc import Callable
from dataclasses import dataclass, field
from itertools import count
from typing import Literal

from app.editor.action import Action
from app.editor.work.revised import Revised
from app.errors import display_message, printable

Tone = Literal["info", "good", "error"]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Toast:
    """A message that shows for a while."""

    text: str
    tone: Tone
    born: float  # the clock's seconds
    place: int  # the lowest free number, since ImGui never frees a window
    topic: str = ""  # a later message of the same topic replaces it
    details: str = ""  # text that the person can copy
    label: str = ""  # label of the action's button, such as "Open folder"
    action: Action | None = None


@dataclass(slots=True, kw_only=True, eq=False)
class Notices(Revised):
    """The notices that are shown."""

    now: Callable[[], float]  # the clock
    toasts: list[Toast] = field(default_factory=list)

    def show(
        self,
        text: str,
        *,
        tone: Tone = "info",
        topic: str = "",
        details: str = "",
        label: str = "",
        action: Action | None = None,
    ) -> None:
        """Show a message; a message that is already shown starts its time again."""
        text, details = display_message(text), printable(details, keeps_lines=True)
        self.toasts = [
            toast
            for toast in self.toasts
            if toast.text != text and not (topic == toast.topic != "")
        ]
        taken = {toast.place for toast in self.toasts}
        toast = Toast(
            text=text,
            tone=tone,
            born=self.now(),
            place=next(place for place in count() if place not in taken),
            topic=topic,
            details=details,
            label=label,
            action=action,
        )
        self.toasts.append(toast)

    def dismiss(self, toast: Toast) -> None:
        self.toasts = [other for other in self.toasts if other is not toast]
