"""What an action is that has a name."""

from collections.abc import Callable
from dataclasses import dataclass

from app.editor import Action, Session
from app.ui.shortcuts.keys import IS_MAC, in_words

Test = Callable[[Session], bool]


def always(_: Session) -> bool:
    """Tell that something can be done at any time."""
    return True


def with_project(session: Session) -> bool:
    """Tell whether a project is open."""
    return session.project is not None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Binding:
    """Something that can be done, and all ways that lead to it.

    Parameters
    ----------
    label : str
        In menus and in the sheet of keys.
    action : Action
    menu : str
        In which it is an entry, and under which the sheet lists it.
    parted : bool
        Whether a line parts it from the entry above.
    in_bar : bool
        Whether it is a button of the icon bar as well.
    keys : tuple of int
        ImGui's key chords; any of them does it.
    mac_keys : tuple of int
        In their place on macOS, where the system has them for itself.
    told : str
        Its keys in words, where they are not pressed as such.
    icon : str
    hint : str
        Tooltip; the label where it is empty.
    detail : callable
        What it would do now, in words that follow the label in its menu.
    possible : callable
        Whether it can be done now.
    active : callable
        Whether what it switches is on.
    repeats : bool
        Whether it is done again while the key is held.
    """

    label: str
    action: Action
    menu: str
    parted: bool = False
    in_bar: bool = False
    keys: tuple[int, ...] = ()
    mac_keys: tuple[int, ...] = ()
    told: str = ""
    icon: str = ""
    hint: str = ""
    detail: Callable[[Session], str | None] | None = None
    possible: Test = with_project
    active: Test | None = None
    repeats: bool = False

    def chords(self, *, is_mac: bool = IS_MAC) -> tuple[int, ...]:
        """Return the key chords that do it on this system, or on another one."""
        return (is_mac and self.mac_keys) or self.keys

    @property
    def keys_in_words(self) -> str:
        """The first of the keys, as menus show it."""
        return in_words(self.chords()[0]) if self.keys else self.told

    def title(self, session: Session) -> str:
        """Return the text of its menu entry now; its id is the label."""
        detail = self.detail(session) if self.detail is not None else None
        return f"{self.label} “{detail}”###{self.label}" if detail else self.label

    def is_active(self, session: Session) -> bool:
        """Tell whether what it switches is on."""
        return self.active is not None and self.active(session)
