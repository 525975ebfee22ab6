"""The status bar: a hint at the left, and one state with its remedy at the right."""

from collections.abc import Sequence
from typing import NamedTuple

from imgui_bundle import ImColor, ImVec2, imgui, imspinner

from app.document import measure_target_errors, misses_target, relax_limits
from app.editor import Action, JobKind, Project, Session, do, pending_changes
from app.editor.actions import viewing
from app.editor.actions.layer_setup import resolving
from app.editor.actions.project_files import exporting
from app.editor.actions.updates import correction_jobs, stage_jobs
from app.errors import display_name
from app.texts import _, ngettext
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, shorten_text

LEAST_ROOM = 6.0  # em: hints are omitted if less width is left
SLOW = 0.3  # seconds after which a job is reported; reports of shorter jobs would flicker
ENDLESS = 5.0  # seconds after which a job can be cancelled
SLOWED, STOPPED = 0.5, 0.05  # of the velocity at a key: below these, the status bar reports it
MOST_LISTED = 3  # keys
MOST_SHOWN = 0.99  # finished part of a running job
# Jobs that bring the in-betweens up to date: nobody needs to tell them apart.
UPDATES = (
    *(stage_jobs.GLIMPSING, stage_jobs.SKETCHING, stage_jobs.REFINING, stage_jobs.STREAMING),
    *(stage_jobs.ATTACHING, correction_jobs.CORRECTING, correction_jobs.CORRECTING_SHOWN_FRAME),
    correction_jobs.FINDING_BASE_FRAMES,
)


class StatusState(NamedTuple):
    """The one state that the status bar tells, with the button of its remedy."""

    text: str
    remedy: Action | None = None
    label: str = ""  # of the button
    hint: str = ""  # the button's tooltip
    is_running: bool = False  # whether a spinner shows that work goes on
    is_warning: bool = False


def draw_status_bar(session: Session, look: Look) -> list[Action]:
    """Draw the hint at the left, and the state at the right."""
    state, gap = find_state(session), 0.8 * look.em
    start, style = imgui.get_cursor_pos_x(), imgui.get_style()
    end = imgui.get_window_width() - look.em
    if state is not None:
        button = imgui.calc_text_size(state.label).x + 2 * style.frame_padding.x + gap
        beside = button * bool(state.label) + 1.6 * look.em * state.is_running
        text = shorten_text(state.text, max(end - start - beside, look.em))
        end -= imgui.calc_text_size(text).x + beside
    room = end - start - gap
    hint = session.tools.hint or _idle_hint(session)
    if room > LEAST_ROOM * look.em:
        imgui.text_disabled(shorten_text(hint, room))
        imgui.same_line()
    if state is None:
        imgui.new_line()
        return []
    imgui.set_cursor_pos_x(end)
    if state.is_running:
        _spinner(look)
    imgui.text_colored(look.palette.warning if state.is_warning else look.palette.text, text)
    if state.remedy is None:
        return []
    imgui.same_line(0, gap)
    is_pressed = imgui.small_button(state.label)
    draw_tooltip(state.hint)
    return [state.remedy] if is_pressed else []


def find_state(session: Session) -> StatusState | None:
    """Return the state that matters most now: what runs, what still moves, what is limited."""
    exported, project = _export(session), session.project
    if exported:
        cancel = do(exporting.cancel_export)
        hint = _("Cancel the export")
        return StatusState(exported, cancel, _("Cancel"), hint, is_running=True)
    moving = _describe_moving(project) if project else ""
    if moving:
        return StatusState(moving, is_running=True)
    slow = session.jobs.running_for(SLOW)
    waiting = pending_changes.deferred_label(project) if project else ""
    if slow or waiting:
        return _running(session, waiting, slow)
    held_back, slowed = describe_pose_limit(session), describe_motion_limit(session)
    if not (held_back or slowed) or project is None:
        return None
    state = StatusState(held_back or slowed, is_warning=True)
    if relax_limits(project.layer.bounds) is None:
        return state
    if held_back:
        remedy = do(resolving.relax_limits_and_solve)
        hint = _("Raise the stretch limit, and pull the handles again")
    else:
        remedy = do(resolving.relax_motion_limits)
        hint = _("Raise the stretch limit, so that the motion goes on through its keys")
    return state._replace(remedy=remedy, label=_("Loosen"), hint=hint)


def _running(session: Session, waiting: str, slow: Sequence[JobKind]) -> StatusState:
    """Return the state of running jobs. Jobs with progress and endless ones can be cancelled."""
    name = waiting or (_("Updating the animation") if slow[0] in UPDATES else slow[0].label)
    text = _name_job(session, name, slow[0]) if slow else _("{job}…").format(job=name)
    state = StatusState(text, is_running=True)
    measured = tuple(kind for kind in slow if session.jobs.share_of(kind) is not None)
    endless = session.jobs.running_for(ENDLESS) or measured
    if not endless:
        return state
    cancel, hint = do(stage_jobs.give_up, endless[0]), _("Cancel: {job}").format(job=name)
    return state._replace(remedy=cancel, label=_("Cancel"), hint=hint)


def _name_job(session: Session, name: str, kind: JobKind) -> str:
    """Return a name with the finished part of a job of this kind, if it is known."""
    share = session.jobs.share_of(kind)
    if share is None:
        return _("{job}…").format(job=name)
    # A job that runs is not complete.
    return _("{job}… {share:.0%}").format(job=name, share=min(share, MOST_SHOWN))


def _describe_moving(project: Project) -> str:
    """Return how far the farthest handle is from its target, and what waits for it; else ""."""
    drag, shown = project.visible_drag, project.layer_runtime.shown
    if drag is None or drag.is_at_rest or shown is None or shown.pose is None:
        return ""
    errors = measure_target_errors(shown.clip.layer, shown.pose).errors
    if not errors:
        return ""
    text = _("Still moving · {lag:.0f} px to go").format(lag=max(errors.values()))
    return pending_changes.with_deferred(project, text)


def _idle_hint(session: Session) -> str:
    if not session.display.is_panel_folded:
        return _("Ready")
    return _("{keys} shows the panel").format(keys=shown_keys(viewing.toggle_panel))


def describe_pose_limit(session: Session) -> str:
    """Return which handle the limits hold back in the shown frame, and how far; else "".

    The handle's pose or its track has a target elsewhere.
    """
    project = session.project
    shown = project.layer_runtime.shown if project else None
    if project is None or shown is None or project.timeline.playhead.since is not None:
        return ""
    layer, correction, lags = shown.clip.layer, shown.correction, dict[int, float]()
    if shown.pose is not None:
        missed = measure_target_errors(layer, shown.pose)
        lags |= missed.errors if missed.at_limits else {}
    if correction is not None and correction.is_limited:
        own = shown.track_errors.items()
        lags |= {handle: miss for handle, miss in own if misses_target(layer, miss)}
    if not lags:
        return ""
    farthest = max(lags, key=lags.__getitem__)
    name, lag, others = layer.handle(farthest).name, lags[farthest], len(lags) - 1
    if not others:
        return _("At its limit · {name} is {lag:.0f} px short").format(name=name, lag=lag)
    return ngettext(
        "At its limit · {name} is {lag:.0f} px short, and {count} more",
        "At its limit · {name} is {lag:.0f} px short, and {count} more",
        others,
    ).format(name=name, lag=lag, count=others)


def describe_motion_limit(session: Session) -> str:
    """Return at which smooth keys the limits slow the motion down; else ""."""
    project = session.project
    if project is None or project.drag is not None or project.timeline.playhead.since is not None:
        return ""
    # The text changes with each result of the worker.
    known, source = project.timeline.slowed, (project.clip, session.jobs.delivered)
    if not known.follows(source):
        shares = project.layer_runtime.store.velocity_shares(project.clip)
        known.set(source, {at: share for at, share in shares.items() if share < SLOWED})
    slowed = sorted(known.value)
    stopped = [frame for frame in slowed if known.value[frame] < STOPPED]
    if not slowed:
        return ""
    frames = stopped or slowed
    listed = [f"{frame}" for frame in frames[:MOST_LISTED]]
    if len(frames) > MOST_LISTED:
        rest = len(frames) - MOST_LISTED
        listed.append(ngettext("{count} more", "{count} more", rest).format(count=rest))
    where = listed[0]
    if len(listed) > 1:
        where = _("{names} and {last}").format(names=", ".join(listed[:-1]), last=listed[-1])
    text = (
        ngettext(
            "At its limit · the motion stops at frame {frames}",
            "At its limit · the motion stops at frames {frames}",
            len(frames),
        )
        if stopped
        else ngettext(
            "At its limit · the motion slows down at frame {frames}",
            "At its limit · the motion slows down at frames {frames}",
            len(frames),
        )
    )
    return text.format(frames=where)


def _export(session: Session) -> str:
    """Return the progress of the export under way in words, or what it waits for; else ""."""
    run, project = session.export.run, session.project
    if project is None or not exporting.is_export_under_way(session):
        return ""
    if run is None:
        waiting = pending_changes.deferred_label(project)
        return _name_job(session, waiting or exporting.PREPARING.label, exporting.PREPARING)
    if run.for_clipboard:
        return _("Copying the picture…")
    total, name = len(run.plan.times), display_name(run.plan.out.name)
    if run.done == total:
        return _("Finishing {name}…").format(name=name)
    return _("Exporting {name}: {done} of {total}").format(name=name, done=run.done, total=total)


def _spinner(look: Look) -> None:
    colour, start, style = ImColor(look.palette.accent), imgui.get_cursor_pos(), imgui.get_style()
    radius = 0.35 * look.em
    up = radius + style.frame_padding.y - imgui.get_text_line_height() / 2
    imgui.set_cursor_pos_y(start.y - up)
    imspinner.spinner_ang(
        "##busy", radius, 0.14 * look.em, colour, ImColor(0, 0, 0, 0), speed=6.0, angle=4.5
    )
    # Beside the item and not on its line, where text stands lower.
    beside = imgui.get_item_rect_size().x + style.item_spacing.x
    imgui.set_cursor_pos(start + ImVec2(beside, 0))
