"""The window: the session, its OpenGL objects, and the main loop."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from imgui_bundle import (  # before glfw: it brings the library itself
    glfw_utils,
    hello_imgui,
    icons_fontawesome_6 as icons,
)

from app.editor.layering.pictures import drop_files

import glfw  # isort: skip

from app.document import Pose
from app.editor import Action, FileDialog, Project, Session, do, error_reports
from app.editor.actions.project_files import autosaving, exporting, saving
from app.errors import EXPECTED_ERRORS, LissomError, display_name
from app.render import LayerPictures, Renderer, Thumbnail, Thumbnails
from app.render.gpu.context import describe_graphics, is_software
from app.storage import sample_images
from app.texts import N_, _, message_of
from app.ui.panel import Panel
from app.ui.panels import export, handle
from app.ui.panels.animate.tab import draw_animate_panel
from app.ui.panels.layers.tab import draw_layers_panel
from app.ui.panels.measure.tab import draw_measure_panel
from app.ui.panels.shape.tab import draw_shape_panel
from app.ui.style.theme import Look
from app.ui.timeline import timeline
from app.ui.timeline.rows.height import wanted_height
from app.ui.viewport import viewport
from app.ui.viewport.canvas import Canvas
from app.ui.viewport.split_view import SplitTextures
from app.ui.window.desktop import NAME, name_application, show_icon, window_title
from app.ui.window.events.drag_and_drop import accept_files
from app.ui.window.events.input_queue import InputQueue
from app.ui.window.events.key_taps import count_taps
from app.ui.window.events.keyboard_layout import find_plus_key
from app.ui.window.events.modifiers import release_stuck_modifiers
from app.ui.window.exporter import Exporter
from app.ui.window.guard import FrameStep
from app.ui.window.memory import FreeMemory
from app.ui.window.window_frame import WindowFrame
from engine.arrays import Bytes

SIZE = (1280, 800)
PAUSE = 0.1  # seconds between frames that only update the time of a job


class Window:
    """Owner of the OpenGL objects of one window; `connect` is called in its OpenGL context."""

    def __init__(self, session: Session, connect: Callable[[], Renderer]) -> None:
        self.session = session
        self._connect = connect
        self.thumbnails: Thumbnails | None = None
        self._layer_pictures: LayerPictures | None = None
        self._shows_files = True
        self.canvas: Canvas | None = None
        self._exporter: Exporter | None = None
        self._renderer: Renderer | None = None
        self.shell = WindowFrame(session, self._panels(), self._thumbnail, self._moments)
        # Whether the viewport is painted. Tests without a picture set it to False.
        self.paints = True
        self._memory = FreeMemory(session)
        self._draw_step = FrameStep(self._paint, self._report_drawing_error)
        self._input_queue = InputQueue()
        self._title, self._is_open = NAME, False
        self._callbacks: object = None

    def runner_params(self) -> hello_imgui.RunnerParams:
        params = self.shell.runner_params()
        calls = params.callbacks
        calls.enqueue_post_init(self._start)
        calls.before_imgui_render = hello_imgui.sequence_functions(
            calls.before_imgui_render, self.draw_canvas
        )
        calls.pre_new_frame = hello_imgui.sequence_functions(
            partial(self.shell.run_guarded, self._begin_frame), calls.pre_new_frame
        )
        calls.pre_new_frame = hello_imgui.sequence_functions(
            calls.pre_new_frame, self._input_queue.hold_events
        )
        calls.post_new_frame = self._input_queue.release_events
        return params

    def run(
        self,
        *,
        is_over: Callable[[], bool] = lambda: False,
        farewell: Callable[[], None] = lambda: None,
    ) -> None:
        """Show the window on the screen until the person closes it.

        Parameters
        ----------
        is_over : callable
            Asked once a frame. If true, the window closes without a question.
        farewell : callable
            Called before all objects are released, because the release may block or crash. Also
            called if an exception ends the window; then nothing is released.

        Raises
        ------
        LissomError
            If there is no screen.
        """
        params = self.runner_params()
        params.app_window_params.window_title = self._title
        calls = params.callbacks
        self.shell.follow_layout(find_plus_key)
        calls.enqueue_post_init(self._listen)
        calls.enqueue_post_init(show_icon)
        calls.pre_new_frame = hello_imgui.sequence_functions(self._rename, calls.pre_new_frame)
        calls.pre_new_frame = hello_imgui.sequence_functions(
            release_stuck_modifiers, calls.pre_new_frame
        )
        params.ini_folder_type = hello_imgui.IniFolderType.absolute_path
        ini = str(self.session.settings.folder / "window.ini")
        params.ini_filename = display_name(ini)
        params.ini_disable = params.ini_filename != ini  # ImGui writes only UTF-8 names
        params.app_window_params.window_geometry.size = SIZE
        params.app_window_params.restore_previous_geometry = True
        name_application()
        try:
            hello_imgui.manual_render.setup_from_runner_params(params)
        except RuntimeError as error:
            raise LissomError(
                _(
                    "The window cannot be opened ({error}). It needs a display with OpenGL 3.3. "
                    "'lissom doctor' checks the graphics, LIBGL_ALWAYS_SOFTWARE=1 draws without a "
                    "graphics card, and the command line needs no display."
                ).format(error=error)
            ) from error
        self._is_open = True
        self.session.jobs.wake = self.wake
        try:
            while not (params.app_shall_exit or is_over()):
                if self.awaits_worker:
                    glfw.wait_events_timeout(PAUSE)
                hello_imgui.manual_render.render()
        finally:
            self._is_open = False
            farewell()
        self._release()
        hello_imgui.manual_render.tear_down()

    def wake(self) -> None:
        """Wake the window from waiting for events, for one frame. Any thread may call this."""
        if self._is_open:
            glfw.post_empty_event()

    @property
    def awaits_worker(self) -> bool:
        """Whether the next frame can wait, up to `PAUSE`, for the worker or for some input."""
        return self.shell.awaits_worker and not self._input_queue.has_pending

    def queue_action(self, action: Action) -> None:
        """Apply an action in the next frame, as if a panel had returned it."""
        self.shell.queue_action(action)

    def draw_canvas(self) -> None:
        """Draw the viewport's picture, and continue an export; once a frame."""
        if self.canvas is None or self._renderer is None:
            return
        self._draw_step.run_guarded(self.session)
        if self._exporter is not None:
            self._exporter.step(self.session)
        # ImGui draws to the bound framebuffer, which must be the screen.
        screen = self._renderer.programs.context.screen
        if screen is not None:
            screen.use()

    def _paint(self) -> None:
        if self.canvas is not None:
            self._memory.update(has_closed=self.canvas.release_others(self.session.project))
            self.canvas.draw(self.session, paints=self.paints)

    def _report_drawing_error(self, error: Exception) -> None:
        """Report that OpenGL fails, as after a driver reset, and save a recovery copy at once."""
        session = self.session
        project = session.project
        sentences = [_("The picture cannot be drawn: {error}.").format(error=error)]
        if project is not None and saving.has_unsaved_changes(project):
            try:
                autosaving.autosave_now(session)
                sentences.append(_("The unsaved work was kept."))
            except EXPECTED_ERRORS as reason:
                sentences.append(
                    _("The unsaved work could not be kept ({reason}).").format(
                        reason=message_of(reason)
                    )
                )
        sentences.append(_("If the picture does not come back, save and start Lissom again."))
        error_reports.report_unexpected_error(session, " ".join(sentences), error, topic="drawing")

    def _panels(self) -> list[Panel]:
        draw_layers = partial(draw_layers_panel, pictures=self._layer_picture)
        draw_animate = partial(draw_animate_panel, pictures=self._pose_picture)
        return [
            Panel(
                *(N_("Viewport"), icons.ICON_FA_IMAGE, self._draw_viewport),
                place="MainDockSpace",
                draw_background=self._draw_ground,
            ),
            Panel(
                *(N_("Timeline"), icons.ICON_FA_FILM, timeline.draw_timeline_panel),
                place="bottom",
                wanted_height=wanted_height,
            ),
            Panel(N_("Handle"), icons.ICON_FA_CIRCLE_DOT, handle.draw_handle_panel),
            Panel(N_("Layers"), icons.ICON_FA_LAYER_GROUP, draw_layers),
            Panel(N_("Animate"), icons.ICON_FA_PERSON_RUNNING, draw_animate),
            Panel(N_("Shape"), icons.ICON_FA_SHAPES, draw_shape_panel),
            Panel(N_("Export"), icons.ICON_FA_FILE_EXPORT, export.draw_export_panel),
            Panel(
                *(N_("Measure"), icons.ICON_FA_CHART_LINE, draw_measure_panel),
                is_shown=lambda session: session.display.is_measuring,
            ),
        ]

    def _draw_ground(self, session: Session, _: Look, project: Project) -> list[Action]:
        return viewport.draw_viewport_pictures(session, project, self._textures)

    def _draw_viewport(self, session: Session, look: Look, project: Project) -> list[Action]:
        return viewport.draw_viewport_panel(session, look, project, self._textures)

    @property
    def _textures(self) -> SplitTextures:
        canvas = self.canvas
        return (
            SplitTextures(canvas.texture, canvas.comparison_texture) if canvas else SplitTextures()
        )

    def _pose_picture(self, layer: int, pose: Pose, side: int) -> int | None:
        return self.canvas.pose_pictures.get(layer, pose, side) if self.canvas else None

    def _layer_picture(self, identity: int, small: Bytes) -> Thumbnail | None:
        return self._layer_pictures.get(identity, small) if self._layer_pictures else None

    def _start(self) -> None:
        renderer = self._renderer = self._connect()
        fast = not is_software(renderer.programs.context)
        self.session.display.note_speed(full_detail=fast)
        self.session.diagnostics.note_graphics(describe_graphics(renderer.programs.context))
        self.canvas = Canvas(renderer)
        self._exporter = Exporter(renderer)
        self.thumbnails = Thumbnails(renderer.programs.context)
        self._layer_pictures = LayerPictures(renderer.programs.context)

    def _listen(self) -> None:
        window = glfw_utils.glfw_window_hello_imgui()
        dropped = accept_files(window, self.take_dropped)
        self._callbacks = dropped, count_taps(window, self.shell.taps)

    def take_dropped(self, paths: list[Path]) -> None:
        """Open the dropped files, or add them to the open project."""
        self.queue_action(do(drop_files, paths))

    def _rename(self) -> None:
        title = window_title(self.session)
        if title != self._title:
            self._title = title
            glfw.set_window_title(glfw_utils.glfw_window_hello_imgui(), title)

    def _release(self) -> None:
        exporting.cancel_export(self.session)
        self.shell.release()
        owners = (self._exporter, self.canvas, self.thumbnails, self._layer_pictures)
        for owner in (*owners, self._renderer):
            if owner is not None:
                owner.release()

    def _begin_frame(self) -> None:
        if self.thumbnails is None or self._layer_pictures is None:
            return
        self._layer_pictures.begin_frame()
        if self.thumbnails.is_behind:
            # There are more to be read.
            hello_imgui.request_refresh()
        self.thumbnails.begin_frame()
        # Only the welcome view and the file browser show thumbnails. Files may have been saved
        # again before the next time; samples do not change.
        shows_files = self.session.project is None or isinstance(
            self.session.dialogs.current, FileDialog
        )
        if self._shows_files and not shows_files:
            self.thumbnails.release(but=sample_images())
        self._shows_files = shows_files

    def _thumbnail(self, path: Path) -> Thumbnail | None:
        return self.thumbnails.get(path) if self.thumbnails else None

    def _moments(self, path: Path) -> list[Thumbnail]:
        return self.thumbnails.animation_frames(path) if self.thumbnails else []
