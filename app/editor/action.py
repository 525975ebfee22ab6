"""An action as a value: a verb and its arguments."""

from collections.abc import Callable
from dataclasses import dataclass
from inspect import unwrap
from typing import Any, Concatenate, ParamSpec, TypeVar

P = ParamSpec("P")
State = TypeVar("State")


@dataclass(frozen=True, slots=True)
class Action:
    """A request of the person."""

    # A function of `app.editor.actions` whose first parameter is the session.
    verb: Callable[..., None]
    arguments: tuple[Any, ...] = ()  # the other arguments
    keywords: tuple[tuple[str, Any], ...] = ()  # keyword arguments
    is_by_key: bool = False  # whether a key asks for it, and not a widget

    @property
    def name(self) -> str:
        """The verb's name without its arguments, and the name of an action among them."""
        function = unwrap(self.verb)
        module = getattr(function, "__module__", "").rpartition(".")[2]
        verb = getattr(function, "__qualname__", type(function).__name__)
        then = [each.name for each in self.arguments if isinstance(each, Action)]
        return " → ".join([f"{module}.{verb}", *then])

    def apply(self, session: object) -> None:
        self.verb(session, *self.arguments, **dict(self.keywords))


def do(
    verb: Callable[Concatenate[State, P], None], *arguments: P.args, **keywords: P.kwargs
) -> Action:
    """Return the action of a verb; arguments are type-checked like those of a call."""
    return Action(verb, arguments, tuple(keywords.items()))
