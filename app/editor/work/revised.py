"""Objects that count their changes, so that nobody has to look for changes."""

from typing import Any

# Values of these types are compared; other values change if the object is another one.
COMPARED = (bool, int, float, complex, str, tuple, frozenset)


class Revised:
    """Counts each change of an attribute in `revision`; setting an equal value is no change."""

    __slots__ = ()
    revision: int

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
