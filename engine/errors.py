"""The error of the engine's callers, and notices for the person."""

from collections.abc import Mapping
from dataclasses import dataclass, field


class EngineError(ValueError):
    """An input that the engine cannot use.

    The message is one or two sentences for the person at the screen: the fault, the offending
    value, and the remedy. Its template and values are kept apart, so that a program can translate
    it. An expected numerical outcome, such as a reached bound, is a status instead. A solver that
    ends unfinished raises this error unless `throw` is False.
    """

    def __init__(self, template: str, /, **values: object) -> None:
        super().__init__(template.format(**values) if values else template)
        self.template, self.values = template, values


@dataclass(frozen=True, slots=True)
class Message:
    """A sentence for the person: a template and the values in it; `str` gives it in English.

    If there is a `plural`, it is the template for each `count` among the values but 1.
    """

    template: str
    values: Mapping[str, object] = field(default_factory=dict)
    plural: str = ""

    def __str__(self) -> str:
        template = self.plural if self.plural and self.values["count"] != 1 else self.template
        return template.format(**self.values) if self.values else template


def count_message(one: str, many: str, /, count: int, **values: object) -> Message:
    """Return the message about one thing or many."""
    return Message(one, {"count": count, **values}, many)
