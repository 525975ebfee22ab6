"""Diagnostics: what a problem report says about the session."""

from dataclasses import dataclass, field

from app.editor.work.revised import Revised

MOST_NOTED = 40  # most logged actions
TIMES = " × "  # between an action's name and its number of repetitions


@dataclass(slots=True, kw_only=True, eq=False)
class Diagnostics(Revised):
    """The graphics driver, the last actions and errors, and the solver's speed."""

    graphics: str = ""  # graphics driver; empty before the first frame
    logged_actions: list[str] = field(default_factory=list)  # names of the last actions
    last_error_trace: str = ""  # of the last unexpected error
    reported_failures: set[str] = field(default_factory=set)  # repeated failures that were reported
    solver_seconds: float = 0.0  # of the last steps of a drag

    def log_action(self, name: str) -> None:
        """Log an action's name without its arguments."""
        last, _, times = (self.logged_actions or [""])[-1].partition(TIMES)
        if name == last:
            self.logged_actions[-1] = f"{last}{TIMES}{int(times or 1) + 1}"
        else:
            self.logged_actions.append(name)
            del self.logged_actions[:-MOST_NOTED]

    def note_graphics(self, driver: str) -> None:
        self.graphics = driver

    def note_error(self, trace: str) -> None:
        self.last_error_trace = trace

    def note_failure(self, *what: str) -> bool:
        """Note failures of repeated attempts, and return whether one of them is new."""
        is_new = not self.reported_failures.issuperset(what)
        self.reported_failures.update(what)
        return is_new

    def note_success(self, what: str) -> None:
        """Note that a repeated attempt has succeeded."""
        self.reported_failures.discard(what)

    def note_solver_time(self, seconds: float) -> None:
        self.solver_seconds = seconds
