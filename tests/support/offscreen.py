"""The whole window without a display, for tests and measurements."""

import numpy as np
from imgui_bundle import ImVec2, hello_imgui, imgui
from PIL import Image

from app.render.gpu.context import Context, finish_drawing
from app.ui.window.window import SIZE, Window
from tests.support.draw_lists import DrawLists


class Offscreen:
    """A window on a framebuffer, and the mouse that is over it.

    Hello ImGui's null platform and null renderer stand for the display; what ImGui wants drawn is
    drawn with OpenGL as everything else is. There can be one in the life of a process: the null
    platform leaves ImGui's context and textures behind, and cannot be set up again.

    Parameters
    ----------
    window : Window
        Its renderer draws with `gl`.
    gl : Context
    size : tuple of int
        Width and height in pixels.
    with_test_engine : bool
        Whether ImGui's test engine is to run in it.
    """

    def __init__(
        self,
        window: Window,
        gl: Context,
        *,
        size: tuple[int, int] = SIZE,
        with_test_engine: bool = False,
    ) -> None:
        self._window = window
        self._gl = gl
        self._lists: DrawLists | None = None
        self._density = 1.0
        self._set_size(size)
        self._params = self._headless_params()
        self._params.use_imgui_test_engine = with_test_engine
        hello_imgui.manual_render.setup_from_runner_params(self._params)

    def frame(self, *, painted: bool = False) -> None:
        """Go through one frame; most need not be painted, which would take most of the time."""
        # Others in this process may have contexts of their own.
        with self._gl:
            hello_imgui.manual_render.render()
            if painted:
                self.paint()

    def paint(self) -> None:
        """Draw what ImGui made of the frame, and wait until it is there; part of the frame."""
        data = imgui.get_draw_data()
        self._target.clear(*self._params.imgui_window_params.background_color)
        if self._lists is not None and data is not None and data.valid:
            self._lists.draw(self._target)
        finish_drawing(self._gl)

    def picture(self) -> Image.Image:
        """Return what was painted last."""
        with self._gl:
            pixels = self._target.read(components=3, alignment=1)
        picture = Image.frombytes("RGB", self._target.size, pixels)
        return picture.transpose(Image.Transpose.FLIP_TOP_BOTTOM)

    def resize(self, size: tuple[int, int], density: float = 1.0) -> None:
        """Give the window another size, and its panels the places that they have at first.

        Parameters
        ----------
        size : tuple of int
            In pixels of the screen.
        density : float
            Pixels of the screen in one of the window's, as macOS has them.
        """
        self._density = density
        with self._gl:
            self._target.color_attachments[0].release()
            self._target.release()
            self._set_size(size)
        self._params.docking_params.layout_reset = True

    def show_tab(self, title: str) -> None:
        """Bring a panel to the front in the next frames. Measures have a tab only meanwhile."""
        self._window.session.display.measure(shown=title == "Measure")
        self._panel(title).focus_window_at_next_frame = True

    def point(self, place: complex) -> ImVec2:
        """Return where a place of the drawing's plane is on the screen."""
        session = self._window.session
        project = session.project
        if project is None:
            raise RuntimeError("there is no drawing in the window")
        corner = imgui.internal.find_window_by_name(self._panel("Viewport").label).pos
        pixel = project.view_on(session.display.screen).to_pixels(np.array([place]))[0]
        pixel /= self._density
        return ImVec2(corner.x + pixel.real, corner.y + pixel.imag)

    def move_mouse(self, point: ImVec2) -> None:
        """Put the mouse on a point of the screen."""
        imgui.get_io().add_mouse_pos_event(point.x, point.y)

    def press(self, *, down: bool) -> None:
        """Press the left button of the mouse, or let it go."""
        imgui.get_io().add_mouse_button_event(imgui.MouseButton_.left.value, down)

    def _panel(self, title: str) -> hello_imgui.DockableWindow:
        panels = self._params.docking_params.dockable_windows
        return next(panel for panel in panels if panel.label.endswith(title))

    def _set_size(self, size: tuple[int, int]) -> None:
        self._target = self._gl.framebuffer([self._gl.texture(size, 4)])

    def _headless_params(self) -> hello_imgui.RunnerParams:
        params = self._window.runner_params()
        params.platform_backend_type = hello_imgui.PlatformBackendType.null
        params.renderer_backend_type = hello_imgui.RendererBackendType.null
        params.ini_disable = True
        # There is no input to wait for.
        params.fps_idling.fps_idle = 0.0
        calls = params.callbacks
        begin = calls.pre_new_frame

        def begin_frame() -> None:
            io, (width, height) = imgui.get_io(), self._target.size
            io.display_size = ImVec2(width / self._density, height / self._density)
            io.display_framebuffer_scale = ImVec2(self._density, self._density)
            begin()

        calls.pre_new_frame = begin_frame
        calls.enqueue_post_init(self._attach)
        return params

    def _attach(self) -> None:
        self._lists = DrawLists(self._gl)
