"""The window: the session, what is drawn with OpenGL, and the loop around them."""

from collections.abc import Callable
from pathlib import Path

from imgui_bundle import hello_imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.render.draw_lists import Textures
from app.render.renderer import Renderer
from app.render.thumbnails import Thumbnail, Thumbnails
from app.session import Session
from app.ui.canvas import Canvas
from app.ui.panel import Panel
from app.ui.panels import viewport
from app.ui.shell import Shell


class Window:
    """Owner of the OpenGL objects of one window.

    Parameters
    ----------
    session : Session
    connect : callable
        Returns a renderer for the window's OpenGL context, once ImGui has made it.
    """

    def __init__(self, session: Session, connect: Callable[[], Renderer]) -> None:
        self.session = session
        self._connect = connect
        self._thumbnails: Thumbnails | None = None
        self._canvas: Canvas | None = None
        self._shell = Shell(session, self._panels(), self._thumbnail)

    def runner_params(self) -> hello_imgui.RunnerParams:
        """Return the parameters to run the window with."""
        params = self._shell.runner_params()
        calls = params.callbacks
        calls.enqueue_post_init(self._start)
        calls.before_imgui_render = hello_imgui.sequence_functions(
            calls.before_imgui_render, self._draw_canvas
        )
        calls.pre_new_frame = hello_imgui.sequence_functions(self._begin_frame, calls.pre_new_frame)
        return params

    def textures(self) -> Textures:
        """Return the textures that the panels show, by their OpenGL names."""
        textures = [] if self._thumbnails is None else self._thumbnails.textures()
        if self._canvas is not None and self._canvas.target is not None:
            textures.append(self._canvas.target.texture)
        return {texture.glo: texture for texture in textures}

    def _panels(self) -> list[Panel]:
        return [
            Panel(
                title="Viewport",
                icon=icons.ICON_FA_IMAGE,
                place="MainDockSpace",
                draw=lambda session, look: viewport.draw(session, look, self._texture),
            ),
        ]

    @property
    def _texture(self) -> int | None:
        return self._canvas.texture if self._canvas else None

    def _start(self) -> None:
        renderer = self._connect()
        self._canvas = Canvas(renderer)
        self._thumbnails = Thumbnails(renderer.programs.context)

    def _draw_canvas(self) -> None:
        if self._canvas is not None:
            self._canvas.draw(self.session)

    def _begin_frame(self) -> None:
        if self._thumbnails is not None:
            self._thumbnails.begin_frame()

    def _thumbnail(self, path: Path) -> Thumbnail | None:
        return self._thumbnails.get(path) if self._thumbnails else None
