"""What an action is that has a name."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass

from app.editor import Action, Project, Session
from app.ui.shortcuts.keys import IS_MAC, format_chord, parse_chords

Test = Callable[[Session, Project], object]  # passed where it returns what counts as true


@dataclass(frozen=True, slots=True, eq=False)
class ActionSpec:
    """Something that can be done, and all ways that lead to it."""

    label: str  # in menus and in the sheet of keys
    action: Action
    keys: str = ""  # chords of keys, parted by commas; any of them does it
    _: KW_ONLY
    has_separator: bool = False  # whether a line parts it from the entry above in its menu
    mac_keys: str = ""  # in their place on macOS, where the system has them for itself
    key_text: str = ""  # its keys in words, where they are not pressed as such
    icon: str = ""
    hint: str = ""  # tooltip; the label where it is empty
    # Whether it can be done only with an open project. Without one, `detail` and `possible` are not
    # asked.
    needs_project: bool = True
    # What it would do now, in words that follow the label in its menu.
    detail: Callable[[Session, Project], str] | None = None
    condition: Test | None = None  # whether it can be done now; always where there is none
    # Why it cannot be done now, in a sentence; empty where it can. In place of `possible`.
    explain_disabled: Callable[[Session, Project], str] | None = None
    active: Callable[[Session], object] | None = None  # whether what it switches is on
    repeats_while_held: bool = False  # whether it is done again while the key is held

    def chords(self, *, is_mac: bool = IS_MAC) -> tuple[int, ...]:
        """Return the key chords that do it on this system, or on another one."""
        return parse_chords((is_mac and self.mac_keys) or self.keys)

    @property
    def shown_keys(self) -> str:
        """The first of the keys, as menus show it."""
        return format_chord(self.chords()[0]) if self.keys else self.key_text

    def menu_title(self, session: Session) -> str:
        """Return the text of its menu entry now; its id is the label."""
        project = session.project
        detail = self.detail(session, project) if self.detail and project else ""
        return f"{self.label} {detail}###{self.label}" if detail else self.label

    def is_possible(self, session: Session) -> bool:
        """Tell whether it can be done now."""
        if session.project is None:
            return not self.needs_project
        if self.explain_disabled is not None:
            return not self.explain_disabled(session, session.project)
        return self.condition is None or bool(self.condition(session, session.project))

    def disabled_reason(self, session: Session) -> str:
        """Return in a sentence why it cannot be done now; empty where it can, or nothing says."""
        project = session.project
        return (
            ""
            if project is None or self.explain_disabled is None
            else self.explain_disabled(session, project)
        )

    def is_active(self, session: Session) -> bool:
        """Tell whether what it switches is on, also where it cannot be switched now."""
        return bool(self.active and self.active(session))
