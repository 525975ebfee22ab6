"""Solving all keys again, over other bounds or another domain."""

from app.actions import posing
from app.actions.failures import report
from app.document import settings_commands
from app.document.keyframe import Pose
from app.document.model import Document
from app.document.settings import Meshing
from app.jobs import Job
from app.rebuild import Rebuilt, rebuild_domain, solve_keys
from app.session import Project, Session

SOLVING, REBUILDING = "Solving the keys", "Rebuilding the domain"


def solve_again(session: Session) -> None:
    """Pull every key to its handles' places again, within the bounds of now."""
    project = session.project
    if project is None:
        return
    posing.drop(session)
    document = project.document
    session.jobs.put(
        Job(
            kind=SOLVING,
            work=lambda: solve_keys(document),
            done=lambda poses: _keep_poses(session, project, document, poses),
            failed=lambda error: report(session, "The keys could not be solved", error),
        )
    )


def rebuild(session: Session, meshing: Meshing) -> None:
    """Find the outline and build the mesh again; handles stay, keys are solved again."""
    project = session.project
    if project is None:
        return
    posing.drop(session)
    document, picture = project.document, project.picture.rgba
    session.jobs.put(
        Job(
            kind=REBUILDING,
            work=lambda: rebuild_domain(document, picture, meshing),
            done=lambda built: _keep_domain(session, project, document, meshing, built),
            failed=lambda error: report(session, "The domain could not be rebuilt", error),
        )
    )


def cancel(session: Session) -> None:
    """Give up what is being solved or rebuilt."""
    session.jobs.drop(SOLVING)
    session.jobs.drop(REBUILDING)


def _keep_poses(
    session: Session, project: Project, document: Document, poses: tuple[Pose, ...]
) -> None:
    if project.document is not document:
        session.tell("The keys changed meanwhile, so they were not solved again.")
        return
    project.history.do(settings_commands.set_bounds(document.bounds, poses))


def _keep_domain(
    session: Session, project: Project, document: Document, meshing: Meshing, built: Rebuilt
) -> None:
    if project.document is not document:
        session.tell("The project changed meanwhile, so its domain was not rebuilt.")
        return
    project.history.do(settings_commands.replace_domain(built.domain, meshing, built.poses))
    project.loose = None
    for notice in built.notices:
        session.tell(notice[:1].upper() + notice[1:] + ".")
