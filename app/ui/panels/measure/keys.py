"""The state of the shown pose, and the distortion of every key."""

from imgui_bundle import icons_fontawesome_6 as icons, imgui

from app.document import TargetErrors, measure_target_errors
from app.editor import Action, Project, Session, do
from app.editor.actions import playback
from app.texts import _, ngettext
from app.ui.panels.shape.limits import LIMITS
from app.ui.style.theme import SMALL, Look
from app.ui.style.widgets import push_text_size, small_text


def draw_pose_state(session: Session, look: Look, project: Project) -> None:
    """Say whether the handles of the shown pose reach their targets, and what is proven."""
    palette, shown = look.palette, project.layer_runtime.shown
    pose = None if shown is None else shown.pose
    if project.visible_drag is not None and not project.visible_drag.is_at_rest:
        _status(look, icons.ICON_FA_ARROWS_SPIN, palette.accent, _("Following the handles"))
        time = 1000 * session.diagnostics.solver_seconds
        small_text(look, _("{time:.0f} ms a step").format(time=time))
        return
    if shown is None or pose is None:
        _status(look, icons.ICON_FA_FILM, palette.dim, _("An in-between"))
        small_text(look, _("It never distorts more than its two keys."))
        return
    missed = measure_target_errors(shown.clip.layer, pose)
    is_proven = shown.clip.layer.is_proven(pose)
    if not is_proven:
        _status(look, icons.ICON_FA_TRIANGLE_EXCLAMATION, palette.danger, _("Beyond the limits"))
    elif missed.errors:
        _status(look, icons.ICON_FA_HAND, palette.warning, _describe_target_errors(missed))
        small_text(
            look,
            _("Held back by the limits. A looser stretch brings handles nearer.")
            if missed.at_limits
            else _(
                "Held back by the other handles and the shape's stiffness. More weight brings a "
                "handle nearer."
            ),
        )
    else:
        _status(
            look, icons.ICON_FA_CIRCLE_CHECK, palette.good, _("All handles reach their targets")
        )
    if is_proven:
        small_text(look, _("Proven: nothing folds, and no point exceeds the limits."))


def _describe_target_errors(missed: TargetErrors) -> str:
    count, most = len(missed.errors), max(missed.errors.values())
    return ngettext(
        "{count} handle is {error:.0f} px short of its target",
        "{count} handles are up to {error:.0f} px short",
        count,
    ).format(count=count, error=most)


def _status(look: Look, icon: str, colour: imgui.ImVec4, text: str) -> None:
    imgui.text_colored(colour, icon)
    imgui.same_line(0, 0.5 * look.em)
    imgui.text_unformatted(text)


def draw_key_table(session: Session, look: Look, project: Project) -> list[Action]:
    """List the distortion of every key. A click moves the playhead to the key."""
    actions: list[Action] = []
    layer, palette = project.layer, look.palette
    flags = imgui.TableFlags_.sizing_stretch_prop | imgui.TableFlags_.pad_outer_x
    if not imgui.begin_table("keys", 1 + len(LIMITS), flags):
        return actions
    with push_text_size(SMALL):
        imgui.table_next_row()
        for title in (_("Frame"), *(limit.symbol for limit in LIMITS)):
            imgui.table_next_column()
            imgui.text_colored(palette.dim, title)
        now = playback.current_frame(session, project)
        for key in layer.keys:
            certificate = key.pose.certificate
            imgui.table_next_row()
            imgui.table_next_column()
            if imgui.selectable(
                f"{key.frame}###key {key.frame}",
                key.frame == now,
                imgui.SelectableFlags_.span_all_columns,
            )[0]:
                actions.append(do(playback.seek, key.frame))
            for limit in LIMITS:
                imgui.table_next_column()
                value = float(getattr(certificate, limit.field))
                beyond = limit.scale.share(value) > limit.scale.share(
                    getattr(layer.bounds, limit.field)
                )
                imgui.text_colored(palette.danger if beyond else palette.text, f"{value:.2f}")
    imgui.end_table()
    return actions
