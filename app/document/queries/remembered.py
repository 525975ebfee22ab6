"""What was found out about a figure, kept as long as the figure is there."""

from collections.abc import Callable
from functools import wraps
from typing import Final, TypeVar, TypeVarTuple
from weakref import WeakKeyDictionary

from app.document.figure import Figure

Given = TypeVarTuple("Given")
T = TypeVar("T")
MOST: Final = 16  # answers about a figure


def remembered(query: Callable[[Figure, *Given], T]) -> Callable[[Figure, *Given], T]:
    """Let a query give the last answers again; none of them may hold the figure.

    However many figures there are, none makes others be asked about anew, and those of a project
    that was closed go with it.
    """
    known: WeakKeyDictionary[Figure, dict[object, T]] = WeakKeyDictionary()

    @wraps(query)
    def answer(figure: Figure, *given: *Given) -> T:
        # Workers ask, too: another thread may clear the answers at any moment.
        answers = known.setdefault(figure, {})
        found = answers.get(given)
        if found is None:
            found = query(figure, *given)
            if len(answers) >= MOST:
                answers.clear()
            answers[given] = found
        return found

    return answer
