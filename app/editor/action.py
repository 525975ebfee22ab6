"""An action as a value: a verb and what it is done with."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Concatenate, ParamSpec, TypeVar

P = ParamSpec("P")
State = TypeVar("State")


@dataclass(frozen=True, slots=True)
class Action:
    """Something that the person asked for."""

    # A function of `app.editor.actions` whose first parameter is the session.
    verb: Callable[..., None]
    arguments: tuple[Any, ...] = ()  # the others
    keywords: tuple[tuple[str, Any], ...] = ()  # those that are given by name

    @property
    def name(self) -> str:
        """What it does, and not what with; an action that it leads to is named, too."""
        module = getattr(self.verb, "__module__", "").rpartition(".")[2]
        verb = getattr(self.verb, "__qualname__", type(self.verb).__name__)
        then = [each.name for each in self.arguments if isinstance(each, Action)]
        return " → ".join([f"{module}.{verb}", *then])

    def apply(self, session: object) -> None:
        """Do it."""
        self.verb(session, *self.arguments, **dict(self.keywords))


def do(
    verb: Callable[Concatenate[State, P], None], *arguments: P.args, **keywords: P.kwargs
) -> Action:
    """Return the action of a verb; its arguments are checked like those of a call."""
    return Action(verb, arguments, tuple(keywords.items()))
