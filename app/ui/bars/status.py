"""The status bar."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

from imgui_bundle import ImColor, ImVec2, imgui, imspinner

from app.document import DistortionRange, measure_target_errors, misses_target, relax_limits
from app.editor import Action, JobKind, Project, Session, do, pending_changes
from app.editor.actions.layer_setup import resolving
from app.editor.actions.project_files import exporting
from app.editor.actions.updates import stage_jobs
from app.errors import display_name
from app.texts import _, ngettext
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, shorten_text

LEAST_ROOM = 6.0  # em: hints are omitted if less width is left
SLOW = 0.3  # seconds after which a job is reported; reports of shorter jobs would flicker
ENDLESS = 5.0  # seconds after which a job can be cancelled
SLOWED, STOPPED = 0.5, 0.05  # of the velocity at a key: below these, the status bar reports it
MOST_LISTED = 3  # keys
LIMIT_NAMES = {"k": _("Shear"), "σa": _("Stretch"), "σb": _("Squeeze")}  # by symbol


class WarningAction(NamedTuple):
    verb: Callable[[Session], None]
    hint: str  # in its tooltip


RELAX_POSE_LIMITS = WarningAction(
    resolving.relax_limits_and_solve,
    _("Raise the stretch limit, and pull the handles again"),
)
RELAX_MOTION_LIMITS = WarningAction(
    resolving.relax_motion_limits,
    _("Raise the stretch limit, so that the motion goes on through its keys"),
)


class StatusItem(NamedTuple):
    """An item at the right end of the status bar."""

    text: str
    hint: str  # in its tooltip
    is_warning: bool = False


def draw_status_bar(session: Session, look: Look) -> list[Action]:
    """Draw the status bar: running jobs, warnings, and the state of project and window."""
    gap = 1.6 * look.em
    items = list_status_items(session)
    width = sum(imgui.calc_text_size(item.text).x + gap for item in items)
    end = imgui.get_window_width() - width + gap - look.em
    actions: list[Action] = []
    held_back, slowed = describe_pose_limit(session), describe_motion_limit(session)
    slow = session.jobs.running_for(SLOW)
    if held_back:
        actions += _warn(session, look, held_back, RELAX_POSE_LIMITS)
        imgui.same_line(0, gap)
    elif slowed:
        actions += _warn(session, look, slowed, RELAX_MOTION_LIMITS)
        imgui.same_line(0, gap)
    hint = session.tools.hint if held_back or slowed else session.tools.hint or _("Ready")
    room = end - imgui.get_cursor_pos_x() - gap
    waiting = pending_changes.deferred_label(session.project) if session.project else ""
    exported = _export(session)
    if exported:
        _spinner(look)
        imgui.text_unformatted(shorten_text(exported, max(room - 6 * look.em, 0.0)))
        imgui.same_line(0, 0.8 * look.em)
        if imgui.small_button(_("Cancel")):
            actions.append(do(exporting.cancel_export))
        draw_tooltip(_("Cancel the export"))
    elif slow or waiting:
        _spinner(look)
        share = session.jobs.share_of(slow[0]) if slow else None
        job = _("{job}…") if share is None else _("{job}… {share:.0%}")
        imgui.text_unformatted(job.format(job=waiting or slow[0].label, share=share))
        actions += _cancel(session, look, slow)
    elif room > LEAST_ROOM * look.em:
        imgui.text_disabled(shorten_text(hint, room))
    imgui.same_line(end)
    for item in items:
        imgui.text_colored(look.palette.warning if item.is_warning else look.palette.dim, item.text)
        draw_tooltip(item.hint)
        imgui.same_line(0, gap)
    imgui.new_line()
    return actions


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
        return _("Stretch limit reached – {name} is {lag:.0f} px short").format(name=name, lag=lag)
    return ngettext(
        "Stretch limit reached – {name} is {lag:.0f} px short, {count} more too",
        "Stretch limit reached – {name} is {lag:.0f} px short, {count} more too",
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
            "The motion stops at frame {frames} to keep within the stretch limit",
            "The motion stops at frames {frames} to keep within the stretch limit",
            len(frames),
        )
        if stopped
        else ngettext(
            "The motion slows down at frame {frames} to keep within the stretch limit",
            "The motion slows down at frames {frames} to keep within the stretch limit",
            len(frames),
        )
    )
    return text.format(frames=where)


def _export(session: Session) -> str:
    """Return the progress of the running export in words; else ""."""
    run = session.export.run
    if run is None:
        return ""
    if run.for_clipboard:
        return _("Copying the picture…")
    total, name = len(run.plan.times), display_name(run.plan.out.name)
    if run.done == total:
        return _("Finishing {name}…").format(name=name)
    return _("Exporting {name}: {done} of {total}").format(name=name, done=run.done, total=total)


def _cancel(session: Session, look: Look, slow: Sequence[JobKind]) -> list[Action]:
    """Draw the cancel button of jobs that may never end or report progress."""
    measured = tuple(kind for kind in slow if session.jobs.share_of(kind) is not None)
    endless = session.jobs.running_for(ENDLESS) or measured
    if not endless:
        return []
    imgui.same_line(0, 0.8 * look.em)
    is_pressed = imgui.small_button(_("Cancel"))
    draw_tooltip(_("Cancel: {job}").format(job=endless[0].label))
    return [do(stage_jobs.give_up, endless[0])] if is_pressed else []


def _warn(session: Session, look: Look, text: str, remedy: WarningAction) -> list[Action]:
    """Draw a warning about the limits, with the button of its remedy."""
    imgui.text_colored(look.palette.warning, text)
    project = session.project
    if project is None or relax_limits(project.layer.bounds) is None:
        return []
    imgui.same_line(0, 0.8 * look.em)
    is_pressed = imgui.small_button(_("Loosen"))
    draw_tooltip(remedy.hint)
    return [do(remedy.verb)] if is_pressed else []


def list_status_items(session: Session) -> list[StatusItem]:
    """Return the items at the right end of the status bar."""
    facts = []
    project = session.project
    if project is not None:
        distortion = _distortion(project)
        facts += [distortion] if distortion else []
        count = len(project.layer.handles)
        facts.append(
            StatusItem(
                ngettext("{count} handle", "{count} handles", count).format(count=count),
                _("Handles of this drawing"),
            )
        )
    if session.diagnostics.solver_seconds:
        milliseconds = 1e3 * session.diagnostics.solver_seconds
        facts.append(
            StatusItem(
                _("pose {time:.0f} ms").format(time=milliseconds),
                _("Time to solve the pose"),
            )
        )
    if project is not None and project.timeline.playhead.since is not None:
        facts.append(
            StatusItem(
                _("{rate:.0f} fps").format(rate=imgui.get_io().framerate),
                _("Frames drawn per second"),
            )
        )
    return facts


def _distortion(project: Project) -> StatusItem | None:
    """Return the largest distortion of the shown frame, of the kind nearest to its limit."""
    shown, curves = project.layer_runtime.shown, project.measured.curves.value
    if shown is None:
        return None
    if shown.pose is not None:
        extremes = DistortionRange.of(shown.pose)
    elif curves is not None and curves.clip == project.clip:
        extremes = curves.extremes_at(shown.frame)
    else:
        return None
    uses = extremes.uses(project.layer.bounds)
    most = max(uses, key=lambda use: use.share)
    return StatusItem(
        _("{name} {value:.2f}, limit {limit:.2f}").format(
            name=LIMIT_NAMES[most.name], value=most.value, limit=most.limit
        ),
        "\n".join(
            [_("Largest distortion anywhere in the shape, and its limit"), ""]
            + [
                _("{name} ({symbol}) {value:.3f}, limit {limit:.3f}").format(
                    name=LIMIT_NAMES[use.name],
                    symbol=use.name,
                    value=use.value,
                    limit=use.limit,
                )
                for use in uses
            ]
        ),
        is_warning=most.is_all,
    )


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
