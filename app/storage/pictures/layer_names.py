"""The names of imported layers and groups: unique, and short enough to show."""

from app.errors import LissomError, shortened
from app.texts import _

LONGEST_NAME = 1_000  # characters of a layer's or group's name


class UniqueNames:
    """Gives out unique names: a taken name gets the next free number.

    The time per name does not depend on the number of equal names.
    """

    def __init__(self) -> None:
        self._taken: set[str] = set()
        self._next: dict[str, int] = {}

    def claim(self, name: str) -> str:
        """Take a name, with a number if it is taken, and return it."""
        free, number = name, self._next.get(name, 2)
        while free in self._taken:
            free, number = f"{name} {number}", number + 1
        self._next[name] = number
        self._taken.add(free)
        return free


def check_name_length(name: str) -> None:
    """Refuse a name that is too long for lists and messages; group paths repeat it."""
    if len(name) > LONGEST_NAME:
        raise LissomError(
            _(
                "the name {name!r} has {count:,} characters; Lissom reads at most "
                "{longest:,}. Shorten the name"
            ).format(name=shortened(name), count=len(name), longest=LONGEST_NAME)
        )
