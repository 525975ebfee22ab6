"""Objects that count their changes, so that nobody has to look for changes."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from operator import attrgetter
from typing import Any

# Values of these types are compared; other values change if the object is another one.
COMPARED = (bool, int, float, complex, str, tuple, frozenset)


@dataclass(slots=True, kw_only=True, eq=False)
class Revised:
    """Counts each change of an attribute in `revision`; setting an equal value is no change."""

    revision: int = field(init=False, default=0, repr=False)

    def __setattr__(self, name: str, value: Any) -> None:
        old = getattr(self, name, None)
        if old is value:
            # Also the first value of an attribute, if it is None.
            object.__setattr__(self, name, value)
            return
        is_equal = isinstance(value, COMPARED) and type(old) is type(value) and old == value
        object.__setattr__(self, name, value)
        if not is_equal and name != "revision":
            object.__setattr__(self, "revision", getattr(self, "revision", 0) + 1)


def revision_getter(whole: type[Revised], *others: str) -> Callable[[Any], tuple[int, ...]]:
    """Return a quick function that returns the revisions of an object and of its parts.

    `others` are attributes with a revision of their own.
    """
    parts = [
        each.name
        for each in fields(whole)
        if isinstance(each.type, type) and issubclass(each.type, Revised)
    ]
    return attrgetter("revision", *[f"{name}.revision" for name in (*parts, *others)])
