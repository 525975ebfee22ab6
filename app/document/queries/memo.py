"""Memoized queries, with results kept as long as the layer or domain exists."""

from collections.abc import Callable
from functools import wraps
from typing import Final, TypeVar, TypeVarTuple
from weakref import WeakKeyDictionary

Given = TypeVarTuple("Given")
T = TypeVar("T")
Whose = TypeVar("Whose")
MOST: Final = 16  # results per layer or domain


def memoized_on(query: Callable[[Whose, *Given], T]) -> Callable[[Whose, *Given], T]:
    """Memoize a query about a layer or a domain; a result must not refer to the layer or domain.

    Each layer has its own results, so that many layers do not evict each other. The results of a
    closed project are freed.
    """
    known: WeakKeyDictionary[Whose, dict[object, T]] = WeakKeyDictionary()

    @wraps(query)
    def answer(whose: Whose, *given: *Given) -> T:
        # Workers call queries too, so another thread may clear the results at any moment.
        answers = known.setdefault(whose, {})
        found = answers.get(given)
        if found is None:
            found = query(whose, *given)
            if len(answers) >= MOST:
                answers.clear()
            answers[given] = found
        return found

    return answer
