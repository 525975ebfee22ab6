"""What is on its way to the document, and what is to be done once it is there."""

from dataclasses import dataclass
from math import inf

from app.editor.action import Action
from app.editor.work.motion_setup import MotionJob
from app.solving import KeyResolver


@dataclass(slots=True, kw_only=True, eq=False)
class Promise:
    """A result of the worker that is on its way."""

    label: str  # what comes, in words that the status bar can show
    changes: bool = True  # whether it changes the document when it comes; a save does not
    key_resolver: KeyResolver | None = None  # keys that are being solved again, and how far that is
    motion_job: MotionJob | None = None  # a motion on its way, and how far that is


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Afterwards:
    """What was asked for, and is done as soon as nothing is on its way any more."""

    then: Action
    what: str  # the same in words: "Save", "Close"
    after_saves: bool = False  # whether it also waits for a save that is under way
    # The clock's seconds when it is done whatever is still on its way: a worker that never ends is
    # to delay neither saving nor closing.
    until: float = inf
    position: int | None = None  # of the history when that was asked; None if it changes nothing
