"""Pending changes of the document, and actions that wait for them."""

from dataclasses import dataclass
from math import inf

from app.editor.action import Action
from app.editor.work.motion_setup import MotionJob
from app.solving import KeyResolver


@dataclass(slots=True, kw_only=True, eq=False)
class PendingChange:
    """A pending result of the worker."""

    label: str  # shown in the status bar
    changes: bool = True  # whether it changes the document; a save does not
    key_resolver: KeyResolver | None = None  # keys that are solved again, with progress
    motion_job: MotionJob | None = None  # a pending motion, with progress


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class DeferredAction:
    """An action that runs as soon as no change is pending."""

    then: Action
    what: str  # the label: "Save", "Close"
    after_saves: bool = False  # whether it also waits for a running save
    # Seconds of the clock at which it runs even if changes are pending: an endless worker must
    # delay neither saving nor closing.
    until: float = inf
    position: int | None = None  # of the history at the request; None if it changes nothing
