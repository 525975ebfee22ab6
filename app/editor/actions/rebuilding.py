"""Other bounds and another domain: the worker solves the keys again, one job for each."""

from dataclasses import replace

from app.document import figure_commands, loosened
from app.editor.actions import editing, posing
from app.editor.failures import report, sentence
from app.editor.jobs import Job
from app.editor.project import Project
from app.editor.session import Session
from app.solving import Renewal, go_on
from engine.maps import Bounds

RENEWING = "Solving the keys"


def draft_bounds(session: Session, bounds: Bounds) -> None:
    """Try bounds while their knob is dragged; nothing is solved yet."""
    if session.project:
        session.project.drafted_bounds = bounds


def choose_bounds(session: Session, bounds: Bounds) -> None:
    """Set the bounds; keys that are outside of them are solved again."""
    project = session.project
    if project is None:
        return
    project.drafted_bounds = None
    certificates = [pose.certificate for pose in project.figure.poses]
    if all(bounds.allow(k=c.k, sigma_a=c.sigma_a, sigma_b=c.sigma_b) for c in certificates):
        cancel(session)
        editing.edit_figure(session, figure_commands.set_bounds, bounds)
    elif bounds != project.figure.bounds:
        _begin(session, Renewal(before=project.figure, bounds=bounds, pulls=False))


def loosen(session: Session) -> None:
    """Allow the next looser stretch, and pull the pose that is shown to its targets again."""
    project = session.project
    bounds = loosened(project.figure.bounds) if project else None
    if project is None or bounds is None:
        return
    cancel(session)
    posing.drop(session)
    gesture = object()
    # What was allowed still is, so that no key has to be solved again.
    project.history.do(figure_commands.set_bounds(project.active, bounds), gesture=gesture)
    posing.pull_again(session, gesture=gesture)


def enter_bound(session: Session, bounds: Bounds, name: str, value: float) -> None:
    """Set one of the bounds to a number that was typed in.

    Raises
    ------
    EngineError
        If it bounds nothing, or everything.
    """
    choose_bounds(session, replace(bounds, **{name: value}))


def solve_again(session: Session) -> None:
    """Pull every key's handles to their places again, within the bounds of now."""
    if session.project:
        figure = session.project.figure
        _begin(session, Renewal(before=figure, bounds=figure.bounds))


def rebuild(session: Session) -> None:
    """Find the outline and build the mesh again; handles stay, keys are solved again."""
    project = session.project
    if project:
        figure = project.figure
        meshing = project.meshing or figure.meshing
        _begin(session, Renewal(before=figure, bounds=figure.bounds, meshing=meshing))


def cancel(session: Session) -> None:
    """Give up what is being solved or rebuilt."""
    session.jobs.drop(RENEWING)
    if session.project:
        session.project.renewal = None


def _begin(session: Session, renewal: Renewal) -> None:
    posing.drop(session)
    if session.project:
        _go_on(session, session.project, renewal)


def _go_on(session: Session, project: Project, renewal: Renewal) -> None:
    if session.project is not project:
        return
    if renewal.before not in project.document.figures:
        project.renewal = None
        session.tell("The keys were not posed again: the project changed meanwhile. Start again.")
        return
    if renewal.is_over:
        _accept(session, project, renewal)
        return
    project.renewal = renewal
    picture = project.puppets[renewal.before.id].picture.rgba

    def failed(error: Exception) -> None:
        project.renewal = None
        builds = renewal.meshing is not None
        report(session, f"The {'mesh was' if builds else 'limits were'} not changed", error)

    session.jobs.put(
        Job(
            kind=RENEWING,
            work=lambda: go_on(renewal, picture),
            done=lambda further: _go_on(session, project, further),
            failed=failed,
        )
    )


def _accept(session: Session, project: Project, renewal: Renewal) -> None:
    project.renewal = None
    gesture = object()
    project.history.do(renewal.command, gesture=gesture)
    if renewal.domain is not None:
        project.history.pose(None, gesture=gesture)
        project.meshing = None
    for notice in renewal.notices:
        session.tell(sentence(notice))
    if renewal.outside:
        poses = "pose" if len(renewal.outside) == 1 else "poses"
        session.tell(
            f"The {poses} {', '.join(renewal.outside)} could not be brought within the limits. "
            "Move the handles there nearer to the drawing, or undo.",
            tone="error",
        )
