"""The frame guard: a part of the window that raises is replaced by a notice; the others go on."""

from collections.abc import Callable
from dataclasses import KW_ONLY, dataclass
from typing import Literal

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui, imgui_ctx, implot

from app.editor import Action, Session, do, error_reports
from app.ui.style import Look, draw_tooltip, small_text

OWN_CLIPS = 2  # clip rectangles of a window itself
PAUSE = 1.0  # seconds after which a step that failed is tried again
WIDTH = 24.0  # em: of a notice that is in no panel
MOST_SHOWN = 1500  # characters of a traceback; all of it can be copied
FRAME = imgui.ChildFlags_.auto_resize_y | imgui.ChildFlags_.borders
ALONE = (
    imgui.WindowFlags_.always_auto_resize
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
)
TRY_AGAIN, COPY, REPORT, CLOSE, DETAILS = "Try again", "Copy", "Report…", "Close", "Details"


def allow_recovery() -> None:
    """Let Dear ImGui close what a broken panel left open, instead of asserting in every frame."""
    io = imgui.get_io()
    io.config_error_recovery = True
    io.config_error_recovery_enable_assert = False
    io.config_error_recovery_enable_tooltip = False
    io.config_error_recovery_enable_debug_log = True


def format_failure(name: str) -> str:
    """Say that a part of the window failed."""
    return f"{name} cannot be shown; the rest works, and your work can be saved."


@dataclass(frozen=True, slots=True)
class _Failure:
    """What failed: the state that it failed in, the clock's seconds then, and the traceback."""

    state: tuple[object, ...]
    at: float
    trace: str = ""


@dataclass(slots=True, eq=False)
class WindowPart:
    """A part of the window's frame, which draws a notice in its place while it fails.

    A part that failed is drawn again once the document, the selection or the session has changed
    and neither a button of the mouse is down nor the animation plays, or where the person asks.
    """

    name: str  # as a sentence begins with it
    draw: Callable[[Session, Look], list[Action]]
    _: KW_ONLY
    # Where its notice is: in a "panel", in a "menu", behind a button in a "bar", or in a "window"
    # of its own.
    place: Literal["panel", "menu", "bar", "window"] = "panel"
    dismissal: Action | None = None  # what closes the part, where it can be closed
    failure: _Failure | None = None

    def draw_guarded(self, session: Session, look: Look) -> list[Action]:
        """Draw the part, or else its notice; return what the person asked for."""
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
        """Draw the part in the next frame, though nothing has changed."""
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
        width, popup = WIDTH * look.em, f"Failure of {self.name}"
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
        """Write what failed; lines end at the window's edge, or are so wide."""
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
    """Something that each frame does unasked; where it fails, it rests for a while.

    It is done again once the document, the selection or the session has changed, at most `PAUSE`
    seconds later.
    """

    run: Callable[[], None]
    report_error: Callable[[Exception], None]
    failure: _Failure | None = None

    def run_guarded(self, session: Session) -> None:
        """Do it, unless it failed just now; tell of a failure."""
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
    """Close all that a part has left open in the window around it, or in windows of its own."""
    plots = implot.get_current_context()
    if plots is not None and plots.current_plot is not None:
        implot.internal.reset_ctx_for_next_plot(plots)
    # Recovery would end the menu bar that a part is in, too.
    in_bar, around.dc.menu_bar_appending = around.dc.menu_bar_appending, False
    # A menu that was open before may lack the clip rectangle that ending it takes off.
    clips = imgui.get_window_draw_list()
    if clips._clip_rect_stack.size() < OWN_CLIPS:  # noqa: SLF001 - nothing else tells of it
        clips.push_clip_rect_full_screen()
    imgui.internal.error_recovery_try_to_recover_state(stacks)
    around.dc.menu_bar_appending = in_bar
    if imgui.get_current_context().open_popup_stack.size():
        # A popup that nobody draws any more would keep the pointer from everything else.
        imgui.internal.close_popup_to_level(0, restore_focus_to_window_under_popup=True)


def _is_moving(session: Session) -> bool:
    """Tell whether what is shown changes with every frame: in a drag, and while it plays."""
    project = session.project
    return imgui.is_any_mouse_down() or (project is not None and project.playhead.since is not None)


def _state(session: Session) -> tuple[object, ...]:
    """Return all that parts of the window show, but for what the clock alone changes."""
    project = session.project
    own = (
        *(
            session.dialog,
            session.preferences,
            session.overlays,
            session.compare_view,
            session.tint,
        ),
        *(session.cutting, session.material, session.moves, session.records, session.screen),
        *(session.export, session.tutorial, session.curves, bool(session.jobs.kinds), project),
    )
    if project is None:
        return own
    return (
        *own,
        *(project.document, project.history.position, project.history.preview_pose, project.active),
        *(
            project.selected_handles,
            project.track_row,
            project.other_selected_layers,
            project.toggled_rows,
            project.solo,
        ),
        *(
            project.motion_setup,
            project.camera,
            project.playhead,
            tuple(project.selected_keys.items()),
        ),
    )
