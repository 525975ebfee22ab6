"""What is on its way to the document, and what is to be done once it is there."""

from dataclasses import dataclass
from math import inf

from app.editor.action import Action
from app.solving import Renewal


@dataclass(slots=True, kw_only=True, eq=False)
class Promise:
    """A result of the worker that is on its way.

    Parameters
    ----------
    label : str
        What comes, in words that the status bar can show.
    changes : bool
        Whether it changes the document when it comes; a save does not.
    renewal : Renewal, optional
        Keys that are being solved again, and how far that is.
    """

    label: str
    changes: bool = True
    renewal: Renewal | None = None


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Afterwards:
    """What was asked for, and is done as soon as nothing is on its way any more.

    Parameters
    ----------
    then : Action
    what : str
        The same in words: "Save", "Close".
    after_saves : bool
        Whether it also waits for a save that is under way.
    until : float
        The clock's seconds when it is done whatever is still on its way: a worker that never ends
        is to delay neither saving nor closing.
    """

    then: Action
    what: str
    after_saves: bool = False
    until: float = inf
