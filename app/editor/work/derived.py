"""Values that are worked out behind the scenes: what they follow from, and whether that failed."""

from dataclasses import dataclass, field
from typing import Generic, TypeVar

Source = TypeVar("Source")
Value = TypeVar("Value")


@dataclass(slots=True, eq=False)
class Derived(Generic[Source, Value]):
    """A value that follows a source; it stays while another one is on its way."""

    value: Value
    source: Source | None = None  # what it was derived from; None before the first one
    failure: Source | None = None  # what none could be derived from: that is not tried again
    begun: tuple[Source, Value] | None = None  # a source, and as much of its value as is worked out
    # How many earlier values are kept for when their sources come back, as by undo.
    remembers: int = 0
    # Those, with their sources, the newest last.
    earlier: list[tuple[Source, Value]] = field(default_factory=list)

    def follows(self, source: Source) -> bool:
        """Tell whether the value is that of a source."""
        return self.source is not None and self.source == source

    def has_failed(self, source: Source) -> bool:
        """Tell whether a source is known to give no value."""
        return self.failure is not None and self.failure == source

    def fail(self, source: Source) -> None:
        """Take note that there is no value of a source."""
        self.failure = source

    def set(self, source: Source, value: Value) -> None:
        """Hold the value of a source."""
        if self.remembers and self.source is not None:
            self.earlier = [*self.earlier, (self.source, self.value)][-self.remembers :]
        self.source, self.value, self.begun = source, value, None

    def recall(self, source: Source) -> None:
        """Hold the value of a source again, if it is remembered."""
        if self.follows(source):
            return
        for known, value in self.earlier:
            if known == source:
                self.set(source, value)
                return
