"""The names of imported layers and groups: unique, and short enough to show."""

from collections.abc import Iterable
from dataclasses import replace

from app.document import MAX_GROUP_DEPTH, Group, ancestor_paths
from app.errors import LissomError, display_name, shortened
from app.texts import N_, _

MOST_GROUPS = 10_000
GROUPS_DEEP = N_("its groups are nested more than {most} deep; move some groups out")
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


class GroupPaths:
    """The groups of an imported drawing, each with a unique path."""

    def __init__(self) -> None:
        self._names = UniqueNames()
        self._found: dict[str, Group] = {}

    def add(self, around: str, group: Group) -> str:
        """Add a group inside the group with the path `around`; return its path.

        Raises `LissomError` if the nesting is too deep, there are too many groups, or the name is
        too long.
        """
        if around.count("/") + bool(around) >= MAX_GROUP_DEPTH:
            raise LissomError(_(GROUPS_DEEP).format(most=MAX_GROUP_DEPTH))
        if len(self._found) == MOST_GROUPS:
            raise LissomError(
                _(
                    "it has too many groups; Lissom reads at most {most:,}. Merge some of them"
                ).format(most=MOST_GROUPS)
            )
        # A slash separates groups.
        name = display_name(group.name).replace("/", "-").strip() or "group"
        check_name_length(name)
        path = self._names.claim(f"{around}/{name}" if around else name)
        self._found[path] = replace(group, name=path)
        return path

    def is_clipped(self, path: str) -> bool:
        """Return whether a group is clipped by the content below it."""
        return self._found[path].clipped

    def groups_around(self, paths: Iterable[str]) -> tuple[Group, ...]:
        """Return the groups with these paths, and the groups around them."""
        filled = {around for path in paths for around in ancestor_paths(path)}
        return tuple(group for path, group in self._found.items() if path in filled)
