"""A named action."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass

from app.editor import Action, Project, Session
from app.ui.shortcuts.keys import IS_MAC, format_chord, parse_chords

Test = Callable[[Session, Project], object]  # true by the truth value of its result


@dataclass(frozen=True, slots=True, eq=False)
class ActionSpec:
    """A named action, with its menu entry, keys, icon and condition."""

    label: str  # in menus and in the sheet of shortcuts
    action: Action
    keys: str = ""  # key chords, separated by commas; each of them runs the action
    _: KW_ONLY
    has_separator: bool = False  # whether its menu has a separator above the entry
    mac_keys: str = ""  # replaces `keys` on macOS, where the system reserves them
    key_text: str = ""  # text for the menu where the action has no key chord
    icon: str = ""
    hint: str = ""  # tooltip; if empty, the label
    # Whether the action needs an open project. Without a project, `detail` and `condition` are not
    # called.
    needs_project: bool = True
    # The text of the menu entry with the present effect of the action; empty: the label.
    detail: Callable[[Session, Project], str] | None = None
    condition: Test | None = None  # whether the action is possible now; None: always
    # A sentence why the action is disabled now; empty if it is possible. It replaces `condition`.
    explain_disabled: Callable[[Session, Project], str] | None = None
    active: Callable[[Session], object] | None = None  # whether its option is on
    repeats_while_held: bool = False  # whether the action repeats while its key is held

    def chords(self, *, is_mac: bool = IS_MAC) -> tuple[int, ...]:
        """The key chords of the action on this system, or on the given one."""
        return parse_chords((is_mac and self.mac_keys) or self.keys)

    @property
    def shown_keys(self) -> str:
        """The first key chord, as menus show it."""
        return format_chord(self.chords()[0]) if self.keys else self.key_text

    def menu_title(self, session: Session) -> str:
        """The text of the menu entry now. Its ImGui id is the label."""
        project = session.project
        detail = self.detail(session, project) if self.detail and project else ""
        return f"{detail}###{self.label}" if detail else self.label

    def is_possible(self, session: Session) -> bool:
        if session.project is None:
            return not self.needs_project
        if self.explain_disabled is not None:
            return not self.explain_disabled(session, session.project)
        return self.condition is None or bool(self.condition(session, session.project))

    def disabled_reason(self, session: Session) -> str:
        """Why the action is disabled now, in a sentence. Empty if it is possible, or by default."""
        project = session.project
        return (
            ""
            if project is None or self.explain_disabled is None
            else self.explain_disabled(session, project)
        )

    def is_active(self, session: Session) -> bool:
        """Return whether the switched option is on, even if the action is disabled now."""
        return bool(self.active and self.active(session))
