"""Named actions: verbs with everything that their menu entries, buttons and keys show."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Any, Concatenate, Generic, ParamSpec

from app.editor.action import Action
from app.editor.project import Project
from app.editor.session import Session
from app.texts import _

P = ParamSpec("P")
# Why an action is disabled now, in a sentence that says what to do; None if it is possible.
DisabledReason = Callable[[Session, Project], str | None]
NO_PROJECT = _("Open a drawing first.")


@dataclass(frozen=True, slots=True, eq=False)
class ActionSpec:
    """A named action, with its label, keys and icon, and the reason why it is disabled."""

    action: Action
    label: str  # unique; in menus, in the sheet of shortcuts and in the manual
    keys: str = ""  # key chords, separated by commas; each of them runs the action
    _: KW_ONLY
    mac_keys: str = ""  # replaces `keys` on macOS, where the system reserves them
    key_text: str = ""  # text for the menu where the action has no key chord
    icon: str = ""  # name of a Font Awesome icon
    hint: str = ""  # tooltip; if empty, the label
    # Whether the action needs an open project. Without a project, `detail` and `why_disabled` are
    # not called.
    needs_project: bool = True
    # The text of the menu entry with the present effect of the action; empty: the label.
    detail: Callable[[Session, Project], str] | None = None
    why_disabled: DisabledReason | None = None  # None: always possible
    active: Callable[[Session], object] | None = None  # whether its option is on
    repeats_while_held: bool = False  # whether the action repeats while its key is held

    def disabled_reason(self, session: Session) -> str | None:
        """Return why the action is disabled now, in a sentence; None if it is possible."""
        if session.project is None:
            return NO_PROJECT if self.needs_project else None
        return self.why_disabled and self.why_disabled(session, session.project)

    def menu_title(self, session: Session) -> str:
        """The text of the menu entry now. Its ImGui id is the label."""
        project = session.project
        detail = self.detail(session, project) if self.detail and project else ""
        return f"{detail}###{self.label}" if detail else self.label

    def is_active(self, session: Session) -> bool:
        """Return whether the switched option is on, even if the action is disabled now."""
        return bool(self.active and self.active(session))


class NamedVerb(ActionSpec, Generic[P]):
    """A verb that is an action by itself. A call runs the verb."""

    __slots__ = ()

    def __call__(self, session: Session, /, *args: P.args, **kwargs: P.kwargs) -> None:
        self.action.verb(session, *args, **kwargs)

    @property
    def __wrapped__(self) -> Callable[..., None]:
        return self.action.verb


def named_action(
    label: str, keys: str = "", **more: Any
) -> Callable[[Callable[Concatenate[Session, P], None]], NamedVerb[P]]:
    """Make a verb an action; `more` are further fields of `ActionSpec`."""
    return lambda verb: NamedVerb(Action(verb), label, keys, **more)


def unless(is_possible: Callable[[Session, Project], object], sentence: str) -> DisabledReason:
    """Return the reason that gives a sentence unless a condition holds."""
    return lambda session, project: None if is_possible(session, project) else sentence


UNLESS_HANDLES = unless(lambda _, project: project.selection.handles, _("Select a handle first."))
