"""After release, move targets that the limits make unreachable to the handles' places."""

from collections.abc import Callable, Mapping

from app.document import Target, measure_target_errors, misses_target, relax_limits
from app.editor.action import do
from app.editor.actions import playback
from app.editor.project import Project
from app.editor.session import Session, with_project
from app.editor.work.drag_session import DragSession, StoppedDrag
from app.texts import N_, _, ngettext

# Relaxes the limits, and drags handles once more to their original targets.
RelaxLimits = Callable[[Session, Mapping[int, Target]], None]
STOPPED_AT_LIMIT = N_("{handle} stopped at its stretch limit.")
STOPPED_BY_BONES = N_("{handle} stopped: its bones reach no farther.")
STOPPED_BY_HANDLES = N_("{handle} stopped where the other handles hold the shape.")


def clamp_unreachable_targets(project: Project, drag: DragSession) -> None:
    """Clamp the targets of a drag whose pose rests, and note which handles stopped before them."""
    asked, places = drag.world_targets, drag.reached
    drag.clamp_targets()
    if asked is not None:
        project.pending.stop_drag(StoppedDrag(drag, {i: asked[i] for i in places}, places))


@with_project
def show_stopped_drag(session: Session, project: Project, loosen: RelaxLimits) -> None:
    """Show why handles of the last drag stopped before their targets, and offer the remedy."""
    stopped = project.pending.take_stopped_drag()
    if stopped is None:
        return
    drag, asked, places = stopped
    layer, pose = drag.clip.layer, drag.newest
    lacks = {i: abs(place.position - asked[i].position) for i, place in places.items()}
    short = [i for i, lack in lacks.items() if misses_target(layer, lack)]
    if not short or pose is None:
        return
    name, others = layer.handle(short[0]).name, len(short) - 1
    is_at_limits = measure_target_errors(layer, pose).at_limits
    is_beyond_bones = drag.solver is not None and short[0] in drag.solver.out_of_reach(asked)
    if is_beyond_bones:
        text, is_at_limits = _(STOPPED_BY_BONES), False
    elif not others:
        text = _(STOPPED_AT_LIMIT) if is_at_limits else _(STOPPED_BY_HANDLES)
    elif is_at_limits:
        text = ngettext(
            "{handle} and {count} more handle stopped at their stretch limits.",
            "{handle} and {count} more handles stopped at their stretch limits.",
            others,
        )
    else:
        text = ngettext(
            "{handle} and {count} more handle stopped where the other handles hold the shape.",
            "{handle} and {count} more handles stopped where the other handles hold the shape.",
            others,
        )
    text = text.format(handle=name, count=others)
    if not is_at_limits or relax_limits(layer.bounds) is None:
        session.notices.show(text, topic="stopped")
    else:
        session.notices.show(
            text,
            topic="stopped",
            label=_("Loosen"),
            action=do(_relax_limits, drag.layer, drag.frame, asked, loosen),
        )


@with_project
def _relax_limits(
    session: Session,
    project: Project,
    layer: int,
    frame: int,
    asked: Mapping[int, Target],
    loosen: RelaxLimits,
) -> None:
    """Relax a layer's limits, and drag it once more to the original targets."""
    if layer != project.selection.active:
        session.notices.show(
            _("Another layer is posed now. Select the layer that was dragged, and drag again.")
        )
        return
    if playback.edited_frame(session, project) != frame:
        playback.seek(session, frame)
    loosen(session, asked)
