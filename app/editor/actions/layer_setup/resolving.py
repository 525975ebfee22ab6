"""New limits or a new domain: the worker solves the keys again, one job a key."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial

from app.document import Target, relax_limits, shape_commands
from app.editor import pending_changes
from app.editor.action import do
from app.editor.actions import editing
from app.editor.actions.layer_setup.layer_runtimes import update_layer_runtimes
from app.editor.actions.posing.pose_drag import solve_pose_again
from app.editor.error_reports import as_sentence, report_failure
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.jobs import JobKind
from app.editor.work.pending_change import PendingChange
from app.solving import KeyResolver, step_resolver
from app.texts import _, ngettext
from engine.maps import Bounds

SOLVING_KEYS = JobKind(_("Solving the keys"))
REST = 0.5  # seconds after which a brush counts as resting


@with_project
def preview_limits(_: Session, project: Project, bounds: Bounds) -> None:
    """Preview limits while their knob is dragged; nothing is solved yet."""
    project.layer_setup.preview_limits(bounds)


@with_project
def set_limits(session: Session, project: Project, bounds: Bounds) -> None:
    """Set the limits; keys that exceed them are solved again."""
    project.layer_setup.preview_limits(bounds)
    cancel_solving_keys(session)
    pending_changes.run_when_idle(session, do(_set_limits, bounds), _("Limits"))


@with_project
def _set_limits(session: Session, project: Project, bounds: Bounds) -> None:
    project.layer_setup.preview_limits(None)
    certificates = [pose.certificate for pose in project.layer.poses]
    if all(bounds.allow(k=c.k, sigma_a=c.sigma_a, sigma_b=c.sigma_b) for c in certificates):
        editing.edit_layer(session, shape_commands.set_limits, bounds)
    elif bounds != project.layer.bounds:
        begin_solving_keys(
            session, KeyResolver(before=project.layer, bounds=bounds, solves_all=False)
        )


@with_project
def relax_limits_and_solve(
    session: Session, project: Project, asked: Mapping[int, Target] | None = None
) -> None:
    """Allow the next larger stretch, and solve the shown pose for its targets again.

    `asked` holds targets that a drag could not reach. They are tried again.
    """
    bounds = relax_limits(project.layer.bounds)
    if bounds is None:
        return
    cancel_solving_keys(session)
    gesture = object()
    # The old limits lie within the new ones, so no key has to be solved again.
    project.history.do(shape_commands.set_limits(project.selection.active, bounds), gesture=gesture)
    solve_pose_again(session, asked or {}, gesture=gesture)


@with_project
def relax_motion_limits(session: Session, project: Project) -> None:
    """Allow the next larger stretch between the keys; poses stay as they are."""
    bounds = relax_limits(project.layer.bounds)
    if bounds is not None:
        cancel_solving_keys(session)
        project.history.do(shape_commands.set_limits(project.selection.active, bounds))


def set_limit(session: Session, bounds: Bounds, name: str, value: float) -> None:
    """Set one limit to a typed number.

    Raises
    ------
    EngineError
        If the number is outside the limit's valid range.
    """
    set_limits(session, replace(bounds, **{name: value}))


def solving_disabled_reason(project: Project) -> str | None:
    """Return why the poses of keys cannot be solved again; None if they can."""
    if project.key_resolver is not None:
        return _("Wait until all keys are re-posed.")
    return None if project.layer.handles else _("Add a handle first.")


def solve_keys_again(session: Session) -> None:
    """Solve every key for its targets again, within the present limits."""
    pending_changes.run_when_idle(session, do(_solve_keys_again), _("Re-pose keys"))


@with_project
def _solve_keys_again(session: Session, project: Project) -> None:
    begin_solving_keys(session, KeyResolver(before=project.layer, bounds=project.layer.bounds))


def rebuild_mesh(session: Session) -> None:
    """Find the outline and build the mesh again; handles stay, keys are solved again."""
    pending_changes.run_when_idle(session, do(_rebuild_mesh), _("Rebuild"))


@with_project
def _rebuild_mesh(session: Session, project: Project) -> None:
    layer, meshing = project.layer, project.layer_setup.meshing or project.layer.meshing
    begin_solving_keys(session, KeyResolver(before=layer, bounds=layer.bounds, meshing=meshing))


@with_project
def rebuild_changed_cut_out(session: Session, project: Project) -> None:
    """Rebuild the domain after a change of the cut-out, once the brush rests; once a frame."""
    stale = project.stale_layer
    waited = project.layer_setup.note_stale(stale, session.clock())
    is_busy = session.tools.active_tool is not None or project.pending.changes
    if stale is not None and not is_busy and waited >= REST:
        resolver = KeyResolver(before=stale, bounds=stale.bounds, meshing=stale.meshing)
        _go_on(session, project, resolver)


def _follows_cut_out(resolver: KeyResolver) -> bool:
    """Return whether a rebuild has no other cause than a changed cut-out."""
    return resolver.before.is_stale and resolver.meshing == resolver.before.meshing


@with_project
def cancel_solving_keys(session: Session, project: Project) -> None:
    """Cancel the current solve or rebuild."""
    if project.key_resolver is not None and _follows_cut_out(project.key_resolver):
        project.layer_setup.refuse(project.key_resolver.before)
    pending_changes.cancel_pending_change(session, project, SOLVING_KEYS)


@with_project
def begin_solving_keys(session: Session, project: Project, resolver: KeyResolver) -> None:
    """Begin to replace a layer's poses; a current solve is cancelled."""
    cancel_solving_keys(session)
    _go_on(session, project, resolver)


def _go_on(session: Session, project: Project, resolver: KeyResolver) -> None:
    if resolver.before not in project.document.layers:
        if _follows_cut_out(resolver):
            return  # the rebuild begins again
        session.notices.show(
            _("The keys were not posed again: the project changed meanwhile. Start again.")
        )
        return
    if resolver.is_over:
        _accept(session, project, resolver)
        return
    picture = project.runtimes.layers[resolver.before.id].picture.rgba

    def failed(error: Exception) -> None:
        if resolver.replaces_picture:
            report_failure(session, _("The picture was not replaced"), error)
            return
        builds = resolver.meshing is not None
        if builds:
            project.layer_setup.refuse(resolver.before)
        failure = _("The mesh was not changed") if builds else _("The limits were not changed")
        report_failure(session, failure, error)

    pending_changes.begin_pending_change(
        session,
        project,
        SOLVING_KEYS,
        lambda: step_resolver(resolver, picture),
        partial(_go_on, session, project),
        failed,
        change=PendingChange(label=SOLVING_KEYS.label, key_resolver=resolver),
    )


def _accept(session: Session, project: Project, resolver: KeyResolver) -> None:
    if _follows_cut_out(resolver):
        project.history.extend_step(resolver.command)
    else:
        gesture = object()
        project.history.do(resolver.command, gesture=gesture)
        if resolver.new_layer is not None:
            project.history.set_preview_pose(None, gesture=gesture)
            project.layer_setup.preview_meshing(None)
    if resolver.replaces_picture:
        update_layer_runtimes(project)
    for number, notice in enumerate(resolver.notices):
        # This runs after every stroke, and notices of earlier strokes are out of date.
        session.notices.show(as_sentence(notice), topic=f"rebuilt {number}")
    if resolver.unsolved:
        text = ngettext(
            "The pose {poses} exceeds the limits. Move its handles nearer to the drawing, or undo.",
            "The poses {poses} exceed the limits. Move their handles nearer to the drawing, or "
            "undo.",
            len(resolver.unsolved),
        )
        session.notices.show(text.format(poses=", ".join(resolver.unsolved)), tone="error")
