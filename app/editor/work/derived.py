"""Values derived on the worker, with their source and their failure."""

from dataclasses import dataclass, field
from typing import Generic, TypeVar

Source = TypeVar("Source")
Value = TypeVar("Value")


@dataclass(slots=True, eq=False)
class Derived(Generic[Source, Value]):
    """A value derived from a source; the old value stays while a new one is computed."""

    value: Value
    source: Source | None = None  # source of the value; None before the first value
    failure: Source | None = None  # source without a value; it is not tried again
    begun: tuple[Source, Value] | None = None  # a source and its partial value
    # Number of earlier values to keep, in case their sources return, for example by undo.
    remembers: int = 0
    # Earlier values with their sources, the newest last.
    earlier: list[tuple[Source, Value]] = field(default_factory=list)

    def follows(self, source: Source) -> bool:
        """Return whether the value is derived from this source."""
        return self.source is not None and self.source == source

    def has_failed(self, source: Source) -> bool:
        """Return whether this source is known to have no value."""
        return self.failure is not None and self.failure == source

    def fail(self, source: Source) -> None:
        """Note that a source has no value."""
        self.failure = source

    def set(self, source: Source, value: Value) -> None:
        if self.remembers and self.source is not None:
            self.earlier = [*self.earlier, (self.source, self.value)][-self.remembers :]
        self.source, self.value, self.begun = source, value, None

    def recall(self, source: Source) -> None:
        """Restore the remembered value of a source, if there is one."""
        if self.follows(source):
            return
        for known, value in self.earlier:
            if known == source:
                self.set(source, value)
                return
