"""The window's frame: layout, bars, dialogs, and the one place that applies actions."""

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from imgui_bundle import ImVec2, hello_imgui, imgui

from app.editor import (
    Action,
    Project,
    Session,
    as_sentence,
    do,
    error_reports,
    pending_changes,
)
from app.editor.actions import playback, tutorials
from app.editor.actions.dialog_actions import close_dialog
from app.editor.actions.posing.pose_solver import stop_finishing_pose
from app.editor.actions.project_files import autosaving, saving
from app.editor.actions.timing import sound_playback
from app.editor.actions.updates import frame_update
from app.editor.layering import footage
from app.editor.tools import tool_pointer
from app.errors import EXPECTED_ERRORS
from app.render import Thumbnail
from app.texts import _, message_of
from app.ui import welcome
from app.ui.bars.menus import draw_main_menu
from app.ui.bars.status import draw_status_bar
from app.ui.bars.tools import draw_tool_bar
from app.ui.dialogs.dialogs import Dialogs
from app.ui.panel import Panel
from app.ui.panels.modes.bar import draw_mode_bar
from app.ui.shortcuts.key_input import collect_key_actions
from app.ui.shortcuts.keys import KEY_MAP
from app.ui.shortcuts.table import MENUS
from app.ui.shortcuts.tap_counter import TapCounter
from app.ui.style.theme import Look, interface_scale
from app.ui.toasts import ToastStack
from app.ui.window.action_queue import ActionQueue
from app.ui.window.appearance import Appearance
from app.ui.window.docks.docking import Docking
from app.ui.window.guard import FrameStep, WindowPart, name_menu, name_panel, name_picture
from app.ui.window.idling import AWAKE, IDLE_FPS, FramePace
from app.ui.window.tutorial.card import Callout

LEFT = imgui.MouseButton_.left
MENU_BAR, STATUS_BAR, TOOL_BAR = _("The menu bar"), _("The status bar"), _("The toolbar")


class WindowFrame:
    """Draws the window's contents from a session, once a frame, and applies the actions."""

    def __init__(
        self,
        session: Session,
        panels: Sequence[Panel],
        thumbnail: Callable[[Path], Thumbnail | None],
        moments: Callable[[Path], list[Thumbnail]],
    ) -> None:
        self.session = session
        self._docking = Docking(panels)
        self._appearance = Appearance(session)
        self._dialogs = Dialogs()
        self.callout = Callout()
        # Rectangles of items in this frame, and in the frame before.
        self._places: dict[str, tuple[ImVec2, ImVec2]] = {}
        self._seen: dict[str, tuple[ImVec2, ImVec2]] = {}
        self._actions, self._asked = list[Action](), list[Action]()
        self.queue = ActionQueue(session, self._report_error)
        self._plus_key: Callable[[], imgui.Key | None] = lambda: None
        self.taps, self._pace = TapCounter(), FramePace()
        previews = welcome.Previews(thumbnail, moments)
        over = (
            # Hello ImGui draws the tabs themselves.
            WindowPart(_("The tab bar"), self._draw_tabs, place="window"),
            WindowPart(_("The mode bar"), draw_mode_bar, place="window"),
            WindowPart(_("The welcome view"), partial(_welcome, previews=previews), place="window"),
            WindowPart(_("The guide"), self._draw_guide, place="window"),
            WindowPart(
                _("The dialog"),
                partial(self._dialogs.draw, thumbnail=thumbnail),
                place="window",
                dismissal=do(close_dialog),
            ),
            WindowPart(_("The messages"), ToastStack().draw, place="window"),
        )
        bars_around = (
            WindowPart(MENU_BAR, self._draw_menus, place="bar"),
            WindowPart(STATUS_BAR, draw_status_bar, place="bar"),
            WindowPart(TOOL_BAR, _with_project(draw_tool_bar), place="bar"),
        )
        draw_menu = partial(draw_main_menu, panels=panels)
        menus = [
            WindowPart(name_menu(title), partial(draw_menu, title=title), place="menu")
            for title in MENUS
        ]
        docked = [WindowPart(name_panel(each), _with_project(each.draw)) for each in panels]
        grounds = [
            WindowPart(name_picture(each), _with_project(each.draw_background))
            for each in panels
            if each.draw_background is not None
        ]
        # Every part of the window's frame, by its name.
        self.parts = {part.name: part for part in (*over, *bars_around, *menus, *docked, *grounds)}
        self._over = [part.name for part in over]
        self._revision: tuple[int, ...] = ()  # of the session when the steps last ran
        self._follow = self._step(frame_update.follow_playhead)
        self._update_steps = [
            self._step(each)
            for each in (
                pending_changes.run_deferred_actions,
                *frame_update.STEPS,
                autosaving.write_due_files,
                tutorials.update_tutorial,
            )
        ]

    def runner_params(self) -> hello_imgui.RunnerParams:
        """Return Hello ImGui's parameters. The caller sets platform and renderer."""
        params = hello_imgui.RunnerParams()
        window = params.imgui_window_params
        window.default_imgui_window_type = (
            hello_imgui.DefaultImGuiWindowType.provide_full_screen_dock_space
        )
        window.show_menu_bar = window.show_status_bar = True
        window.show_menu_app = window.show_menu_view = window.show_status_fps = False
        params.docking_params = self._docking.layout(self._draw_panel)
        calls = params.callbacks
        calls.load_additional_fonts = self._appearance.load_fonts
        calls.setup_imgui_config = self._appearance.configure
        calls.setup_imgui_style = self._appearance.apply_theme
        calls.pre_new_frame = partial(self.run_guarded, self._begin_frame)
        # The docks are drawn between these two.
        calls.show_menus = hello_imgui.sequence_functions(
            partial(self._ask, MENU_BAR), self._docking.narrow_tabs
        )
        calls.show_status = partial(self._ask, STATUS_BAR)
        calls.show_gui = hello_imgui.sequence_functions(
            self._docking.restore_style, self._draw_over_panels
        )
        calls.before_imgui_render = self._apply_actions
        calls.confirm_exit = self._may_exit
        options = hello_imgui.EdgeToolbarOptions()
        options.size_em = 2.7
        options.window_padding_em = ImVec2(0.35, 0.5)
        tools = partial(self._ask, TOOL_BAR)
        calls.add_edge_toolbar(hello_imgui.EdgeToolbarType.left, tools, options)
        params.fps_idling.fps_idle = IDLE_FPS
        params.fps_idling.time_active_after_last_event = AWAKE
        return params

    def follow_layout(self, plus_key: Callable[[], imgui.Key | None]) -> None:
        """Ask from now on which key types +."""
        self._plus_key = plus_key

    def queue_action(self, action: Action) -> None:
        """Apply an action at the end of the next frame."""
        self._asked.append(action)

    @property
    def awaits_worker(self) -> bool:
        """Whether further frames would repeat the shown one and slow down the worker."""
        return self._pace.awaits_worker

    def release(self) -> None:
        """Close the system's dialog."""
        self._dialogs.close()

    def run_guarded(self, change: Callable[[], None]) -> None:
        """Call a function. Report its failure, and keep the window alive."""
        try:
            change()
        except Exception as error:  # noqa: BLE001 - part of the frame guard
            self._report_error(error)

    def _report_error(self, error: Exception) -> None:
        if isinstance(error, EXPECTED_ERRORS):
            self.session.notices.show(as_sentence(message_of(error)), tone="error")
        else:
            error_reports.report_unexpected_error(
                self.session, _("Lissom could not do this: {error}").format(error=error), error
            )

    def _step(self, run: Callable[[Session], None]) -> FrameStep:
        return FrameStep(partial(run, self.session), self._report_error)

    @property
    def look(self) -> Look:
        return self._appearance.look(self._places)

    def _draw_panel(self, panel: Panel) -> None:
        if panel.draw_background is not None:
            self._ask(name_picture(panel))
        self._ask(name_panel(panel))

    def _ask(self, name: str) -> None:
        """Draw a part, and collect its actions."""
        self._actions += self.parts[name].draw_guarded(self.session, self.look)

    def _draw_menus(self, *_rest: object) -> list[Action]:
        for title in MENUS:
            if imgui.begin_menu(_(title)):
                self._ask(name_menu(title))
                imgui.end_menu()
        return []

    def _draw_tabs(self, *_: object) -> list[Action]:
        self._docking.draw_tabs()
        return []

    def _draw_guide(self, session: Session, look: Look) -> list[Action]:
        return self.callout.draw(session, look, places=self._seen)

    def _collect_key_actions(self) -> None:
        if self.queue.waiting and imgui.is_key_pressed(imgui.Key.escape):
            stop_finishing_pose(self.session)
        else:
            self._actions += collect_key_actions(self.session, self.taps, self._plus_key)

    def _begin_frame(self) -> None:
        session, project = self.session, self.session.project
        KEY_MAP.use(session.settings.preferences.keys)
        self._seen, self._places = self._places, {}
        self._appearance.begin_frame()
        self._docking.begin_frame(interface_scale(session.settings.preferences.scale), session)
        # The tabs that show these set them again in every frame.
        if session.export.frame_box is not None:
            session.export.show_frame_box(None)
        if project is not None and project.layer_list.pointed_layer is not None:
            project.layer_list.point_at(None)
        if project is not None:
            timing = project.timeline
            in_use = (timing.playhead.since, timing.gesture, timing.heard)
            # A window without sounds that rests makes as few calls as possible.
            if session.player.is_running or in_use != (None, None, None):
                sound_playback.play_heard_sounds(session)
        if project is not None and project.timeline.playhead.since is not None:
            playback.stop_playback_at_end(session)
            # Before the panels, which read the playhead's frame.
            self._follow.run_guarded(session)
        if self._pace.begin_frame(session):
            footage.watch_files(session)

    def _draw_over_panels(self) -> None:
        self.run_guarded(self._collect_key_actions)
        for name in self._over:
            self._ask(name)
        # A pressed pointer without a widget counts as a widget.
        is_pressed, tools = imgui.is_mouse_down(LEFT), self.session.tools
        widget = imgui.internal.get_active_id() or int(is_pressed)
        is_known = (widget, is_pressed) == (tools.widget, tools.is_widget_pressed)
        if self.session.project is not None and not is_known:
            self._actions.append(do(tool_pointer.note_widget_in_use, widget, is_pressed=is_pressed))

    def _apply_actions(self) -> None:
        # Panels' actions first: a drop depends on the pointer they saw.
        actions, self._actions, self._asked = self._actions + self._asked, [], []
        self.queue.apply(actions)
        if self.session.display.panel_to_focus:
            self._docking.bring_to_front(self.session.display.panel_to_focus)
            self.session.display.focus_panel("")
        # After the actions, which set the newest target, and before the picture is drawn.
        is_in_use = self.session.tools.widget != 0
        self.run_guarded(self.queue.deliver if is_in_use else self.session.jobs.deliver)
        self._run_update_steps()
        self._pace.end_frame(self.session)
        if self.session.is_quitting:
            hello_imgui.get_runner_params().app_shall_exit = True

    def _run_update_steps(self) -> None:
        """Run all steps if anything has changed since the last time, or if one is due by now."""
        session, revision = self.session, frame_update.session_revision(self.session)
        is_due = frame_update.is_due_in_time(session) or autosaving.is_autosave_due(session)
        # A failed step is tried again.
        is_due = is_due or bool([step for step in self._update_steps if step.failure is not None])
        if revision == self._revision and not is_due:
            return
        # Changes that the steps make are seen in the next frame.
        self._revision = revision
        for step in self._update_steps:
            step.run_guarded(session)

    def _may_exit(self) -> bool:
        # The close button of the window. The answer follows as an action.
        self._actions.append(do(saving.request_quit))
        return False


def _with_project(
    draw: Callable[[Session, Look, Project], list[Action]],
) -> Callable[[Session, Look], list[Action]]:
    """Return a draw function that does nothing without a project."""
    return lambda session, look: draw(session, look, session.project) if session.project else []


def _welcome(session: Session, look: Look, previews: welcome.Previews) -> list[Action]:
    return [] if session.project else welcome.draw_welcome(session, look, pictures=previews)
