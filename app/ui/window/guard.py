"""The frame guard: a notice replaces a part of the window that raises; the others go on."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Literal

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui, imgui_ctx, implot

from app.editor import Action, Session, do, error_reports
from app.texts import _
from app.ui.panel import Panel
from app.ui.style.theme import Look
from app.ui.style.widgets import draw_tooltip, small_text

OWN_CLIPS = 2  # clip rectangles that belong to a window itself
PAUSE = 1.0  # seconds before a failed step is tried again
WIDTH = 24.0  # em: width of a notice outside panels
MOST_SHOWN = 1500  # characters of a traceback on the screen; the button copies all of it
FRAME = imgui.ChildFlags_.auto_resize_y | imgui.ChildFlags_.borders
ALONE = (
    imgui.WindowFlags_.always_auto_resize
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
)
TRY_AGAIN, COPY, REPORT = _("Try again"), _("Copy"), _("Report…")
CLOSE, DETAILS = _("Close"), _("Details")


def allow_recovery() -> None:
    """Let Dear ImGui close the open scopes of a broken panel. By default it would assert."""
    io = imgui.get_io()
    io.config_error_recovery = True
    io.config_error_recovery_enable_assert = False
    io.config_error_recovery_enable_tooltip = False
    io.config_error_recovery_enable_debug_log = True


def format_failure(name: str) -> str:
    """The title of the notice about a failed part."""
    return _("{part} cannot be shown. The rest of Lissom works. Save your project.").format(
        part=name
    )


@dataclass(frozen=True, slots=True)
class _Failure:
    """A failure: the state that caused it, its time in clock seconds, and the traceback."""

    state: tuple[object, ...]
    at: float
    trace: str = ""


@dataclass(slots=True, eq=False)
class WindowPart:
    """A part of the window's frame. A notice replaces it after a failure.

    A failed part is drawn again when the person asks, or once the document, the selection or the
    session has changed. While a mouse button is down or the animation plays, the part waits.
    """

    name: str  # as the subject of a sentence
    draw: Callable[[Session, Look], list[Action]]
    _: KW_ONLY
    # Place of the notice: in a "panel", in a "menu", behind a button in a "bar", or in its own
    # "window".
    place: Literal["panel", "menu", "bar", "window"] = "panel"
    dismissal: Action | None = None  # closes the part; None if it cannot be closed
    failure: _Failure | None = None

    def draw_guarded(self, session: Session, look: Look) -> list[Action]:
        """Draw the part, or its notice after a failure. Return the person's actions."""
        failure = self.failure
        if failure is not None and (_is_moving(session) or failure.state == _state(session)):
            return self._show_notice(failure, look)
        stacks = imgui.internal.ErrorRecoveryState()
        imgui.internal.error_recovery_store_state(stacks)
        around = imgui.internal.get_current_window()
        try:
            actions = self.draw(session, look)
        except Exception as error:  # noqa: BLE001 - the frame guard: the window must live on
            _restore(stacks, around)
            self._fail(session, error)
            return []
        self.failure = None
        return actions

    def try_again(self) -> None:
        """Draw the part in the next frame, even if nothing has changed."""
        self.failure = None

    def _fail(self, session: Session, error: Exception) -> None:
        trace = error_reports.error_trace(session, error)
        if self.failure is None or self.failure.trace != trace:
            error_reports.report_unexpected_error(
                session, format_failure(self.name), error, topic="parts"
            )
        self.failure = _Failure(_state(session), session.clock(), trace)

    def _show_notice(self, failure: _Failure, look: Look) -> list[Action]:
        actions: list[Action] = []
        width, popup = WIDTH * look.em, _("{part} failed").format(part=self.name)
        match self.place:
            case "panel":
                with imgui_ctx.push_style_color(imgui.Col_.child_bg, look.palette.panel):
                    imgui.begin_child(popup, ImVec2(0, 0), child_flags=FRAME)
                    actions = self._notice(failure, look, width=0.0)
                    imgui.end_child()
            case "menu":
                actions = self._notice(failure, look, width=width)
            case "bar":
                if imgui.small_button(f"{icons.ICON_FA_TRIANGLE_EXCLAMATION}##{popup}"):
                    imgui.open_popup(popup)
                draw_tooltip(format_failure(self.name))
                if imgui.begin_popup(popup):
                    actions = self._notice(failure, look, width=width)
                    imgui.end_popup()
            case "window":
                middle = imgui.get_main_viewport().get_center()
                imgui.set_next_window_pos(middle, imgui.Cond_.appearing, ImVec2(0.5, 0.5))
                if imgui.begin(popup, flags=ALONE)[0]:
                    actions = self._notice(failure, look, width=width)
                imgui.end()
        return actions

    def _notice(self, failure: _Failure, look: Look, width: float) -> list[Action]:
        """Draw the notice. Lines wrap at `width` pixels, or at the window's edge."""
        actions: list[Action] = []
        imgui.push_id(self.name)
        imgui.push_text_wrap_pos(imgui.get_cursor_pos_x() + width if width else 0.0)
        imgui.text_unformatted(format_failure(self.name))
        if imgui.button(TRY_AGAIN):
            self.try_again()
        imgui.same_line()
        if imgui.button(COPY):
            imgui.set_clipboard_text(failure.trace)
        imgui.same_line()
        if imgui.button(REPORT):
            actions.append(do(error_reports.show_problem_report))
        if self.dismissal is not None:
            imgui.same_line()
            if imgui.button(CLOSE):
                actions.append(self.dismissal)
                self.try_again()
        if imgui.tree_node_ex(DETAILS, imgui.TreeNodeFlags_.no_tree_push_on_open):
            small_text(look, failure.trace.strip()[-MOST_SHOWN:])
        imgui.pop_text_wrap_pos()
        imgui.pop_id()
        return actions


@dataclass(slots=True, eq=False)
class FrameStep:
    """A step of every frame that no person asks for. After a failure it pauses.

    It runs again once the document, the selection or the session has changed, and after `PAUSE`
    seconds at the latest.
    """

    run: Callable[[], None]
    report_error: Callable[[Exception], None]
    failure: _Failure | None = None

    def run_guarded(self, session: Session) -> None:
        """Run the step, unless it failed recently. Report a failure."""
        failure = self.failure
        if failure is not None:
            rests = session.clock() - failure.at < PAUSE
            if rests and (_is_moving(session) or failure.state == _state(session)):
                return
        try:
            self.run()
        except Exception as error:  # noqa: BLE001 - part of the frame guard
            self.failure = _Failure(_state(session), session.clock())
            self.report_error(error)
        else:
            self.failure = None


def _restore(stacks: imgui.internal.ErrorRecoveryState, around: imgui.internal.Window) -> None:
    """Close all ImGui scopes that a part left open, in its own windows and in the window around."""
    plots = implot.get_current_context()
    if plots is not None and plots.current_plot is not None:
        implot.internal.reset_ctx_for_next_plot(plots)
    # Recovery would also end the menu bar around the part.
    in_bar, around.dc.menu_bar_appending = around.dc.menu_bar_appending, False
    # A menu that was open before may lack the clip rectangle that its end pops.
    clips = imgui.get_window_draw_list()
    if clips._clip_rect_stack.size() < OWN_CLIPS:  # noqa: SLF001 - there is no public way
        clips.push_clip_rect_full_screen()
    imgui.internal.error_recovery_try_to_recover_state(stacks)
    around.dc.menu_bar_appending = in_bar
    if imgui.get_current_context().open_popup_stack.size():
        # A popup that is no longer drawn would block the pointer everywhere else.
        imgui.internal.close_popup_to_level(0, restore_focus_to_window_under_popup=True)


def _is_moving(session: Session) -> bool:
    """Return whether the shown frame changes all the time: during a drag and during playback."""
    project = session.project
    return imgui.is_any_mouse_down() or (
        project is not None and project.timeline.playhead.since is not None
    )


def _state(session: Session) -> tuple[object, ...]:
    """Return all state that parts of the window show, except the clock."""
    project, display = session.project, session.display
    own = (
        *(session.dialogs.current, session.settings.preferences, display.overlays),
        *(display.compare_view, display.tint, display.screen, display.curve_kind),
        *(session.tools.mode, session.export.run, session.tutorial.state),
        *(bool(session.jobs.kinds), project),
    )
    if project is None:
        return own
    chosen, listed = project.selection, project.layer_list
    return (
        *own,
        *(project.document, project.history.position, project.history.preview_pose, chosen.active),
        *(chosen.handles, chosen.channel, chosen.other_layers, tuple(chosen.keys.items())),
        *(listed.toggled_rows, listed.solo, project.viewport.view, project.timeline.playhead),
    )


def name_menu(title: str) -> str:
    """Return the name of a menu's part."""
    return _("The menu {menu}").format(menu=_(title))


def name_panel(panel: Panel) -> str:
    """Return the name of a panel's part."""
    return _("The panel {panel}").format(panel=_(panel.title))


def name_picture(panel: Panel) -> str:
    """Return the name of the part behind a panel."""
    return _("The picture in {panel}").format(panel=_(panel.title))
