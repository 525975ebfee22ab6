"""What was found out about a layer or a domain, kept as long as that is there."""

from collections.abc import Callable
from functools import wraps
from typing import Final, TypeVar, TypeVarTuple
from weakref import WeakKeyDictionary

Given = TypeVarTuple("Given")
T = TypeVar("T")
Whose = TypeVar("Whose")
MOST: Final = 16  # answers about one


def memoized_on(query: Callable[[Whose, *Given], T]) -> Callable[[Whose, *Given], T]:
    """Let a query about a layer or a domain give the last answers again; none may hold it.

    However many layers there are, none makes others be asked about anew, and those of a project
    that was closed go with it.
    """
    known: WeakKeyDictionary[Whose, dict[object, T]] = WeakKeyDictionary()

    @wraps(query)
    def answer(whose: Whose, *given: *Given) -> T:
        # Workers ask, too: another thread may clear the answers at any moment.
        answers = known.setdefault(whose, {})
        found = answers.get(given)
        if found is None:
            found = query(whose, *given)
            if len(answers) >= MOST:
                answers.clear()
            answers[given] = found
        return found

    return answer
