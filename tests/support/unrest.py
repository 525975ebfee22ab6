"""What a window that does not come to rest waits for, in words."""

from app.document import clip_of
from app.editor import pending_changes
from app.editor.project import Project
from app.editor.session import Session
from app.motion import LayerFrame


def unrest(session: Session) -> str:
    """Tell which jobs are under way, what waits for which of them, and what is shown meanwhile."""
    lines = [f"job: {kind.label!r} on {kind.lane!r}" for kind in session.jobs.kinds]
    project = session.project
    if project is None:
        return "\n".join(lines)
    lines += [
        f"on its way: {each.label!r} ({type(each).__name__})" for each in project.pending.changes
    ]
    drag = project.drag
    if drag is not None:
        lines.append(
            f"drag: layer {drag.layer}, frame {drag.frame}, held {project.history.is_held}"
        )
    lines += [
        f"waits until nothing is on its way: {each.what!r}" for each in project.pending.deferred
    ]
    if project.stale_layer is not None:
        lines.append(f"waits for a mesh: {project.stale_layer.name!r}")
    lines += _shown(project)
    lines.append(f"settled: {pending_changes.is_document_idle(project)}")
    lines.append(f"failing: {sorted(session.diagnostics.reported_failures)}")
    lines += [f"message: {toast.text!r}" for toast in session.notices.toasts]
    return "\n".join(lines)


def is_shown(session: Session) -> bool:
    """Tell whether every layer shows what the document has."""
    return session.project is not None and not _shown(session.project)


def _shown(project: Project) -> list[str]:
    lines = []
    for identity, puppet in project.runtimes.layers.items():
        clip, shown, store = clip_of(project.document, identity), puppet.shown, puppet.store
        if shown is None:
            lines.append(f"layer {clip.layer.name!r}: nothing is shown")
        elif not (shown.is_current or _plays(project, shown)) or shown.clip != clip:
            lines.append(
                f"layer {clip.layer.name!r}: shows frame {shown.frame} of frames "
                f"{shown.clip.frames.first} to {shown.clip.frames.last}, and the document has "
                f"{clip.frames.first} to {clip.frames.last}; same clip {shown.clip == clip}, same "
                f"layer {shown.clip.layer is clip.layer}, stand-in "
                f"{type(shown.placeholder).__name__}, rough {shown.is_approximate}, still "
                f"{clip.layer.still}, mesh of its domain {store.mesh.source is clip.layer.domain}"
                f", failed {[part for part in PARTS if store.has_failed(clip, part)]}"
            )
    return lines


def _plays(project: Project, shown: LayerFrame) -> bool:
    """Tell whether a frame only plays, so that nothing finds its corrections."""
    return project.timeline.playhead.since is not None and shown.placeholder is None


PARTS = ("frame", "in-betweens", "fine", "series")
